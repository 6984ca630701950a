#include "viewer/engine/tree_view.h"

#include <cmath>

#include "hierarchy/merge/tree_file.h"

namespace terrane::viewer {
namespace {

// a step this small is not worth another frame: as exact as settle_on()
constexpr double kSettledStep = 0.01;

}  // namespace

TreeView::TreeView(std::string_view bytes, const std::string& name)
    : tree_(std::make_unique<const hierarchy::MergeTree>(hierarchy::decode_tree(bytes, name))) {
  set_morph_frames(0);
  const auto [middle, reach] = hierarchy::extent_of(*tree_);
  camera_.eye = middle - (2 * reach + 1) * camera_.forward;
}

void TreeView::look(const TreeCamera& camera) {
  const Eigen::Vector3d& origin = tree_->lattice.origin();
  camera_ = hierarchy::Camera::looking_at(camera.eye - origin, camera.target - origin, camera.up);
  camera_.vertical_fov_deg = camera.vertical_fov_deg;
  camera_.width_px = camera.width_px;
  camera_.height_px = camera.height_px;
}

void TreeView::set_criteria(const hierarchy::ViewCriteria& criteria) { criteria_ = criteria; }

void TreeView::set_budget(std::optional<std::uint32_t> triangles) {
  budget_.reset();
  is_budget_met_ = true;
  if (!triangles) return;
  budget_.emplace(*triangles, shown_px_ > 0 ? shown_px_ : criteria_.tolerance_px);
  is_budget_met_ = false;
}

void TreeView::set_morph_frames(std::uint32_t frames) {
  morph_frames_ = frames;
  front_ = std::make_unique<hierarchy::MergeFront>(*tree_, frames);
}

void TreeView::update() {
  shown_px_ = budget_ ? budget_->tolerance_px() : criteria_.tolerance_px;
  const auto criteria = budget_ ? hierarchy::at_tolerance(criteria_, shown_px_) : criteria_;
  statistics_ = front_->update(hierarchy::ViewJudge(*tree_, camera_, criteria));
  triangles_ = display().changed_triangles();
  vertices_ = display().changed_vertices();
  front_->display().forget_changes();
  if (budget_) follow_budget();
}

void TreeView::follow_budget() {
  budget_->correct(display().triangle_count());
  is_budget_met_ = std::abs(std::log(budget_->tolerance_px() / shown_px_)) < kSettledStep;
}

bool TreeView::is_settled() const {
  return (morph_frames_ == 0 || front_->is_settled()) && is_budget_met_;
}

}  // namespace terrane::viewer
