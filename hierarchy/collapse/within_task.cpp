#include "hierarchy/collapse/within_task.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace terrane::hierarchy {

void for_each_within_task(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    tbb::parallel_for(std::size_t{0}, count, body, own);
  });
}

}  // namespace terrane::hierarchy
