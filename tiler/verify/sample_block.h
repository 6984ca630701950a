#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/height_source.h"
#include "tiler/verify/tiling.h"
#include "tiler/verify/world.h"

namespace terrane::verify {

/// One sample of the DEM in the world.
struct Sample {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  bool is_terrain = false;  ///< it has a height and a triangle touches it
};

/// The samples of a leaf tile, borders included, row by row.
struct SampleBlock {
  TileKey leaf;
  Window window;
  std::vector<Sample> samples;

  const Sample& at(std::int64_t column, std::int64_t row) const {
    return samples[index(column, row)];
  }
  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - window.row) * window.columns + column - window.column);
  }
  /// True on the outermost rows and columns, where other blocks have the sample too.
  bool is_rim(std::int64_t column, std::int64_t row) const;
};

SampleBlock read_sample_block(const HeightSource& heights, const World& world, const Tiling& tiling,
                              const TileKey& leaf);

}  // namespace terrane::verify
