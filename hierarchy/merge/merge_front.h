#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/merge/display_mesh.h"
#include "hierarchy/merge/geomorph.h"
#include "hierarchy/merge/merge_tree.h"
#include "hierarchy/merge/view_criteria.h"

namespace terrane::hierarchy {

/// What one update did.
struct UpdateStatistics {
  std::uint32_t splits = 0, merges = 0;
  std::uint32_t looked_at = 0;  ///< merges that were judged
};

/// The merges made at present, kept between frames.
///
/// After update() they are the largest set that the tree allows in which each is allowed by the
/// judge: a function of the view alone, whatever was shown before. With a geomorph they are as soon
/// as is_settled(), if the view stays: until then some merges wait for their children to arrive.
class MergeFront {
 public:
  /// Begins with the coarsest mesh.
  /// \param tree          must outlive the front.
  /// \param morph_frames  over which children move; 0: splits and merges show at once.
  explicit MergeFront(const MergeTree& tree, std::uint32_t morph_frames = 0);

  /// Goes from the last view's merges to this one's, along the border between those that are made
  /// and those that are not. The same as decide() and show().
  UpdateStatistics update(const ViewJudge& judge);
  /// Walks the tree alone: display() stays as it is until show(). (With a geomorph, both at once.)
  UpdateStatistics decide(const ViewJudge& judge);
  void show();

  const DisplayMesh& display() const { return display_; }
  DisplayMesh& display() { return display_; }
  bool is_made(std::uint32_t merge) const { return made_[merge] != 0; }
  /// Did the last update find nothing to do, and nothing on its way?
  bool is_settled() const {
    return morph_.is_idle() && statistics_.splits + statistics_.merges == 0;
  }

 private:
  /// Merges in no order, each at a known place, so that one goes and comes in constant time.
  class Group {
   public:
    explicit Group(std::size_t size) : at_(size, kNone) {}
    void add(std::uint32_t i);
    void remove(std::uint32_t i);
    const std::vector<std::uint32_t>& members() const { return members_; }

   private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> members_, at_;
  };

  void refine(const ViewJudge& judge);
  void coarsen(const ViewJudge& judge);
  void undo(std::uint32_t i);
  void undo_one(std::uint32_t i);
  void make(std::uint32_t i);
  void make_in_time(std::uint32_t i, bool is_allowed);

  struct Change {
    std::uint32_t merge;
    bool is_split;
  };

  const MergeTree& tree_;
  DisplayMesh display_;
  Geomorph morph_;
  std::vector<std::uint8_t> made_;
  std::vector<std::uint32_t> coarser_made_;   // of each merge: how many of coarser() are made
  std::vector<std::uint32_t> finer_missing_;  // how many of finer() are not
  Group last_made_;                           // made, and nothing above them is
  Group next_to_make_;                        // not made, and all below them are
  std::vector<std::uint32_t> seen_;           // frame in which a merge was looked at
  std::uint32_t frame_ = 0;
  std::vector<std::uint32_t> stack_, undo_stack_, work_;
  std::vector<Change> to_show_;
  UpdateStatistics statistics_;
};

}  // namespace terrane::hierarchy
