#include "hierarchy/collapse/within_task.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <atomic>

namespace terrane::hierarchy {
namespace {

TEST(ForEachWithinTask, MakesAllCallsThoughTheTaskAroundItIsCancelled) {
  constexpr std::size_t kCalls = 1000;
  std::atomic<std::size_t> calls = 0;
  tbb::task_group_context around;
  tbb::parallel_for(
      0, 1,
      [&](int) {
        around.cancel_group_execution();
        for_each_within_task(kCalls, [&](std::size_t) { ++calls; });
      },
      around);
  EXPECT_EQ(calls, kCalls);
}

}  // namespace
}  // namespace terrane::hierarchy
