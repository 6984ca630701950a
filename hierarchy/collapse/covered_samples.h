#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/ids.h"

namespace terrane::hierarchy {

/// A sample that a mesh is held against.
struct CoveredSample {
  float column = 0;  ///< in cells; whole or not, to 1/128 cell up to 131,072 cells
  float row = 0;
  double height_m = 0;
};

/// Knows for every triangle of a mesh the samples under it; each sample is under one triangle, also
/// where it lies on an edge.
class CoveredSamples {
 public:
  /// Sorts the samples of \p field into the triangles, those that lie beside the outline by less
  /// than the field's slack too. Samples under no triangle are left out.
  CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                 std::span<const Corners> triangles, std::size_t triangle_capacity);

  const CoveredSample& operator[](std::uint32_t sample) const { return samples_[sample]; }

  /// The numbers of the samples under a triangle; valid until the next share_out().
  std::span<const std::uint32_t> under(TriangleId t) const {
    return std::span(numbers_).subspan(lists_[t].first, lists_[t].count);
  }

  void clear(TriangleId t) { lists_[t] = {}; }

  /// Gives samples to triangles that share them anew: samples[k] to triangles[sector[k]].
  void share_out(std::span<const TriangleId> triangles, std::span<const std::uint32_t> samples,
                 std::span<const std::uint32_t> sector);

 private:
  struct List {
    std::size_t first = 0;  // in numbers_
    std::uint32_t count = 0;
  };
  /// Leaves out what no list holds any more.
  void compact();

  std::vector<CoveredSample> samples_;
  IdVector<TriangleId, List> lists_;
  std::vector<std::uint32_t> numbers_;  // lists one after the other, with gaps
};

}  // namespace terrane::hierarchy
