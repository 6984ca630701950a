#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrane::hierarchy {

struct MergeTree;

/// What a view judges one merge by, in one cache line: a front judges thousands a frame, each
/// somewhere else in memory.
struct alignas(64) ViewRanges {
  /// Of MergeBounds; the angle of the cone as the tangent of its half, a little wider and pi at
  /// most.
  struct Ranges {
    float error, switched, radius, half_angle_tangent, colour;
  };
  std::array<float, 3> place{}, axis{};  ///< of the sphere and the cone
  Ranges own{};                          ///< of the merge
  Ranges all{};                          ///< of the merge and all that has to be made before it
};

/// One for each merge of a tree that has its normals and bounds.
std::vector<ViewRanges> view_ranges_of(const MergeTree& tree);

}  // namespace terrane::hierarchy
