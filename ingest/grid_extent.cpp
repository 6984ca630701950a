#include "ingest/grid_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace terrane::ingest {
namespace {

constexpr int kProbesPerSide = 65;

/// Probes over the whole DEM, row by row; longitudes go on without a jump along each row and down
/// the first column.
struct Probes {
  std::vector<LonLat> at;

  Probes(const Georeference& place, GridShape shape) {
    std::vector<GridPosition> positions;
    for (int j = 0; j < kProbesPerSide; ++j) {
      for (int i = 0; i < kProbesPerSide; ++i) {
        positions.push_back({static_cast<double>(shape.columns - 1) * i / (kProbesPerSide - 1),
                             static_cast<double>(shape.rows - 1) * j / (kProbesPerSide - 1)});
      }
    }
    at = place.to_lon_lat(positions);
    for (std::size_t k = 1; k < at.size(); ++k) {
      const std::size_t before = k % kProbesPerSide == 0 ? k - kProbesPerSide : k - 1;
      at[k].longitude_deg = at[before].longitude_deg +
                            std::remainder(at[k].longitude_deg - at[before].longitude_deg, 360.0);
    }
  }

  const LonLat& operator()(int i, int j) const {
    return at[static_cast<std::size_t>(j * kProbesPerSide + i)];
  }

  /// How often the rim goes round a pole.
  bool holds_a_pole() const {
    constexpr int kLast = kProbesPerSide - 1;
    std::vector<LonLat> rim;
    for (int k = 0; k < kLast; ++k) rim.push_back((*this)(k, 0));
    for (int k = 0; k < kLast; ++k) rim.push_back((*this)(kLast, k));
    for (int k = kLast; k > 0; --k) rim.push_back((*this)(k, kLast));
    for (int k = kLast; k > 0; --k) rim.push_back((*this)(0, k));
    double turned_deg = 0;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      turned_deg +=
          std::remainder(rim[(k + 1) % rim.size()].longitude_deg - rim[k].longitude_deg, 360.0);
    }
    return std::abs(turned_deg) > 180;
  }
};

void find_affine(const Dem& dem, const Probes& probes, GridExtent& extent) {
  const GridShape shape = dem.heights().shape();
  const auto columns = static_cast<double>(shape.columns - 1);
  const auto rows = static_cast<double>(shape.rows - 1);
  constexpr int kLast = kProbesPerSide - 1, kMiddle = kLast / 2;
  extent.middle = probes(kMiddle, kMiddle);
  extent.middle_column = columns / 2;
  extent.middle_row = rows / 2;
  extent.column_deg =
      (probes(kLast, kMiddle).longitude_deg - probes(0, kMiddle).longitude_deg) / columns;
  extent.row_deg = (probes(kMiddle, kLast).latitude_deg - probes(kMiddle, 0).latitude_deg) / rows;
  constexpr double kExact_cells = 1e-4;
  extent.is_affine = extent.column_deg != 0 && extent.row_deg != 0;
  for (int j = 0; j <= kLast; ++j) {
    for (int i = 0; i <= kLast; ++i) {
      const double x = extent.middle.longitude_deg +
                       (columns * i / kLast - extent.middle_column) * extent.column_deg;
      const double y =
          extent.middle.latitude_deg + (rows * j / kLast - extent.middle_row) * extent.row_deg;
      const double off_deg = std::max(std::abs(x - probes(i, j).longitude_deg),
                                      std::abs(y - probes(i, j).latitude_deg));
      if (off_deg > kExact_cells * std::abs(extent.row_deg)) extent.is_affine = false;
    }
  }
  const double around_deg = std::abs(extent.column_deg) * (columns + 1);
  // some repeat the first column at the end
  extent.goes_round = extent.is_affine && around_deg >= 360 - 1e-3 * std::abs(extent.column_deg);
}

double spacing_deg(const Dem& dem) {
  const GridShape shape = dem.heights().shape();
  const double c = static_cast<double>(shape.columns - 2) / 2;
  const double r = static_cast<double>(shape.rows - 2) / 2;
  const std::array<GridPosition, 3> around{{{c, r}, {c + 1, r}, {c, r + 1}}};
  const std::vector<LonLat> at = dem.place().to_lon_lat(around);
  const auto distance_deg = [&](std::size_t k) {
    return std::hypot(std::remainder(at[k].longitude_deg - at[0].longitude_deg, 360.0),
                      at[k].latitude_deg - at[0].latitude_deg);
  };
  return std::min(distance_deg(1), distance_deg(2));
}

}  // namespace

GridExtent extent_of(const Dem& dem) {
  const Probes probes(dem.place(), dem.heights().shape());
  GridExtent extent{.area = {INFINITY, INFINITY, -INFINITY, -INFINITY}};
  for (const LonLat& at : probes.at) {
    extent.area.west_deg = std::min(extent.area.west_deg, at.longitude_deg);
    extent.area.east_deg = std::max(extent.area.east_deg, at.longitude_deg);
    extent.area.south_deg = std::min(extent.area.south_deg, at.latitude_deg);
    extent.area.north_deg = std::max(extent.area.north_deg, at.latitude_deg);
  }
  const double turns = std::floor((extent.area.west_deg + 180) / 360);
  extent.area.west_deg -= 360 * turns;
  extent.area.east_deg -= 360 * turns;
  extent.spacing_deg = spacing_deg(dem);
  find_affine(dem, probes, extent);
  if (probes.holds_a_pole()) {
    extent.goes_round = true;
    (extent.area.south_deg + extent.area.north_deg > 0 ? extent.area.north_deg = 90
                                                       : extent.area.south_deg = -90);
  }
  return extent;
}

}  // namespace terrane::ingest
