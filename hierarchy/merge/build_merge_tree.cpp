#include "hierarchy/merge/build_merge_tree.h"

#include <fmt/format.h>

#include <numeric>
#include <span>

#include "core/errors.h"
#include "hierarchy/levels/build_levels.h"
#include "hierarchy/merge/edge_collapser.h"
#include "hierarchy/merge/grow_tree.h"
#include "hierarchy/merge/measure_bounds.h"

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

void check(const MergeTreeOptions& options) {
  if (!(options.share > 0 && options.share <= 1)) {
    throw ConfigError(fmt::format("share {}: has to be above 0, and 1 at most", options.share));
  }
  if (!(options.smallest_quality >= 0 && options.smallest_quality < 1)) {
    throw ConfigError(fmt::format("smallest quality {}: has to lie in 0 to 1, and below 1",
                                  options.smallest_quality));
  }
}

std::vector<Eigen::Vector3d> rounded(const SurfaceMesh& mesh, const PointLattice& lattice) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(mesh.points.size());
  for (const Eigen::Vector3d& p : mesh.points)
    points.push_back(lattice.round(p - lattice.origin()));
  return points;
}

/// Numbers the vertices of a tree: those that are left first, then the others as they come back.
class Numbering {
 public:
  explicit Numbering(std::size_t vertices) : number_(vertices, kNone) {}
  void add(std::uint32_t vertex) {
    number_[vertex] = static_cast<std::uint32_t>(order_.size());
    order_.push_back(vertex);
  }
  bool has(std::uint32_t vertex) const { return number_[vertex] != kNone; }
  std::uint32_t of(std::uint32_t vertex) const {
    return vertex == kOutside ? kOutside : number_[vertex];
  }
  /// The vertices in the order of their numbers.
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  std::vector<std::uint32_t> number_, order_;
};

MergeTree grown(const EdgeCollapser& collapser, MergeTree tree,
                const std::vector<Eigen::Vector3i>& places, std::span<const Colour> colours) {
  Numbering numbers(collapser.vertex_count());
  const auto place = [&](std::uint32_t v) { return places[collapser.origin(v)]; };
  tree.triangles = collapser.triangles();
  for (Corners& corners : tree.triangles) {
    for (std::uint32_t& v : corners) {
      if (!numbers.has(v)) {
        numbers.add(v);
        tree.points.push_back(place(v));
      }
      v = numbers.of(v);
    }
  }
  TreeGrower grower(std::move(tree));
  const auto& collapses = collapser.collapses();
  for (auto c = collapses.rbegin(); c != collapses.rend(); ++c) {
    grower.split({.parent = numbers.of(c->kept),
                  .child_count = 1,
                  .apexes = {numbers.of(c->apexes[0]), numbers.of(c->apexes[1]), kOutside},
                  .places = {place(c->removed)},
                  .level = c->level});
    numbers.add(c->removed);
  }
  tree = std::move(grower).finish();
  if (colours.empty()) return tree;
  for (const std::uint32_t v : numbers.order()) {
    tree.colours.push_back(colours[collapser.origin(v)]);
  }
  return tree;
}

}  // namespace

MergeTree build_merge_tree(const SurfaceMesh& finest, const MergeTreeOptions& options) {
  check(options);
  MergeTree tree;
  tree.lattice = PointLattice::around(finest.points);
  tree.region = options.region;
  SurfaceMesh mesh{rounded(finest, tree.lattice), finest.triangles, {}};
  tree.measure = is_height_field(mesh) ? ErrorMeasure::kVertical : ErrorMeasure::kDistance;
  std::vector<Eigen::Vector3i> places;
  for (const Eigen::Vector3d& p : mesh.points) places.push_back(tree.lattice.steps(p));

  EdgeCollapser collapser(std::move(mesh.points), mesh.triangles, tree.lattice.step(), tree.measure,
                          options);
  collapser.run();
  tree = grown(collapser, std::move(tree), places, finest.colours);
  measure_bounds(tree);
  return tree;
}

MergeTree merge_tree_of(const LevelSequence& sequence) {
  MergeTree coarsest{.lattice = sequence.lattice, .region = Region::kBothEnds};
  coarsest.points = sequence.coarsest_points;
  coarsest.triangles = sequence.coarsest_triangles;
  LevelRebuilder finest(sequence);
  finest.refine_to(0);
  coarsest.measure =
      is_height_field(finest.mesh()) ? ErrorMeasure::kVertical : ErrorMeasure::kDistance;

  // a vertex of the sequence keeps its number while its place changes; each place is one of ours
  std::vector<std::uint32_t> now(coarsest.points.size());
  std::iota(now.begin(), now.end(), 0U);
  TreeGrower grower(std::move(coarsest));
  for (std::uint32_t level = sequence.level_count(); level > 0; --level) {
    for (const Collapse& collapse : sequence.levels[level - 1]) {
      Split split{.parent = now[collapse.corners[0]],
                  .child_count = 3,
                  .places = collapse.before,
                  .level = level};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t apex = collapse.apexes[k];
        split.apexes[k] = apex == kOutside ? kOutside : now[apex];
      }
      const auto first = static_cast<std::uint32_t>(grower.tree().points.size());
      grower.split(split);
      now[collapse.corners[0]] = first;
      now.resize(now.size() + 2);
      now[collapse.corners[1]] = first + 1;
      now[collapse.corners[2]] = first + 2;
    }
  }
  MergeTree tree = std::move(grower).finish();
  measure_bounds(tree);
  return tree;
}

}  // namespace terrane::hierarchy
