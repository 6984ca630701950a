#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hierarchy/merge/merge_front.h"
#include "hierarchy/merge/triangle_budget.h"

namespace terrane::viewer {

/// Where the eye is, in the frame of the mesh that the tree was built of.
struct TreeCamera {
  Eigen::Vector3d eye, target, up;
  double vertical_fov_deg = 45;
  double width_px = 1280, height_px = 720;
};

/// A merge tree as one camera sees it, frame by frame: what the viewer's page of trees drives.
///
/// Arrays are those of hierarchy::DisplayMesh. After update() the changed ranges are what has to be
/// uploaded again; after that the rest is as it was.
class TreeView {
 public:
  /// Reads a tree, and shows its coarsest mesh.
  /// \param name  of the file, for messages.
  /// \throws InputError if the bytes are no tree, or damaged.
  TreeView(std::string_view bytes, const std::string& name);

  /// Looks from somewhere else, from the next update on.
  /// \throws ConfigError if eye and target are one point, or up runs along the view.
  void look(const TreeCamera& camera);
  void set_criteria(const hierarchy::ViewCriteria& criteria);
  /// Finds the tolerance that shows so many triangles, over several updates; nothing: the
  /// criteria's own. Other thresholds keep their ratio to it.
  void set_budget(std::optional<std::uint32_t> triangles);
  /// Begins again with the coarsest mesh: splits and merges take so many updates, 0: none.
  void set_morph_frames(std::uint32_t frames);

  /// One frame.
  void update();
  /// Would further updates change nothing?
  bool is_settled() const;

  const hierarchy::MergeTree& tree() const { return *tree_; }
  const hierarchy::DisplayMesh& display() const { return front_->display(); }
  const hierarchy::UpdateStatistics& statistics() const { return statistics_; }
  /// Of the last update.
  double tolerance_px() const { return shown_px_; }
  /// Written by the last update; by the first one (also after set_morph_frames()) all that shows.
  const std::vector<hierarchy::ChangedRange>& changed_triangles() const { return triangles_; }
  const std::vector<hierarchy::ChangedRange>& changed_vertices() const { return vertices_; }

 private:
  void follow_budget();

  std::unique_ptr<const hierarchy::MergeTree> tree_;
  std::unique_ptr<hierarchy::MergeFront> front_;
  std::uint32_t morph_frames_ = 0;
  hierarchy::Camera camera_;
  hierarchy::ViewCriteria criteria_;
  std::optional<hierarchy::TriangleBudget> budget_;
  double shown_px_ = 0;
  bool is_budget_met_ = true;
  hierarchy::UpdateStatistics statistics_;
  std::vector<hierarchy::ChangedRange> triangles_, vertices_;
};

}  // namespace terrane::viewer
