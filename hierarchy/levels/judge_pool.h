#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#include "hierarchy/levels/collapse_judge.h"

namespace terrane::hierarchy {

/// A judge for every thread, and loops over what they judge.
class JudgePool {
 public:
  /// \param jobs  1: all in the calling thread; else as many threads as its task arena has.
  JudgePool(const LevelMesh& level, Rules rules, int jobs)
      : judge_(level, rules),
        judges_([&level, rules] { return CollapseJudge(level, rules); }),
        is_single_(jobs == 1) {}

  /// Calls work(judge, i) for i < count, \p grain of them to a task.
  template <class Work>
  void for_each_index(std::size_t count, Work work, std::size_t grain = 256) {
    if (is_single_) {
      for (std::size_t i = 0; i < count; ++i) work(judge_, i);
      return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
      CollapseJudge& judge = judges_.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(judge, i);
    });
  }

 private:
  CollapseJudge judge_;
  tbb::enumerable_thread_specific<CollapseJudge> judges_;
  bool is_single_;
};

}  // namespace terrane::hierarchy
