#include "hierarchy/merge/edge_collapser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hierarchy/merge/surface_normals.h"

namespace terrane::hierarchy {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// a fan of more triangles makes every split at its hub expensive, and its neighbours wait for it
constexpr std::uint32_t kLargestValence = 24;

// samples of a row are on one line but for rounding: a triangle of three of them is a wall, and a
// sample at its foot is as far from one side of it as the wall is high
constexpr double kLeastAltitudeSteps = 16;

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

Eigen::Vector3d area_vector(const TrianglePlaces& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

double longest_side_in_plan(const TrianglePlaces& t) {
  const auto side = [&](std::size_t a, std::size_t b) { return (t[b] - t[a]).head<2>().norm(); };
  return std::max({side(0, 1), side(1, 2), side(2, 0)});
}

/// 1 for an equilateral triangle, 0 without area: eq. (3) of the paper.
double quality(const TrianglePlaces& t) {
  const double sides =
      (t[1] - t[0]).squaredNorm() + (t[2] - t[1]).squaredNorm() + (t[0] - t[2]).squaredNorm();
  return 2 * std::sqrt(3.0) * area_vector(t).norm() / sides;
}

}  // namespace

EdgeCollapser::EdgeCollapser(std::vector<Eigen::Vector3d> points,
                             const std::vector<Corners>& triangles, double step,
                             ErrorMeasure measure, const MergeTreeOptions& options)
    : points_(std::move(points)),
      normals_(vertex_normals(points_, triangles)),
      mesh_(static_cast<std::uint32_t>(points_.size()), triangles),
      walker_(mesh_),
      least_altitude_(kLeastAltitudeSteps * step),
      measure_(measure),
      options_(options),
      lists_(mesh_.vertex_count(), mesh_.triangle_count()),
      marked_(mesh_.triangle_count(), 0) {
  // a vertex where fans touch was split: each copy is at the place of the given one
  for (auto v = static_cast<std::uint32_t>(points_.size()); v < mesh_.vertex_count(); ++v) {
    points_.push_back(points_[mesh_.origin(VertexId{v})]);
    normals_.push_back(normals_[mesh_.origin(VertexId{v})]);
  }
  for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
    live_vertices_ += mesh_.outgoing(VertexId{v}) != kNoHalfedge;
  }
}

template <class Visit>
void EdgeCollapser::around(VertexId v, Visit visit) const {
  const HalfedgeId first = mesh_.outgoing(v);
  if (first == kNoHalfedge) return;
  HalfedgeId h = first;
  do {
    visit(h);
    h = mesh_.rotate(h);
  } while (h != first);
}

void EdgeCollapser::run() {
  std::uint32_t level = 1;
  while (live_vertices_ > options_.fewest_vertices) {
    const std::uint32_t made = pass(level);
    if (made == 0) return;
    if (options_.passed) options_.passed({level, made, live_vertices_});
    ++level;
  }
}

std::uint32_t EdgeCollapser::pass(std::uint32_t level) {
  ++pass_;
  std::vector<Candidate> order = candidates();
  std::ranges::sort(order, [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.edge < b.edge;
  });
  // lengths change in regions alone that are taken, so sorting once per pass is the paper's heap
  const auto looked_at =
      static_cast<std::size_t>(std::ceil(options_.share * static_cast<double>(order.size())));
  std::uint32_t made = 0;
  for (std::size_t i = 0; i < looked_at; ++i) {
    if (live_vertices_ <= options_.fewest_vertices) break;
    made += try_collapse(order[i], level);
  }
  return made;
}

std::vector<EdgeCollapser::Candidate> EdgeCollapser::candidates() {
  return options_.order == CollapseOrder::kLength ? edges_by_length() : vertices_by_error();
}

std::vector<EdgeCollapser::Candidate> EdgeCollapser::edges_by_length() {
  std::vector<Candidate> edges;
  for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
    around(VertexId{v}, [&](HalfedgeId h) {
      const VertexId end = mesh_.end(h);
      if (mesh_.is_ghost(end) || index(end) < v) return;
      edges.push_back({(at(end) - at(VertexId{v})).squaredNorm(), h});
    });
  }
  return edges;
}

/// For each vertex the edge along which it would go with the smallest error.
std::vector<EdgeCollapser::Candidate> EdgeCollapser::vertices_by_error() {
  std::vector<Candidate> best_edges;
  for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
    Candidate best{kNoLimit, kNoHalfedge};
    around(VertexId{v}, [&](HalfedgeId h) {
      double error = 0;
      if (examine(h, best.cost, error) && error < best.cost) best = {error, h};
    });
    if (best.edge != kNoHalfedge) best_edges.push_back(best);
  }
  return best_edges;
}

bool EdgeCollapser::try_collapse(const Candidate& candidate, std::uint32_t level) {
  HalfedgeId edge = candidate.edge;
  if (!mesh_.is_live(HalfedgeMesh::triangle(edge))) return false;
  double error = 0;
  if (options_.order == CollapseOrder::kError) {
    if (!is_free(edge) || !examine(edge, kNoLimit, error)) return false;
  } else {
    // either end may go: the one that leaves less error
    const HalfedgeId back = mesh_.opposite(edge);
    double back_error = 0;
    const bool forth_is_good = is_free(edge) && examine(edge, kNoLimit, error);
    const bool back_is_good = is_free(back) && examine(back, kNoLimit, back_error);
    if (!forth_is_good && !back_is_good) return false;
    if (!forth_is_good || (back_is_good && back_error < error)) edge = back;
  }
  collapse(edge, level);
  return true;
}

/// Is the region of an edge untouched by those of this pass?
bool EdgeCollapser::is_free(HalfedgeId edge) const {
  bool is_free = true;
  const auto look = [&](HalfedgeId h) {
    if (marked_[index(HalfedgeMesh::triangle(h))] == pass_) is_free = false;
  };
  around(mesh_.start(edge), look);
  if (options_.region == Region::kBothEnds) around(mesh_.end(edge), look);
  return is_free;
}

void EdgeCollapser::mark(HalfedgeId edge) {
  const auto take = [&](HalfedgeId h) { marked_[index(HalfedgeMesh::triangle(h))] = pass_; };
  around(mesh_.start(edge), take);
  if (options_.region == Region::kBothEnds) around(mesh_.end(edge), take);
}

/// Gathers the star of start(edge) and the fan that would replace it.
void EdgeCollapser::walk(HalfedgeId edge) {
  ring_.clear();
  ring_triangles_.clear();
  HalfedgeId h = edge;
  do {
    ring_.push_back(mesh_.end(h));
    ring_triangles_.push_back(static_cast<std::uint32_t>(HalfedgeMesh::triangle(h)));
    h = mesh_.rotate(h);
  } while (h != edge);
  gone_ = mesh_.start(edge);
  star_area_.setZero();
  fan_.clear();
  fan_triangles_.clear();
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const VertexId a = ring_[i], b = ring_[(i + 1) % ring_.size()];
    if (mesh_.is_ghost(a) || mesh_.is_ghost(b)) continue;
    star_area_ += area_vector({at(gone_), at(a), at(b)});
  }
  for (std::size_t i = 1; i + 1 < ring_.size(); ++i) {
    if (mesh_.is_ghost(ring_[i]) || mesh_.is_ghost(ring_[i + 1])) continue;
    fan_.push_back({at(ring_[0]), at(ring_[i]), at(ring_[i + 1])});
    fan_triangles_.push_back(ring_triangles_[i]);
  }
}

/// Does the border run straight in plan through the vertex that would go?
bool EdgeCollapser::is_straight() const {
  // the outside is next to the one that would stay, and then comes the other border vertex
  const std::size_t other = mesh_.is_ghost(ring_[1]) ? 2 : ring_.size() - 2;
  return cross(at(ring_[0]), at(gone_), at(ring_[other])) == 0;
}

/// Do topology and border let the edge collapse?
bool EdgeCollapser::is_allowed(HalfedgeId edge) {
  const VertexId gone = mesh_.start(edge), kept = mesh_.end(edge);
  if (mesh_.is_ghost(gone) || mesh_.is_ghost(kept) || mesh_.is_split(gone)) return false;
  if (mesh_.valence(gone) + mesh_.valence(kept) - 4 > kLargestValence) return false;
  const bool is_border_edge =
      mesh_.is_ghost(mesh_.apex(edge)) || mesh_.is_ghost(mesh_.apex(mesh_.opposite(edge)));
  if (!is_border_edge && mesh_.is_boundary(gone)) return false;
  return walker_.around_edge(edge, stencil_) == Collapsibility::kYes;
}

bool EdgeCollapser::is_sound(std::size_t i) const {
  const TrianglePlaces& places = fan_[i];
  if (options_.smallest_quality > 0 && quality(places) < options_.smallest_quality) return false;
  // exact: differences of lattice places and their products fit a double
  if (measure_ == ErrorMeasure::kVertical) {
    return cross(places[0], places[1], places[2]) > least_altitude_ * longest_side_in_plan(places);
  }
  const Eigen::Vector3d normal = area_vector(places);
  const auto faces = [&](VertexId v) { return normal.dot(normals_[index(v)]) > 0; };
  const auto at = static_cast<std::size_t>(std::ranges::find(ring_triangles_, fan_triangles_[i]) -
                                           ring_triangles_.begin());
  return normal.dot(star_area_) > 0 && faces(ring_[0]) && faces(ring_[at]) && faces(ring_[at + 1]);
}

/// May the edge collapse, with an error below the limit?
bool EdgeCollapser::examine(HalfedgeId edge, double limit, double& error) {
  if (!is_allowed(edge)) return false;
  walk(edge);
  if (fan_.empty()) return false;
  for (std::size_t i = 0; i < fan_.size(); ++i) {
    if (!is_sound(i)) return false;
  }
  if (measure_ == ErrorMeasure::kVertical && mesh_.is_boundary(gone_) && !is_straight()) {
    return false;
  }
  error = sample_error(measure_, at(gone_), fan_).error;
  samples_.clear();
  for (const std::uint32_t t : ring_triangles_) lists_.append_to(samples_, t);
  for (const std::uint32_t s : samples_) {
    if (error >= limit) return false;
    error = std::max(error, sample_error(measure_, points_[s], fan_).error);
  }
  return error < limit;
}

/// Makes the collapse that examine() has looked at.
void EdgeCollapser::collapse(HalfedgeId edge, std::uint32_t level) {
  double error = 0;
  examine(edge, kNoLimit, error);
  mark(edge);
  const auto number = [&](VertexId v) {
    return mesh_.is_ghost(v) ? kOutside : static_cast<std::uint32_t>(v);
  };
  collapses_.push_back({.removed = number(gone_),
                        .kept = number(ring_[0]),
                        .apexes = {number(ring_[1]), number(ring_.back())},
                        .level = level});
  for (const std::uint32_t t : ring_triangles_) lists_.clear(t);
  samples_.push_back(number(gone_));
  for (const std::uint32_t s : samples_) {
    lists_.add(s, fan_triangles_[sample_error(measure_, points_[s], fan_).triangle]);
  }
  mesh_.collapse(stencil_.spokes, stencil_.dying_span(), ring_[0]);
  --live_vertices_;
}

}  // namespace terrane::hierarchy
