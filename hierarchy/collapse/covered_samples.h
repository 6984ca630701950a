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
///
/// Where triangles have many samples, a few of each are *keen*: those that stood out most from the
/// triangle they were under at first, and that are likely to refuse what any sample refuses.
class CoveredSamples {
 public:
  /// Sorts the samples of \p field into the triangles, those that lie beside the outline by less
  /// than the field's slack too. Samples under no triangle are left out.
  CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                 std::span<const Corners> triangles, std::size_t triangle_capacity);

  /// Are some samples keen?
  bool has_keen() const { return has_keen_; }

  /// The keen samples under a triangle; valid until the next share_out().
  std::span<const CoveredSample> keen_under(TriangleId t) const {
    return std::span(samples_).subspan(lists_[t].first, lists_[t].keen);
  }
  /// The others: all of them where there are no keen ones.
  std::span<const CoveredSample> others_under(TriangleId t) const {
    const List& list = lists_[t];
    return std::span(samples_).subspan(list.first + list.keen, list.count - list.keen);
  }

  void clear(TriangleId t) { lists_[t] = {}; }

  /// Gives samples to triangles that share them anew: samples[k] to triangles[sector[k]].
  /// \param keen_count  so many of them, the first ones, are keen.
  /// \pre \p samples lie elsewhere in memory.
  void share_out(std::span<const TriangleId> triangles, std::span<const CoveredSample> samples,
                 std::size_t keen_count, std::span<const std::uint32_t> sector);

 private:
  struct List {
    std::size_t first = 0;  // in samples_
    std::uint32_t count = 0;
    std::uint32_t keen = 0;  // so many of them come first
  };
  void choose_keen(std::span<const TerrainVertex> vertices, std::span<const Corners> triangles);
  std::size_t most_with_gaps() const;
  /// Leaves out what no list holds any more.
  void compact();

  std::size_t count_ = 0;
  bool has_keen_ = false;
  IdVector<TriangleId, List> lists_;
  std::vector<CoveredSample> samples_;  // lists one after the other, with gaps
};

}  // namespace terrane::hierarchy
