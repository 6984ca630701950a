#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/collapse/covered_samples.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// The boundary polygon of a stencil and the samples inside: all that is needed to judge the stars
/// which may replace the stencil.
///
///        p1 ─── p0        sector k is the triangle centre, p(k), p(k + 1), counter-clockwise in
///       ╱  ╲ 0 ╱  ╲       GridPoint's plane. Where the core touches the outline the fan is open:
///     p2 ── centre ─ p5   its first and last spoke are outline edges.
///       ╲  ╱   ╲  ╱
///        p3 ─── p4
///
/// Coordinates are cells along x and *against* the rows, heights metres, all counted from origin()
/// so that floats hold them well.
class Star {
 public:
  /// Takes over the surroundings of a core, with the samples under all its triangles. Keeps its
  /// memory from call to call.
  void gather(const Stencil& stencil, const HalfedgeMesh& mesh,
              std::span<const TerrainVertex> vertices, const CoveredSamples& samples) {
    gather_few(stencil, mesh, vertices, samples);
    gather_rest(samples);
  }

  /// The same with those samples only that refuse most: the keen ones, or where there are none,
  /// those under the triangles that a collapse takes away, as they are near the new centre.
  void gather_few(const Stencil& stencil, const HalfedgeMesh& mesh,
                  std::span<const TerrainVertex> vertices, const CoveredSamples& samples);
  /// Adds the other samples.
  /// \pre gather_few() was the last call, with the same samples.
  void gather_rest(const CoveredSamples& samples);

  /// Adds one that is not among them.
  void learn(const CoveredSample& sample) {
    add({&sample, 1});
    pad_samples();
  }

  /// A place counted from origin().
  struct Centre {
    float x = 0, y = 0;
  };
  Centre centre(GridPoint plan) const {
    constexpr float kCellsPerUnit = 1.0F / kUnitsPerCell;
    return {static_cast<float>(plan.x - origin_.plan.x) * kCellsPerUnit,
            static_cast<float>(plan.y - origin_.plan.y) * kCellsPerUnit};
  }

  const Place& origin() const { return origin_; }
  bool is_closed() const { return is_closed_; }
  std::size_t sector_count() const { return sector_count_; }
  std::size_t sample_count() const { return sample_count_; }

  /// Corners of the polygon: sector_count() + 1 of each; if closed, the last is the first again.
  /// Padded with copies of the last to a multiple of kPadding, and one more.
  const float* corner_x() const { return corner_x_.data(); }
  const float* corner_y() const { return corner_y_.data(); }
  const float* corner_z() const { return corner_z_.data(); }
  const Place& corner(std::size_t k) const { return *corners_[k]; }
  /// The triangles that the sectors will be.
  std::span<const TriangleId> triangles() const {
    return std::span(triangles_).first(sector_count_);
  }
  /// The triangle that sector k will be.
  TriangleId triangle(std::size_t sector) const { return triangles_[sector]; }

  /// The samples inside; padded with copies of the last to a multiple of kPadding.
  const float* sample_x() const { return sample_x_.data(); }
  const float* sample_y() const { return sample_y_.data(); }
  const float* sample_z() const { return sample_z_.data(); }
  const CoveredSample& sample(std::size_t k) const { return samples_[k]; }
  std::span<const CoveredSample> samples() const {
    return std::span(samples_).first(sample_count_);
  }

  /// So many of them, the first ones, are keen.
  std::size_t keen_count() const { return keen_count_; }

  static constexpr std::size_t kPadding = 8;

 private:
  void gather_polygon(const Stencil& stencil, const HalfedgeMesh& mesh,
                      std::span<const TerrainVertex> vertices);
  std::span<const TriangleId> dying() const { return std::span(dying_).first(dying_count_); }
  void add(std::span<const CoveredSample> samples);
  void pad_samples();
  void make_room_for_corners(std::size_t count);
  void make_room_for_samples();

  Place origin_;
  bool is_closed_ = true;
  std::size_t sector_count_ = 0;
  std::vector<float> corner_x_, corner_y_, corner_z_;
  std::vector<const Place*> corners_;
  std::vector<TriangleId> triangles_;
  std::array<TriangleId, 4> dying_;
  std::size_t dying_count_ = 0;
  std::size_t sample_count_ = 0, keen_count_ = 0;
  std::vector<float> sample_x_, sample_y_, sample_z_;
  std::vector<CoveredSample> samples_;
};

}  // namespace terrane::hierarchy
