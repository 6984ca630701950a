#pragma once

#include <optional>
#include <queue>
#include <vector>

#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::hierarchy::volume {

/// The two queues that steer a TetraMesh: leaves to split, worst first, and diamonds to merge, the
/// least worth first.
///
/// Entries that became invalid stay in the queues and are skipped when they come up; so each change
/// costs O(log n), and nobody has to find an entry. Equal priorities are served by id, smallest
/// first: the same calls give the same answers.
/// \par Source
/// ROAM (Duchaineau et al. 1997), as Gregorski et al. 2003, section 3, use it.
class RefinementQueues {
 public:
  /// Says how much a leaf wants to be split (any scale, not NaN). Wins over what was said before.
  void want_split(CellId leaf, double priority);
  /// The cell is no leaf any more, or is gone, or needs no split.
  void forget(CellId cell);
  /// Says how much a diamond that can be merged is worth.
  void allow_merge(NodeId middle, double worth);
  /// The diamond is gone, or cannot be merged any more.
  void forget(NodeId middle);

  struct Split {
    CellId cell{};
    double priority = 0;
  };
  struct Merge {
    NodeId middle{};
    double worth = 0;
  };
  /// The leaf that wants a split most; it stays in the queue.
  std::optional<Split> worst();
  /// The diamond that is worth least; it stays in the queue.
  std::optional<Merge> least();

 private:
  struct Entry {
    double key;  ///< the largest is served first
    std::uint32_t id;
    bool operator<(const Entry& other) const {
      return key != other.key ? key < other.key : id > other.id;
    }
  };
  /// A heap with the key that holds for each id; NaN: none.
  struct Queue {
    std::priority_queue<Entry> heap;
    std::vector<double> key;

    void set(std::uint32_t id, double new_key);
    void forget(std::uint32_t id);
    std::optional<Entry> top();
  };
  Queue splits_, merges_;
};

}  // namespace terrane::hierarchy::volume
