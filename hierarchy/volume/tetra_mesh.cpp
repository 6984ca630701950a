#include "hierarchy/volume/tetra_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/errors.h"

namespace terrane::hierarchy::volume {
namespace {

constexpr std::uint32_t kFullEdge = std::uint32_t{1} << 30;

/// Place in the corners of the second end of the split edge; the first end is always corner 0.
int split_end(int level) { return 3 - level % 3; }

template <class Leaf>
int place_of(const Leaf& leaf, NodeId corner) {
  for (int i = 0; i < 3; ++i) {
    if (leaf.corners[i] == corner) return i;
  }
  return 3;
}

/// The corner that is none of three.
template <class Leaf>
NodeId fourth(const Leaf& leaf, NodeId a, NodeId b, NodeId c) {
  return *std::find_if(leaf.corners.begin(), leaf.corners.end(),
                       [&](NodeId corner) { return corner != a && corner != b && corner != c; });
}

bool is_same_edge(std::array<NodeId, 2> a, std::array<NodeId, 2> b) {
  return (a[0] == b[0] && a[1] == b[1]) || (a[0] == b[1] && a[1] == b[0]);
}

}  // namespace

TetraMesh::TetraMesh(const Box& box) : box_(box) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.size()[axis] > 0) || !std::isfinite(box.low[axis]) ||
        !std::isfinite(box.high[axis])) {
      throw ConfigError(
          fmt::format("box: from {} to {} along axis {} is no extent. Give a lower "
                      "end that is below the upper one",
                      box.low[axis], box.high[axis], axis));
    }
  }
  make_roots();
}

// A root for each order of the axes, walked from (0,0,0) to (1,1,1). Corner number k of the cube
// has bit a of k along axis a.
void TetraMesh::make_roots() {
  nodes_.resize(8);
  for (std::uint32_t k = 0; k < 8; ++k) {
    for (int axis = 0; axis < 3; ++axis) nodes_[k].lattice[axis] = (k >> axis & 1) * kFullEdge;
  }
  pairs_.resize(kRoots / 2);
  leaves_.resize(kRoots);
  for (std::uint32_t r = 0; r < kRoots; ++r) {
    entry(CellId{r}) = r | kLeafBit;
    leaves_[r].cell = CellId{r};
    leaves_[r].neighbours.fill(kNoSlot);
    std::uint32_t corner = 0;
    leaves_[r].corners[0] = NodeId{0};
    for (int step = 0; step < 3; ++step) {
      corner |= 1u << kAxes[r][step];
      leaves_[r].corners[step + 1] = NodeId{corner};
    }
    for (const NodeId c : leaves_[r].corners) ++nodes_[index(c)].incident;
  }
  // two roots are neighbours where they differ in one corner
  for (Slot a = 0; a < kRoots; ++a) {
    for (Slot b = 0; b < kRoots; ++b) {
      int place = -1, differences = 0;
      for (int i = 0; i < 4; ++i) {
        if (leaves_[a].corners[i] == leaves_[b].corners[i]) continue;
        place = i;
        ++differences;
      }
      if (differences == 1) leaves_[a].neighbours[place] = b;
    }
  }
}

std::array<NodeId, 2> TetraMesh::split_edge(CellId leaf) const {
  const Leaf& l = leaves_[slot(leaf)];
  return {l.corners[0], l.corners[split_end(l.level)]};
}

std::array<CellId, 4> TetraMesh::neighbours(CellId leaf) const {
  std::array<CellId, 4> cells;
  std::ranges::transform(leaves_[slot(leaf)].neighbours, cells.begin(),
                         [&](Slot s) { return s == kNoSlot ? kNoCell : leaves_[s].cell; });
  return cells;
}

Eigen::Vector3d TetraMesh::position(NodeId node) const {
  const auto& at = lattice(node);
  const Eigen::Vector3d fraction =
      Eigen::Vector3d(at[0], at[1], at[2]) / static_cast<double>(kFullEdge);
  return box_.low + box_.size().cwiseProduct(fraction);
}

std::size_t TetraMesh::bytes() const {
  return sizeof(*this) + pairs_.size() * sizeof(Pair) + leaves_.size() * sizeof(Leaf) +
         nodes_.size() * sizeof(Node) + free_pairs_.size() * sizeof(std::uint32_t) +
         free_slots_.size() * sizeof(Slot) + free_nodes_.size() * sizeof(NodeId);
}

void TetraMesh::reserve(std::size_t leaves) {
  pairs_.reserve(leaves);
  leaves_.reserve(leaves);
  nodes_.reserve(leaves / 5);  // a mesh of many cells has between five and six for each vertex
}

std::vector<CellId> TetraMesh::leaves_in_tree_order() const {
  std::vector<CellId> leaves, stack;
  leaves.reserve(leaf_count());
  for (std::uint32_t r = kRoots; r-- > 0;) stack.push_back(CellId{r});
  while (!stack.empty()) {
    const CellId cell = stack.back();
    stack.pop_back();
    if (is_leaf(cell)) {
      leaves.push_back(cell);
    } else {
      stack.push_back(children(cell)[1]);
      stack.push_back(children(cell)[0]);
    }
  }
  return leaves;
}

// In a cell whose split edge ends at corners 0 and d, a place lies in the half of that end which
// weighs more; the middle takes twice the lesser weight.
TetraMesh::Located TetraMesh::locate(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d t = (p - box_.low).cwiseQuotient(box_.size()).cwiseMax(0.0).cwiseMin(1.0);
  const auto root = std::ranges::find_if(kAxes, [&](const auto& axes) {
    return t[axes[0]] >= t[axes[1]] && t[axes[1]] >= t[axes[2]];
  });
  const auto& axes = *root;
  Eigen::Vector4d w(1 - t[axes[0]], t[axes[0]] - t[axes[1]], t[axes[1]] - t[axes[2]], t[axes[2]]);
  CellId cell{static_cast<std::uint32_t>(root - kAxes.begin())};
  for (int level = 0; !is_leaf(cell); ++level) {
    const int d = split_end(level);
    const bool is_first = w[0] >= w[d];
    const double middle = 2 * std::min(w[0], w[d]), end = std::abs(w[0] - w[d]);
    if (is_first) {
      w[0] = end;
    } else {
      for (int i = 0; i + 1 < d; ++i) w[i] = w[i + 1];
      w[d - 1] = end;
    }
    w[d] = middle;
    cell = children(cell)[is_first ? 0 : 1];
  }
  return {cell, w};
}

// Goes round the edge from a cell, over the faces that hold `ahead`. Stops at the box, where it
// started, or at a neighbour that is too coarse. True: the ring is complete or ends at the box.
bool TetraMesh::walk(Slot from, NodeId ahead, std::array<NodeId, 2> edge, bool is_to_be_split) {
  const auto [a, b] = edge;
  ring_.assign(1, from);
  rim_.assign({fourth(leaves_[from], a, b, ahead), ahead});
  for (;;) {
    const Leaf& last = leaves_[ring_.back()];
    const Slot next = last.neighbours[place_of(last, rim_[rim_.size() - 2])];
    if (next == kNoSlot || next == from) return true;
    const Leaf& leaf = leaves_[next];
    if (is_to_be_split &&
        !is_same_edge(edge, {leaf.corners[0], leaf.corners[split_end(leaf.level)]})) {
      obstacle_ = next;
      return false;
    }
    rim_.push_back(fourth(leaf, a, b, rim_.back()));
    ring_.push_back(next);
  }
}

// Fills ring_ and rim_. False where a cell of the ring has to be bisected first: obstacle_.
bool TetraMesh::collect_ring(Slot start, std::array<NodeId, 2> edge, bool is_to_be_split) {
  const Leaf& leaf = leaves_[start];
  NodeId ahead = leaf.corners[3];
  if (ahead == edge[0] || ahead == edge[1]) {
    ahead = *std::find_if(leaf.corners.begin(), leaf.corners.end(),
                          [&](NodeId c) { return c != edge[0] && c != edge[1]; });
  }
  if (!walk(start, ahead, edge, is_to_be_split)) return false;
  const bool is_closed = ring_.size() > 2 && rim_.front() == rim_.back();
  if (is_closed) return true;
  // the walk ended at the box: once more, from there, to the box on the other side
  const Slot end = ring_.back();
  return walk(end, rim_[rim_.size() - 2], edge, is_to_be_split);
}

Diamond TetraMesh::split_towards(CellId cell) {
  Slot start = slot(cell);
  std::array<NodeId, 2> edge = split_edge(cell);
  while (!collect_ring(start, edge, true)) {
    start = obstacle_;
    edge = split_edge(leaves_[start].cell);
  }
  const NodeId middle = make_node(edge);
  parents_.clear();
  children_.clear();
  for (auto& half : halves_) half.clear();
  for (const Slot near : ring_) {
    parents_.push_back(leaves_[near].cell);
    const int end_of_near = leaves_[near].corners[0] == edge[0] ? 0 : 1;
    const Slot far = bisect(near, middle);
    halves_[end_of_near].push_back(near);
    halves_[1 - end_of_near].push_back(far);
    children_.push_back(children(parents_.back()));
  }
  for (const auto& half : halves_) join(half);
  Node& node = nodes_[index(middle)];
  node.maker = parents_.front();
  node.made_with = node.incident;
  return {middle, edge, parents_, children_};
}

// The first child takes over the parent's slot, the second gets a new one.
TetraMesh::Slot TetraMesh::bisect(Slot near, NodeId middle) {
  const Slot far = make_slot();
  const Leaf parent = leaves_[near];
  assert(parent.level < kMostLevels);
  const int d = split_end(parent.level);
  const std::uint32_t pair = make_pair(parent.cell, middle);
  entry(parent.cell) = pair;

  Leaf& first = leaves_[near];
  first.corners[d] = middle;
  first.neighbours[0] = far;  // that opposite to the middle stays in its place
  first.cell = CellId{2 * pair};
  first.level = static_cast<std::uint8_t>(parent.level + 1);

  Leaf& second = leaves_[far];
  second = parent;
  for (int i = 0; i < d; ++i) second.corners[i] = parent.corners[i + 1];
  second.corners[d] = middle;
  second.neighbours.fill(kNoSlot);
  second.neighbours[d - 1] = near;
  second.neighbours[d] = parent.neighbours[0];
  second.cell = CellId{2 * pair + 1};
  second.level = first.level;

  pairs_[pair].entry = {near | kLeafBit, far | kLeafBit};
  relink(parent.neighbours[0], near, far);
  count_incident(parent, middle, 1);
  return far;
}

void TetraMesh::count_incident(const Leaf& parent, NodeId middle, int change) {
  const int d = split_end(parent.level);
  for (int i = 1; i < 4; ++i) {
    if (i != d) nodes_[index(parent.corners[i])].incident += static_cast<std::uint16_t>(change);
  }
  nodes_[index(middle)].incident += static_cast<std::uint16_t>(2 * change);
}

// Makes each cell of a ring the neighbour of the next one, over the rim's vertices.
void TetraMesh::join(const std::vector<Slot>& ring) {
  const std::size_t count = ring.size();
  const bool is_closed = count > 2 && rim_.front() == rim_.back();
  for (std::size_t i = 0; i < (is_closed ? count : count - 1); ++i) {
    const Slot here = ring[i], next = ring[(i + 1) % count];
    const NodeId beyond = i + 2 < rim_.size() ? rim_[i + 2] : rim_[1];
    leaves_[here].neighbours[place_of(leaves_[here], rim_[i])] = next;
    leaves_[next].neighbours[place_of(leaves_[next], beyond)] = here;
  }
}

void TetraMesh::relink(Slot leaf, Slot old_neighbour, Slot new_neighbour) {
  if (leaf == kNoSlot) return;
  auto& neighbours = leaves_[leaf].neighbours;
  *std::find(neighbours.begin(), neighbours.end(), old_neighbour) = new_neighbour;
}

bool TetraMesh::can_merge(NodeId middle) const {
  const Node& node = nodes_[index(middle)];
  // each bisection of a child adds a leaf at the middle, and nothing else does
  return node.made_with != 0 && node.incident == node.made_with;
}

Diamond TetraMesh::merge(NodeId middle) {
  assert(can_merge(middle));
  const CellId maker = nodes_[index(middle)].maker;
  const Leaf& first = leaves_[slot(children(maker)[0])];
  const Leaf& second = leaves_[slot(children(maker)[1])];
  const std::array<NodeId, 2> edge = {first.corners[0],
                                      second.corners[split_end(first.level - 1) - 1]};
  collect_ring(slot(children(maker)[0]), {edge[0], middle}, false);
  parents_.clear();
  children_.clear();
  for (const Slot half : ring_) {
    parents_.push_back(parent(leaves_[half].cell));
    children_.push_back(children(parents_.back()));
  }
  halves_[0].clear();
  for (const CellId united : parents_) {
    unite(united);
    halves_[0].push_back(slot(united));
  }
  join(halves_[0]);
  nodes_[index(middle)] = {};
  free_nodes_.push_back(middle);
  return {middle, edge, parents_, children_};
}

void TetraMesh::unite(CellId parent) {
  const std::uint32_t pair = entry(parent);
  const auto [near_cell, far_cell] = children(parent);
  const Slot near = slot(near_cell), far = slot(far_cell);
  Leaf& leaf = leaves_[near];
  const Leaf second = leaves_[far];
  leaf.level = static_cast<std::uint8_t>(leaf.level - 1);
  const int d = split_end(leaf.level);
  for (int i = 0; i < d; ++i) leaf.corners[i + 1] = second.corners[i];
  leaf.neighbours[0] = second.neighbours[d];
  leaf.cell = parent;
  relink(second.neighbours[d], far, near);
  count_incident(leaf, pairs_[pair].middle, -1);
  entry(parent) = near | kLeafBit;
  leaves_[far].cell = kNoCell;
  free_slots_.push_back(far);
  free_pairs_.push_back(pair);
}

NodeId TetraMesh::make_node(std::array<NodeId, 2> edge) {
  Node node;
  const auto &a = lattice(edge[0]), &b = lattice(edge[1]);
  for (int axis = 0; axis < 3; ++axis) node.lattice[axis] = (a[axis] + b[axis]) / 2;
  if (free_nodes_.empty()) {
    nodes_.push_back(node);
    return NodeId{static_cast<std::uint32_t>(nodes_.size() - 1)};
  }
  const NodeId id = free_nodes_.back();
  free_nodes_.pop_back();
  nodes_[index(id)] = node;
  return id;
}

TetraMesh::Slot TetraMesh::make_slot() {
  if (free_slots_.empty()) {
    leaves_.emplace_back();
    return static_cast<Slot>(leaves_.size() - 1);
  }
  const Slot slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

std::uint32_t TetraMesh::make_pair(CellId parent, NodeId middle) {
  std::uint32_t pair = 0;
  if (free_pairs_.empty()) {
    pair = static_cast<std::uint32_t>(pairs_.size());
    pairs_.emplace_back();
  } else {
    pair = free_pairs_.back();
    free_pairs_.pop_back();
  }
  pairs_[pair].parent = parent;
  pairs_[pair].middle = middle;
  return pair;
}

}  // namespace terrane::hierarchy::volume
