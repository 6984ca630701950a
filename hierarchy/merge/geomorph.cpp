#include "hierarchy/merge/geomorph.h"

#include <algorithm>

namespace terrane::hierarchy {

Geomorph::Geomorph(const MergeTree& tree, std::uint32_t frames)
    : tree_(tree), frames_(frames), at_(tree.merge_count(), kNone) {}

void Geomorph::put(const Way& way, DisplayMesh& display) const {
  const Merge& merge = tree_.merges[way.merge];
  const Eigen::Vector3f from = tree_.place(merge.parent);
  const float t = static_cast<float>(way.step) / static_cast<float>(frames_);
  for (std::uint32_t k = 0; k < merge.child_count; ++k) {
    const std::uint32_t child = merge.first_child + k;
    const Eigen::Vector3f own = tree_.place(child);
    display.move(child, way.step == frames_ ? own : Eigen::Vector3f(from + t * (own - from)));
  }
}

void Geomorph::open(std::uint32_t merge, DisplayMesh& display) {
  at_[merge] = static_cast<std::uint32_t>(active_.size());
  active_.push_back({merge, 0, false});
  put(active_.back(), display);
}

void Geomorph::close(std::uint32_t merge) {
  if (is_moving(merge)) {
    active_[at_[merge]].is_closing = true;
    return;
  }
  at_[merge] = static_cast<std::uint32_t>(active_.size());
  active_.push_back({merge, frames_, true});
}

void Geomorph::turn_back(std::uint32_t merge) {
  if (is_moving(merge)) active_[at_[merge]].is_closing = false;
}

void Geomorph::remove(std::uint32_t merge) {
  active_[at_[merge]] = active_.back();
  at_[active_.back().merge] = at_[merge];
  at_[merge] = kNone;
  active_.pop_back();
}

void Geomorph::finish(std::uint32_t merge, DisplayMesh& display) {
  if (!is_moving(merge)) return;
  put({merge, frames_, false}, display);
  remove(merge);
}

std::vector<std::uint32_t> Geomorph::advance(DisplayMesh& display) {
  std::vector<std::uint32_t> opened, closed;
  for (Way& way : active_) {
    way.step += way.is_closing ? -1 : 1;
    put(way, display);
    if (way.step == frames_ && !way.is_closing) opened.push_back(way.merge);
    if (way.step == 0) closed.push_back(way.merge);
  }
  for (const std::uint32_t merge : opened) remove(merge);
  for (const std::uint32_t merge : closed) remove(merge);
  return closed;
}

}  // namespace terrane::hierarchy
