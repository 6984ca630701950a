#pragma once

#include <vector>

#include "hierarchy/levels/judge_pool.h"
#include "hierarchy/levels/weight_table.h"

namespace terrane::hierarchy {

/// A triangle with its weight, or what it cannot be below.
struct Entry {
  double key;
  std::uint32_t triangle;

  /// The order of the queue: ties go by number.
  bool operator<(const Entry& other) const {
    return key != other.key ? key < other.key : triangle < other.triangle;
  }
};

/// A triangle that may be next, with its corners at hand.
struct Waiting : Entry {
  std::array<VertexId, 3> corners;
};

/// The triangles of a level in the order of their weights, a portion at a time: the weights of
/// those that are not reached are never worked out.
///
/// Within a portion triangles stay in memory order, so that neighbours are looked at one after the
/// other.
class WeightOrder {
 public:
  WeightOrder(const LevelMesh& level, WeightTable& weights, JudgePool& judges);

  /// Begins a level, with all live triangles. \return how many there are.
  std::size_t begin_level();

  /// Weighs the lightest of those left, about so many of them. All that is left then is heavier.
  ///
  /// \param taken  for each vertex: is it in a stencil that was taken? Triangles there keep their
  ///               bound, as those that are rejected do.
  /// \return false if none is left. \pre the portion before is used up.
  bool next_portion(std::size_t size, const std::vector<std::uint8_t>& taken);
  /// Takes at least so many of the portion, the lightest, in memory order.
  /// \return none if it is used up.
  std::vector<Waiting>& lightest_of_portion(std::size_t count);

  /// Follows LevelMesh::compact().
  void list_candidates();

 private:
  void fill_portion(double heaviest);
  void weigh_portion(const std::vector<std::uint8_t>& taken);

  const LevelMesh& level_;
  WeightTable& weights_;
  JudgePool& judges_;
  std::vector<std::uint32_t> candidates_;  // live triangles, by number
  bool is_first_ = true;                   // of the level's portions: rest_ is yet to be filled
  std::vector<Waiting> portion_;           // of the order: what comes next,
  std::vector<Entry> rest_;                // and what comes later
  std::vector<Waiting> slice_;
  std::vector<double> sample_;
};

}  // namespace terrane::hierarchy
