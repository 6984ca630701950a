#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/georeference.h"
#include "tiler/verify/terrain_file.h"
#include "tiler/verify/terrain_layer.h"

namespace terrane::verify {

/// A tile as globes draw it, flat triangles between Earth-centred places, to be asked for heights.
class TerrainSurface {
 public:
  TerrainSurface(const TerrainFile& tile, const TerrainKey& key);

  /// Height over the ellipsoid at a place of the tile, along the ellipsoid's normal.
  ///
  /// Chords of parallels lie beside them: where a place on the tile is under none of its
  /// triangles for that, the plane of the one that it belongs to by longitude and latitude counts.
  /// \return none if no triangle is there.
  std::optional<double> height_m(const LonLat& place) const;

 private:
  static constexpr int kCells = 32;  // along a side of the tile

  struct Corner {
    double u, v;
    Eigen::Vector3d at;
  };
  using Triangle = std::array<std::uint32_t, 3>;

  /// Height at which a normal meets a triangle's plane; how far outside the triangle, as a share
  /// of it.
  struct Meeting {
    double height_m = 0, outside = 0;
  };
  /// None for a triangle without an area.
  std::optional<Meeting> meet(const Triangle& triangle, const Eigen::Vector3d& base,
                              const Eigen::Vector3d& up) const;
  bool is_over(const Triangle& triangle, double u, double v) const;
  static int cell_of(double along);

  TerrainKey key_;
  std::vector<Corner> corners_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> in_cell_;  // triangles whose rectangle meets the cell
};

}  // namespace terrane::verify
