#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/merge/display_mesh.h"
#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// Children on their way to their parent's place, or back, over a few frames.
///
/// Only those of merges that could be made at once move: their star is then exactly the triangles
/// that the merge replaces, so a triangle has moving corners of one merge only. Where that is one
/// corner (edge collapses), nothing turns over in plan on the way: the area is linear in time.
class Geomorph {
 public:
  /// \param frames  that one way takes; 0: nothing ever moves.
  Geomorph(const MergeTree& tree, std::uint32_t frames);

  bool is_on() const { return frames_ > 0; }
  bool is_idle() const { return active_.empty(); }
  bool is_moving(std::uint32_t merge) const { return at_[merge] != kNone; }

  /// After a split: the children set out from the parent's place.
  void open(std::uint32_t merge, DisplayMesh& display);
  /// Instead of a merge: the children set out for the parent's place.
  void close(std::uint32_t merge);
  /// Turns children round that are on their way to the parent.
  void turn_back(std::uint32_t merge);
  /// Puts children on their way to their own places at once.
  void finish(std::uint32_t merge, DisplayMesh& display);

  /// One frame. \return merges whose children have come to the parent's place: time to make them.
  std::vector<std::uint32_t> advance(DisplayMesh& display);

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Way {
    std::uint32_t merge, step;  // step 0: at the parent's place, frames_: at their own
    bool is_closing;
  };
  void put(const Way& way, DisplayMesh& display) const;
  void remove(std::uint32_t merge);

  const MergeTree& tree_;
  std::uint32_t frames_;
  std::vector<Way> active_;
  std::vector<std::uint32_t> at_;  // place in active_, by merge
};

}  // namespace terrane::hierarchy
