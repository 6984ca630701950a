#include "hierarchy/merge/grow_tree.h"

#include <algorithm>
#include <numeric>

#include "core/errors.h"
#include "hierarchy/levels/level_sequence.h"

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// deeper than any tree of 2^32 vertices needs; bounds the depth of every walk along dependencies
constexpr std::uint32_t kMostLevels = 4096;

[[noreturn]] void damaged() {
  throw InputError("the merge tree is damaged: a split does not fit its mesh. Build it again");
}

}  // namespace

TreeGrower::TreeGrower(MergeTree tree) : tree_(std::move(tree)) {
  tree_.coarsest_points = static_cast<std::uint32_t>(tree_.points.size());
  tree_.coarsest_triangles = static_cast<std::uint32_t>(tree_.triangles.size());
  incident_.resize(tree_.points.size());
  maker_.assign(tree_.triangles.size(), kNone);
  first_reader_.assign(tree_.triangles.size(), kNone);
  tree_.coarser_begin.push_back(0);
  for (std::uint32_t t = 0; t < tree_.triangles.size(); ++t) {
    const Corners& c = tree_.triangles[t];
    if (std::max({c[0], c[1], c[2]}) >= tree_.points.size()) damaged();
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) damaged();
    for (const std::uint32_t v : c) incident_[v].push_back(t);
  }
}

std::vector<TreeGrower::RingEdge> TreeGrower::ring_edges(std::uint32_t vertex) const {
  std::vector<RingEdge> edges;
  edges.reserve(incident_[vertex].size() + 2);
  for (const std::uint32_t t : incident_[vertex]) {
    const Corners& c = tree_.triangles[t];
    const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
    edges.push_back({c[(k + 1) % 3], c[(k + 2) % 3], t});
  }
  if (edges.empty()) damaged();
  // start: the edge that no other leads to; on a closed ring the one from the smallest number
  auto first =
      std::min_element(edges.begin(), edges.end(),
                       [](const RingEdge& a, const RingEdge& b) { return a.from < b.from; });
  for (auto edge = edges.begin(); edge != edges.end(); ++edge) {
    if (std::none_of(edges.begin(), edges.end(),
                     [&](const RingEdge& e) { return e.to == edge->from; }))
      first = edge;
  }
  std::iter_swap(edges.begin(), first);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(i);
    const auto next = std::find_if(
        begin, edges.end(), [&](const RingEdge& edge) { return edge.from == edges[i - 1].to; });
    if (next == edges.end()) damaged();
    std::iter_swap(begin, next);
  }
  return edges;
}

std::vector<std::uint32_t> TreeGrower::ring(std::uint32_t vertex) const {
  std::vector<std::uint32_t> result;
  const auto edges = ring_edges(vertex);
  for (const RingEdge& edge : edges) result.push_back(edge.from);
  if (edges.back().to != edges.front().from) result.push_back(edges.back().to);
  return result;
}

/// The ring with the outside as a vertex of it, so that both kinds are walked alike.
std::vector<TreeGrower::RingEdge> TreeGrower::closed_ring(std::uint32_t vertex) const {
  auto ring = ring_edges(vertex);
  if (ring.back().to != ring.front().from) {
    const std::uint32_t first = ring.front().from;
    ring.push_back({ring.back().to, kOutside, kNone});
    ring.push_back({kOutside, first, kNone});
  }
  return ring;
}

void TreeGrower::check(const Split& split) const {
  const bool is_known = split.child_count == 1 || split.child_count == 3;
  if (!is_known || split.parent >= incident_.size() || incident_[split.parent].empty()) damaged();
  if (split.level == 0 || split.level > kMostLevels) damaged();
  if (!tree_.merges.empty() && split.level > tree_.merges.back().level) damaged();
  if (split.child_count == 1 && split.apexes[0] == split.apexes[1]) damaged();
  // lattice places have 24 bits, so that floats hold them and orientations are exact
  for (std::uint32_t k = 0; k < split.child_count; ++k) {
    if (split.places[k].cwiseAbs().maxCoeff() > 1 << 24) damaged();
  }
}

/// Deals the ring's edges out among the corners, from apex to apex.
void TreeGrower::choose_owners(const Split& split, std::span<const std::uint32_t> corners) {
  owners_.assign(ring_.size(), kNone);
  const std::size_t arcs = corners.size();
  std::size_t dealt = 0;
  for (std::size_t k = 0; k < arcs; ++k) {
    const std::uint32_t begin = split.apexes[k], end = split.apexes[(k + 1) % arcs];
    if (begin == end) continue;
    auto at =
        static_cast<std::size_t>(std::find_if(ring_.begin(), ring_.end(),
                                              [&](const RingEdge& e) { return e.from == begin; }) -
                                 ring_.begin());
    if (at == ring_.size()) damaged();
    for (;;) {
      if (owners_[at] != kNone) damaged();
      owners_[at] = corners[(k + 1) % arcs];
      ++dealt;
      const std::uint32_t reached = ring_[at].to;
      at = (at + 1) % ring_.size();
      if (reached == end) break;
    }
  }
  if (dealt != ring_.size()) damaged();
}

void TreeGrower::add_triangle(const Corners& corners) {
  const auto t = static_cast<std::uint32_t>(tree_.triangles.size());
  tree_.triangles.push_back(corners);
  maker_.push_back(tree_.merge_count());
  first_reader_.push_back(kNone);
  for (const std::uint32_t v : corners) incident_[v].push_back(t);
}

void TreeGrower::remove_from(std::uint32_t vertex, std::uint32_t triangle) {
  auto& list = incident_[vertex];
  list.erase(std::find(list.begin(), list.end(), triangle));
}

void TreeGrower::depend_on_triangle(std::uint32_t triangle) {
  if (maker_[triangle] != kNone) needed_.push_back(maker_[triangle]);
  for (std::uint32_t r = first_reader_[triangle]; r != kNone; r = readers_[r].next) {
    needed_.push_back(readers_[r].split);
  }
}

void TreeGrower::remember_reader(std::uint32_t triangle) {
  // the triangle itself may change hands later, but not before this split
  if (maker_[triangle] != kNone) needed_.push_back(maker_[triangle]);
  readers_.push_back({tree_.merge_count(), first_reader_[triangle]});
  first_reader_[triangle] = static_cast<std::uint32_t>(readers_.size()) - 1;
}

/// Replaces the triangles that change hands by new ones.
void TreeGrower::replace_triangles(std::uint32_t parent) {
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const std::uint32_t t = ring_[i].triangle;
    if (t == kNone) continue;
    if (owners_[i] == parent) {
      if (tree_.region == Region::kBothEnds) remember_reader(t);
      continue;
    }
    depend_on_triangle(t);
    tree_.coarse_triangles.push_back(t);
    for (const std::uint32_t v : tree_.triangles[t]) remove_from(v, t);
    add_triangle({owners_[i], ring_[i].from, ring_[i].to});
  }
}

void TreeGrower::end_dependencies(std::uint32_t level) {
  std::sort(needed_.begin(), needed_.end());
  const auto rest = std::unique(needed_.begin(), needed_.end());
  needed_.erase(rest, needed_.end());
  for (const std::uint32_t j : needed_) {
    if (tree_.merges[j].level <= level) damaged();
    tree_.coarser_merges.push_back(j);
  }
  tree_.coarser_begin.push_back(static_cast<std::uint32_t>(tree_.coarser_merges.size()));
}

void TreeGrower::split(const Split& split) {
  check(split);
  ring_ = closed_ring(split.parent);
  needed_.clear();

  Merge merge{.parent = split.parent,
              .first_child = static_cast<std::uint32_t>(tree_.points.size()),
              .child_count = split.child_count,
              .level = split.level,
              .fine_begin = static_cast<std::uint32_t>(tree_.triangles.size()),
              .coarse_begin = static_cast<std::uint32_t>(tree_.coarse_triangles.size())};
  for (std::uint32_t k = 0; k < split.child_count; ++k) {
    tree_.points.push_back(split.places[k]);
    incident_.emplace_back();
  }
  const std::uint32_t first = merge.first_child;
  const bool is_edge = split.child_count == 1;
  const std::array<std::uint32_t, 3> corners{is_edge ? split.parent : first,
                                             is_edge ? first : first + 1, first + 2};
  const std::size_t arcs = is_edge ? 2 : 3;
  choose_owners(split, std::span(corners).first(arcs));
  replace_triangles(split.parent);
  // an ear has nothing to come back to, so nothing to depend on
  if (tree_.coarse_triangles.size() == merge.coarse_begin) damaged();
  for (std::size_t k = 0; k < arcs; ++k) {
    if (split.apexes[k] == kOutside) continue;
    add_triangle({corners[(k + 1) % arcs], corners[k], split.apexes[k]});
  }
  if (!is_edge) add_triangle(corners);

  merge.fine_end = static_cast<std::uint32_t>(tree_.triangles.size());
  merge.coarse_end = static_cast<std::uint32_t>(tree_.coarse_triangles.size());
  end_dependencies(split.level);
  tree_.merges.push_back(merge);
}

MergeTree TreeGrower::finish() && {
  // turn the rows round: finer() lists, in ascending order, who names a merge in coarser()
  std::vector<std::uint32_t>& begin = tree_.finer_begin;
  begin.assign(tree_.merges.size() + 1, 0);
  for (const std::uint32_t j : tree_.coarser_merges) ++begin[j + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  tree_.finer_merges.resize(tree_.coarser_merges.size());
  std::vector<std::uint32_t> free(begin.begin(), begin.end() - 1);
  for (std::uint32_t i = 0; i < tree_.merge_count(); ++i) {
    for (const std::uint32_t j : tree_.coarser(i)) tree_.finer_merges[free[j]++] = i;
  }
  return std::move(tree_);
}

}  // namespace terrane::hierarchy
