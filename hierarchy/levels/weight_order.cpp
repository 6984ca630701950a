#include "hierarchy/levels/weight_order.h"

#include <algorithm>
#include <limits>

namespace terrane::hierarchy {
namespace {

/// A key that about so many of `count` do not exceed: by a sample, as any bound gives one order.
template <class KeyAt>
double key_of_rank(std::size_t rank, std::size_t count, std::vector<double>& sample, KeyAt key_at) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  if (rank >= count) return kAll;
  constexpr std::size_t kSampleSize = 4096;
  const std::size_t stride = std::max<std::size_t>(1, count / kSampleSize);
  sample.clear();
  for (std::size_t i = 0; i < count; i += stride) sample.push_back(key_at(i));
  const auto at = sample.begin() + static_cast<std::ptrdiff_t>(rank / stride);
  if (at >= sample.end()) return kAll;
  std::nth_element(sample.begin(), at, sample.end());
  return *at;
}

}  // namespace

WeightOrder::WeightOrder(const LevelMesh& level, WeightTable& weights, JudgePool& judges)
    : level_(level), weights_(weights), judges_(judges) {
  list_candidates();
}

void WeightOrder::list_candidates() {
  candidates_.clear();
  for (std::uint32_t i = 0; i < level_.mesh.triangle_count(); ++i) {
    if (!level_.mesh.is_ghost(TriangleId{i})) candidates_.push_back(i);
  }
}

std::size_t WeightOrder::begin_level() {
  std::erase_if(candidates_, [&](auto i) { return !level_.mesh.is_live(TriangleId{i}); });
  is_first_ = true;
  return candidates_.size();
}

bool WeightOrder::next_portion(std::size_t size, const std::vector<std::uint8_t>& taken) {
  if (!is_first_ && rest_.empty()) return false;
  const auto key_of = [&](std::uint32_t i) { return weights_.key(TriangleId{i}); };
  const double heaviest =
      is_first_
          ? key_of_rank(size, candidates_.size(), sample_,
                        [&](std::size_t i) { return key_of(candidates_[i]); })
          : key_of_rank(size, rest_.size(), sample_, [&](std::size_t i) { return rest_[i].key; });
  fill_portion(heaviest);
  weigh_portion(taken);
  // what turned out heavier may come after triangles that wait
  std::erase_if(portion_, [&](const Entry& entry) {
    if (entry.key <= heaviest) return false;
    rest_.push_back(entry);
    return true;
  });
  return true;
}

std::vector<Waiting>& WeightOrder::lightest_of_portion(std::size_t count) {
  slice_.clear();
  if (count >= portion_.size()) {
    slice_.swap(portion_);
    return slice_;
  }
  sample_.clear();
  for (const Waiting& waiting : portion_) sample_.push_back(waiting.key);
  const auto at = sample_.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(sample_.begin(), at, sample_.end());
  std::erase_if(portion_, [&](const Waiting& waiting) {
    if (waiting.key > *at) return false;
    slice_.push_back(waiting);
    return true;
  });
  return slice_;
}

/// Moves what is not heavier to portion_, and leaves the others in rest_.
void WeightOrder::fill_portion(double heaviest) {
  portion_.clear();
  const auto is_next = [&](const Entry& entry) {
    if (entry.key > heaviest) return false;
    portion_.push_back({entry, {}});
    return true;
  };
  if (!is_first_) {
    std::erase_if(rest_, is_next);
    return;
  }
  is_first_ = false;
  rest_.clear();
  for (const std::uint32_t i : candidates_) {
    const Entry entry{weights_.key(TriangleId{i}), i};
    if (!is_next(entry)) rest_.push_back(entry);
  }
}

void WeightOrder::weigh_portion(const std::vector<std::uint8_t>& taken) {
  judges_.for_each_index(portion_.size(), [&](CollapseJudge& judge, std::size_t i) {
    Waiting& waiting = portion_[i];
    const TriangleId t{waiting.triangle};
    waiting.corners = level_.mesh.corners(t);
    const auto is_taken = [&](VertexId v) { return taken[index(v)] != 0; };
    if (weights_.is_weighed(t) || std::ranges::any_of(waiting.corners, is_taken) ||
        weights_.is_rejected(t, waiting.corners)) {
      return;
    }
    weights_.weigh(judge, t);
    waiting.key = weights_.key(t);
  });
}

}  // namespace terrane::hierarchy
