#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace terrane {

/// Lets the process keep the memory that it frees, up to 256 MB, for what it allocates next. Each
/// tile and each level takes the same few blocks of some megabytes, and fresh pages for all of them
/// took a tenth of the time (docs/benchmarks.md). Does nothing where the C library is not glibc.
inline void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kLargestKept = 32 << 20;  // the most that glibc takes
  constexpr int kMostKept = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargestKept);
  mallopt(M_TRIM_THRESHOLD, kMostKept);
#endif
}

}  // namespace terrane
