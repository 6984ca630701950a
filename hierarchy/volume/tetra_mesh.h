#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace terrane::hierarchy::volume {

/// A tetrahedron of the binary tree, whether it is split or not.
enum class CellId : std::uint32_t {};
/// A vertex of the tetrahedral mesh.
enum class NodeId : std::uint32_t {};

inline constexpr CellId kNoCell{~std::uint32_t{0}};

constexpr std::size_t index(CellId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(NodeId id) { return static_cast<std::size_t>(id); }

/// The space that a mesh fills: edges along the axes, in the units of the model (metres).
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Ones();

  Eigen::Vector3d size() const { return high - low; }
};

/// All cells around one edge are bisected together, at the middle of the edge: a diamond.
struct Diamond {
  NodeId middle{};                  ///< the vertex that a split makes, and a merge takes away
  std::array<NodeId, 2> ends;       ///< of the edge
  std::span<const CellId> parents;  ///< the cells around the edge; valid until the next change
  /// For each parent its two halves (after a merge: that were). Valid until the next change.
  std::span<const std::array<CellId, 2>> children;
};

/// Tetrahedra that fill a box, refined by bisection of longest edges; always conforming.
///
/// Six tetrahedra around the box's main diagonal are the roots of a binary tree. A cell is bisected
/// at the middle of one of its edges, which is chosen so that only three shapes exist (in a cube:
/// the longest edge). A leaf is a cell that is not bisected; the leaves fill the box.
///
/// Guarantees, after any sequence of splits and merges: every face of a leaf is the face of exactly
/// one other leaf, or lies on the box; no vertex lies inside an edge or a face of a leaf. The cells
/// around an edge are bisected together, and those that are too coarse for that are bisected first.
/// The cells of the tree and their shapes depend on nothing but the box.
///
/// Sizes: about 60 bytes for each leaf, all included (bytes() measures). At most 2^31 leaves and
/// kMostLevels levels.
///
/// \par Source
/// Gregorski et al. 2003, section 3; the bisection of Zhou et al. 1997 in the tagged form of
/// Maubach 1995, where the vertices of a cell are ordered and its level gives the edge.
class TetraMesh {
 public:
  /// Deepest level of a cell: below it, middles of edges are no whole numbers any more.
  static constexpr int kMostLevels = 90;

  /// Six cells. \throws ConfigError if the box is empty in some direction, or not finite.
  explicit TetraMesh(const Box& box);

  /// Bisects one diamond: that of \p cell, or one that has to be bisected before it.
  ///
  /// To bisect a cell, call this until it is no leaf any more; each call changes one diamond.
  /// \pre is_leaf(cell) and level(cell) < kMostLevels.
  Diamond split_towards(CellId cell);

  /// Whether the diamond that made a vertex can be taken back: all its children are leaves.
  /// Vertices of the box's corners cannot.
  bool can_merge(NodeId middle) const;

  /// Takes a diamond back. Ids of its children and of its middle may be used again.
  /// \pre can_merge(middle).
  Diamond merge(NodeId middle);

  bool is_leaf(CellId cell) const { return (entry(cell) & kLeafBit) != 0; }
  bool is_root(CellId cell) const { return index(cell) < kRoots; }

  /// The cell that was bisected into this one. \pre !is_root(cell).
  CellId parent(CellId cell) const { return pairs_[index(cell) / 2].parent; }
  /// \pre !is_leaf(cell).
  std::array<CellId, 2> children(CellId cell) const {
    return {CellId{2 * entry(cell)}, CellId{2 * entry(cell) + 1}};
  }

  /// Corners of a leaf, in the order that bisection needs (not by orientation).
  const std::array<NodeId, 4>& corners(CellId leaf) const { return leaves_[slot(leaf)].corners; }
  /// Neighbours of a leaf, each opposite to the corner of the same place; kNoCell: the box ends.
  std::array<CellId, 4> neighbours(CellId leaf) const;
  /// 0 for a root, one more with each bisection.
  int level(CellId leaf) const { return leaves_[slot(leaf)].level; }
  /// The edge at whose middle a leaf is bisected.
  std::array<NodeId, 2> split_edge(CellId leaf) const;

  /// Place of a vertex: exactly the same whichever way the mesh came to it.
  Eigen::Vector3d position(NodeId node) const;
  /// Place of a vertex as 2^-30 parts of the box along each axis, 0 to 2^30.
  const std::array<std::uint32_t, 3>& lattice(NodeId node) const {
    return nodes_[index(node)].lattice;
  }

  std::size_t leaf_count() const { return leaves_.size() - free_slots_.size(); }
  std::size_t node_count() const { return nodes_.size() - free_nodes_.size(); }
  /// Ids of cells and vertices are below these.
  std::size_t cell_capacity() const { return 2 * pairs_.size(); }
  std::size_t node_capacity() const { return nodes_.size(); }
  /// Whether a vertex is there (and not one that a merge took away).
  bool has(NodeId node) const { return nodes_[index(node)].incident != 0; }
  const Box& box() const { return box_; }
  /// The vertex in the middle of the edge at which a cell was bisected. \pre !is_leaf(cell).
  NodeId middle(CellId cell) const { return pairs_[entry(cell)].middle; }

  /// Memory in use, in bytes, what is reserved for growth left out.
  std::size_t bytes() const;
  /// Makes room, so that memory does not grow in jumps.
  void reserve(std::size_t leaves);

  /// Calls f(CellId) for every leaf, in an order that depends on the history of changes.
  template <class F>
  void for_each_leaf(F&& f) const {
    for (const Leaf& leaf : leaves_) {
      if (leaf.cell != kNoCell) f(leaf.cell);
    }
  }

  /// A leaf that holds a place, and the weights of its corners there (which add up to 1).
  struct Located {
    CellId leaf{};
    Eigen::Vector4d weights;
  };
  /// Finds the leaf at a place; a place outside the box counts as the nearest one on it.
  Located locate(const Eigen::Vector3d& p) const;

  /// Leaves in the order of the tree: the same whichever way the mesh came to them.
  std::vector<CellId> leaves_in_tree_order() const;

 private:
  using Slot = std::uint32_t;
  static constexpr std::size_t kRoots = 6;
  /// Kuhn's triangulation of a cube: each root walks the axes in another order.
  static constexpr std::array<std::array<int, 3>, kRoots> kAxes = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  static constexpr Slot kNoSlot = ~Slot{0};
  static constexpr std::uint32_t kLeafBit = std::uint32_t{1} << 31;

  /// Two siblings. An entry is the slot of a leaf (with kLeafBit), or the number of the pair below.
  struct Pair {
    CellId parent = kNoCell;
    NodeId middle{};  ///< where the parent was bisected
    std::array<std::uint32_t, 2> entry{};
  };
  /// What only leaves need, so that the tree above costs 16 bytes for each leaf.
  struct Leaf {
    std::array<NodeId, 4> corners;
    std::array<Slot, 4> neighbours;  ///< opposite to the corner of the same place
    CellId cell = kNoCell;           ///< kNoCell: not in use
    std::uint8_t level = 0;
  };
  struct Node {
    std::array<std::uint32_t, 3> lattice;
    CellId maker = kNoCell;       ///< one of the cells that were bisected here
    std::uint16_t incident = 0;   ///< leaves around it; 0: not in use
    std::uint16_t made_with = 0;  ///< leaves around it when it was made
  };

  std::uint32_t& entry(CellId cell) { return pairs_[index(cell) / 2].entry[index(cell) % 2]; }
  std::uint32_t entry(CellId cell) const { return pairs_[index(cell) / 2].entry[index(cell) % 2]; }
  Slot slot(CellId leaf) const { return entry(leaf) & ~kLeafBit; }

  bool collect_ring(Slot start, std::array<NodeId, 2> edge, bool is_to_be_split);
  bool walk(Slot from, NodeId ahead, std::array<NodeId, 2> edge, bool is_to_be_split);
  void make_roots();
  NodeId make_node(std::array<NodeId, 2> edge);
  Slot make_slot();
  std::uint32_t make_pair(CellId parent, NodeId middle);
  Slot bisect(Slot slot, NodeId middle);
  void unite(CellId parent);
  void join(const std::vector<Slot>& ring);
  void count_incident(const Leaf& parent, NodeId middle, int change);
  void relink(Slot leaf, Slot old_neighbour, Slot new_neighbour);

  Box box_;
  std::vector<Pair> pairs_;
  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_pairs_;
  std::vector<Slot> free_slots_;
  std::vector<NodeId> free_nodes_;

  // kept for their memory only: the cells around an edge, in order
  std::vector<Slot> ring_;
  std::vector<NodeId> rim_;  ///< rim_[i], rim_[i + 1]: the corners of ring_[i] off the edge
  Slot obstacle_ = kNoSlot;  ///< a neighbour that has to be bisected first
  std::array<std::vector<Slot>, 2> halves_;  ///< the children of the ring at each end of the edge
  std::vector<CellId> parents_;
  std::vector<std::array<CellId, 2>> children_;
};

}  // namespace terrane::hierarchy::volume
