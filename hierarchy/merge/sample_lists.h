#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// Where the corners of a triangle are.
using TrianglePlaces = std::array<Eigen::Vector3d, 3>;

/// Error of one sample under a fan of triangles.
struct SampleError {
  double error = 0;
  std::size_t triangle = 0;  ///< of the fan: the one that the sample belongs to
};

/// Distance of a sample from the nearest triangle of a fan; with kVertical the height over the
/// triangle that it lies under in plan.
///
/// Exact for places of one PointLattice, but for the rounding of the height or distance itself.
SampleError sample_error(ErrorMeasure measure, const Eigen::Vector3d& sample,
                         std::span<const TrianglePlaces> fan);

/// Vertices of the full mesh that are gone, each with the one triangle that stands for it.
///
/// A collapse hands the samples of the triangles that go to those that come, so what a triangle
/// holds depends on the triangle alone and not on what else has collapsed: its error is that of
/// every mesh in which it shows.
class SampleLists {
 public:
  SampleLists(std::size_t samples, std::size_t triangles)
      : next_(samples, kNone), first_(triangles, kNone) {}

  void add(std::uint32_t sample, std::uint32_t triangle) {
    next_[sample] = first_[triangle];
    first_[triangle] = sample;
  }
  /// Appends the samples of a triangle to a list.
  void append_to(std::vector<std::uint32_t>& samples, std::uint32_t triangle) const {
    for (std::uint32_t s = first_[triangle]; s != kNone; s = next_[s]) samples.push_back(s);
  }
  void clear(std::uint32_t triangle) { first_[triangle] = kNone; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> next_, first_;
};

}  // namespace terrane::hierarchy
