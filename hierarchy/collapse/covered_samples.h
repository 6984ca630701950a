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
  std::uint32_t next = ~std::uint32_t{0};  ///< the next one under the same triangle
  double height_m = 0;
};

/// Knows for every triangle of a mesh the samples under it; each sample is under one triangle, also
/// where it lies on an edge.
class CoveredSamples {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Sorts the samples of \p field into the triangles, those that lie beside the outline by less
  /// than the field's slack too. Samples under no triangle are left out.
  CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                 std::span<const Corners> triangles, std::size_t triangle_capacity);

  const CoveredSample& operator[](std::uint32_t sample) const { return samples_[sample]; }

  /// The samples under a triangle are first(t), next(first(t)), ... until kNone.
  std::uint32_t first(TriangleId t) const { return first_[t]; }
  std::uint32_t next(std::uint32_t sample) const { return samples_[sample].next; }

  void clear(TriangleId t) { first_[t] = kNone; }
  void add(TriangleId t, std::uint32_t sample) {
    samples_[sample].next = first_[t];
    first_[t] = sample;
  }

 private:
  void claim(TriangleId t, const FieldSample& sample);

  std::vector<CoveredSample> samples_;
  IdVector<TriangleId, std::uint32_t> first_;
};

}  // namespace terrane::hierarchy
