#pragma once

#include <functional>

#include "core/geodetic_grid.h"

namespace terrane::tiler::testing {

/// Heights over the ellipsoid from a function of longitude and latitude.
class FunctionHeights final : public GeodeticHeights {
 public:
  using Height = std::function<double(const LonLat&)>;

  FunctionHeights(GeodeticTiles tiles, double min_m, double max_m, Height height)
      : tiles_(tiles), min_m_(min_m), max_m_(max_m), height_(std::move(height)) {}

  GeodeticTiles tiles() const override { return tiles_; }
  double min_height_m() const override { return min_m_; }
  double max_height_m() const override { return max_m_; }

  std::vector<LooseSample> dem_samples(const Window&) const override { return {}; }

  HeightGrid read(int zoom, const Window& posts) const override {
    HeightGrid grid{posts, {}};
    for (std::int64_t row = posts.row; row < posts.row + posts.rows; ++row) {
      for (std::int64_t column = posts.column; column < posts.column + posts.columns; ++column) {
        grid.heights_m.push_back(static_cast<float>(height_(
            GeodeticZoom{zoom}.at({static_cast<double>(column), static_cast<double>(row)}))));
      }
    }
    return grid;
  }

 private:
  GeodeticTiles tiles_;
  double min_m_, max_m_;
  Height height_;
};

}  // namespace terrane::tiler::testing
