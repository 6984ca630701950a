// What the page of trees calls: one tree at a time. src/tree/view_engine.ts has the other side.
#include <emscripten.h>

#include <array>
#include <exception>
#include <memory>
#include <string>

#include "viewer/engine/tree_view.h"

namespace terrane::viewer {
namespace {

std::unique_ptr<TreeView> view;
std::string message;

/// Runs something that may throw. \return what went wrong, or nothing; valid until the next call.
template <typename Work>
const char* message_of(const Work& work) {
  try {
    work();
    return nullptr;
  } catch (const std::exception& error) {
    message = error.what();
  }
  return message.c_str();
}

// bits of terrane_set_criteria()
constexpr unsigned kSwitchDistance = 1, kFrustum = 2, kBackFaces = 4, kSilhouette = 8,
                   kHighlight = 16, kColour = 32;

}  // namespace
}  // namespace terrane::viewer

using terrane::viewer::message_of;
using terrane::viewer::TreeView;
using terrane::viewer::view;

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* terrane_open(const char* bytes, std::size_t size) {
  view.reset();
  return message_of(
      [&] { view = std::make_unique<TreeView>(std::string_view(bytes, size), "tree"); });
}

EMSCRIPTEN_KEEPALIVE const char* terrane_look(double eye_x, double eye_y, double eye_z,
                                              double target_x, double target_y, double target_z,
                                              double up_x, double up_y, double up_z, double fov_deg,
                                              double width_px, double height_px) {
  return message_of([&] {
    view->look({.eye = {eye_x, eye_y, eye_z},
                .target = {target_x, target_y, target_z},
                .up = {up_x, up_y, up_z},
                .vertical_fov_deg = fov_deg,
                .width_px = width_px,
                .height_px = height_px});
  });
}

EMSCRIPTEN_KEEPALIVE void terrane_set_criteria(unsigned bits, double tolerance_px,
                                               double silhouette_px, double highlight_px,
                                               double colour_px, double shininess, double light_x,
                                               double light_y, double light_z) {
  using namespace terrane::viewer;
  terrane::hierarchy::ViewCriteria criteria;
  if (bits & kSwitchDistance) {
    criteria.measure = terrane::hierarchy::ScreenMeasure::kSwitchDistance;
  }
  criteria.tolerance_px = tolerance_px;
  criteria.frustum = bits & kFrustum;
  criteria.back_faces = bits & kBackFaces;
  if (bits & kSilhouette) criteria.silhouette_px = silhouette_px;
  if (bits & kHighlight) criteria.highlight_px = highlight_px;
  if (bits & kColour) criteria.colour_px = colour_px;
  criteria.shininess = shininess;
  criteria.to_light = {light_x, light_y, light_z};
  view->set_criteria(criteria);
}

EMSCRIPTEN_KEEPALIVE void terrane_set_budget(unsigned triangles) {
  view->set_budget(triangles > 0 ? std::optional(triangles) : std::nullopt);
}

EMSCRIPTEN_KEEPALIVE void terrane_set_morph_frames(unsigned frames) {
  view->set_morph_frames(frames);
}

EMSCRIPTEN_KEEPALIVE const char* terrane_update() {
  return message_of([] { view->update(); });
}

/// Numbers of the tree: see TreeSummary in view_engine.ts.
EMSCRIPTEN_KEEPALIVE const double* terrane_summary() {
  static std::array<double, 11> numbers;
  const auto& tree = view->tree();
  const auto [middle, reach] = terrane::hierarchy::extent_of(tree);
  const auto& origin = tree.lattice.origin();
  numbers = {double(tree.full_triangle_count()),
             double(tree.coarsest_triangles),
             double(tree.level_count()),
             origin.x(),
             origin.y(),
             origin.z(),
             origin.x() + middle.x(),
             origin.y() + middle.y(),
             origin.z() + middle.z(),
             reach,
             double(!tree.colours.empty())};
  return numbers.data();
}

/// Numbers of the last update: see FrameFigures in view_engine.ts.
EMSCRIPTEN_KEEPALIVE const double* terrane_figures() {
  static std::array<double, 7> numbers;
  const auto& did = view->statistics();
  numbers = {double(view->display().triangle_count()),
             double(view->display().vertex_count()),
             double(did.splits),
             double(did.merges),
             double(did.looked_at),
             view->tolerance_px(),
             double(view->is_settled())};
  return numbers.data();
}

EMSCRIPTEN_KEEPALIVE const std::uint32_t* terrane_indices() {
  return view->display().indices().data();
}
EMSCRIPTEN_KEEPALIVE const float* terrane_positions() { return view->display().positions().data(); }
EMSCRIPTEN_KEEPALIVE const float* terrane_normals() { return view->display().normals().data(); }
/// Null if the tree has none.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* terrane_colours() {
  return view->display().colours().data();
}
/// Places for vertices in terrane_positions(), those that are free among them.
EMSCRIPTEN_KEEPALIVE std::size_t terrane_slot_count() {
  return view->display().positions().size() / 3;
}

// pairs of begin and end
EMSCRIPTEN_KEEPALIVE const terrane::hierarchy::ChangedRange* terrane_changed_triangles() {
  return view->changed_triangles().data();
}
EMSCRIPTEN_KEEPALIVE std::size_t terrane_changed_triangles_count() {
  return view->changed_triangles().size();
}
EMSCRIPTEN_KEEPALIVE const terrane::hierarchy::ChangedRange* terrane_changed_vertices() {
  return view->changed_vertices().data();
}
EMSCRIPTEN_KEEPALIVE std::size_t terrane_changed_vertices_count() {
  return view->changed_vertices().size();
}
}
