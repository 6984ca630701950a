#include "hierarchy/merge/merge_front.h"

#include <cassert>

namespace terrane::hierarchy {

void MergeFront::Group::add(std::uint32_t i) {
  assert(at_[i] == kNone);
  at_[i] = static_cast<std::uint32_t>(members_.size());
  members_.push_back(i);
}

void MergeFront::Group::remove(std::uint32_t i) {
  if (at_[i] == kNone) return;
  const std::uint32_t last = members_.back();
  members_[at_[i]] = last;
  at_[last] = at_[i];
  at_[i] = kNone;
  members_.pop_back();
}

MergeFront::MergeFront(const MergeTree& tree, std::uint32_t morph_frames)
    : tree_(tree),
      display_(tree),
      morph_(tree, morph_frames),
      made_(tree.merge_count(), 1),
      coarser_made_(tree.merge_count()),
      finer_missing_(tree.merge_count(), 0),
      last_made_(tree.merge_count()),
      next_to_make_(tree.merge_count()),
      seen_(tree.merge_count(), 0) {
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    coarser_made_[i] = static_cast<std::uint32_t>(tree.coarser(i).size());
    if (coarser_made_[i] == 0) last_made_.add(i);
  }
}

void MergeFront::undo_one(std::uint32_t i) {
  assert(made_[i] && coarser_made_[i] == 0);
  made_[i] = 0;
  last_made_.remove(i);
  next_to_make_.add(i);
  for (const std::uint32_t c : tree_.coarser(i)) {
    if (finer_missing_[c]++ == 0) next_to_make_.remove(c);
  }
  for (const std::uint32_t f : tree_.finer(i)) {
    if (--coarser_made_[f] == 0) last_made_.add(f);
  }
  ++statistics_.splits;
  if (!morph_.is_on()) return to_show_.push_back({i, true});
  // what moved here is about to lose triangles to others: it has to be where it belongs
  for (const std::uint32_t c : tree_.coarser(i)) morph_.finish(c, display_);
  display_.split(i);
  morph_.open(i, display_);
}

/// Undoes a merge, and before it those that were made on top of it.
void MergeFront::undo(std::uint32_t i) {
  undo_stack_.assign(1, i);
  while (!undo_stack_.empty()) {
    const std::uint32_t top = undo_stack_.back();
    if (!made_[top]) {
      undo_stack_.pop_back();
    } else if (coarser_made_[top] == 0) {
      undo_one(top);
      undo_stack_.pop_back();
    } else {
      for (const std::uint32_t c : tree_.coarser(top)) {
        if (made_[c]) undo_stack_.push_back(c);
      }
    }
  }
}

void MergeFront::make(std::uint32_t i) {
  assert(!made_[i] && finer_missing_[i] == 0);
  made_[i] = 1;
  next_to_make_.remove(i);
  last_made_.add(i);
  for (const std::uint32_t f : tree_.finer(i)) {
    if (coarser_made_[f]++ == 0) last_made_.remove(f);
  }
  for (const std::uint32_t c : tree_.coarser(i)) {
    if (--finer_missing_[c] == 0) {
      next_to_make_.add(c);
      work_.push_back(c);
    }
  }
  ++statistics_.merges;
  if (!morph_.is_on()) return to_show_.push_back({i, false});
  display_.merge(i);
}

/// Undoes every merge that may not be made, and those on top of it.
void MergeFront::refine(const ViewJudge& judge) {
  stack_ = last_made_.members();
  while (!stack_.empty()) {
    const std::uint32_t i = stack_.back();
    stack_.pop_back();
    if (seen_[i] == frame_) continue;
    seen_[i] = frame_;
    ++statistics_.looked_at;
    if (judge.allows_all(i)) continue;
    if (!judge.allows(i)) undo(i);
    for (const std::uint32_t f : tree_.finer(i)) stack_.push_back(f);
  }
}

/// Makes every merge that may be made and stands on made ones.
void MergeFront::coarsen(const ViewJudge& judge) {
  work_ = next_to_make_.members();
  while (!work_.empty()) {
    const std::uint32_t i = work_.back();
    work_.pop_back();
    ++statistics_.looked_at;
    const bool is_allowed = judge.allows(i);
    if (morph_.is_on()) {
      make_in_time(i, is_allowed);
    } else if (is_allowed) {
      make(i);
    }
  }
}

void MergeFront::make_in_time(std::uint32_t i, bool is_allowed) {
  if (is_allowed) {
    morph_.close(i);
  } else {
    morph_.turn_back(i);
  }
}

UpdateStatistics MergeFront::update(const ViewJudge& judge) {
  decide(judge);
  show();
  return statistics_;
}

void MergeFront::show() {
  for (const auto [merge, is_split] : to_show_) {
    is_split ? display_.split(merge) : display_.merge(merge);
  }
  to_show_.clear();
}

UpdateStatistics MergeFront::decide(const ViewJudge& judge) {
  statistics_ = {};
  ++frame_;
  refine(judge);
  coarsen(judge);
  for (const std::uint32_t i : morph_.advance(display_)) make(i);
  work_.clear();
  return statistics_;
}

}  // namespace terrane::hierarchy
