#pragma once

#include <cstddef>
#include <functional>

namespace terrane::hierarchy {

/// Calls body(0) to body(count - 1) on the threads that have nothing else to do, as a part of the
/// task that it is called in.
///
/// A thread that waits here begins no other task: that could hold two tiles in memory. All calls
/// are made even if another task has failed meanwhile: what comes of them is then still true.
/// \throws what a call throws; the others may then not have been made.
void for_each_within_task(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace terrane::hierarchy
