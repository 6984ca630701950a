#include "ingest/raise_heights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace terrane::ingest {
namespace {

/// Samples from one at which the geoid is asked to the next.
std::int64_t nodes_every(const Georeference& place, GridShape shape) {
  constexpr double kApart_m = 1000, kDegree_m = 111320;
  constexpr std::int64_t kMost = 64;
  const double c = static_cast<double>(shape.columns - 2) / 2;
  const double r = static_cast<double>(shape.rows - 2) / 2;
  const std::vector<LonLat> at =
      place.to_lon_lat(std::vector<GridPosition>{{c, r}, {c + 1, r}, {c, r + 1}});
  const double shrink = std::cos(at[0].latitude_deg * std::numbers::pi / 180);
  const auto distance_m = [&](const LonLat& to) {
    return kDegree_m *
           std::hypot(shrink * std::remainder(to.longitude_deg - at[0].longitude_deg, 360.0),
                      to.latitude_deg - at[0].latitude_deg);
  };
  const double spacing_m = std::max({distance_m(at[1]), distance_m(at[2]), 1e-3});
  return static_cast<std::int64_t>(
      std::clamp(std::floor(kApart_m / spacing_m), 1.0, static_cast<double>(kMost)));
}

/// The geoid at every so many samples, counted from the DEM's first one.
struct GeoidNodes {
  std::int64_t every = 1, column = 0, row = 0, columns = 0, rows = 0;
  std::vector<double> values_m;

  double at(std::int64_t c, std::int64_t r) const {
    return values_m[static_cast<std::size_t>(std::min(r, rows - 1) * columns +
                                             std::min(c, columns - 1))];
  }
  double between(std::int64_t at_column, std::int64_t at_row) const {
    const std::int64_t c = at_column / every - column, r = at_row / every - row;
    const double x = static_cast<double>(at_column % every) / static_cast<double>(every);
    const double y = static_cast<double>(at_row % every) / static_cast<double>(every);
    return (1 - y) * ((1 - x) * at(c, r) + x * at(c + 1, r)) +
           y * ((1 - x) * at(c, r + 1) + x * at(c + 1, r + 1));
  }
};

class RaisedHeights final : public HeightSource {
 public:
  RaisedHeights(std::unique_ptr<HeightSource> heights, const Georeference& place,
                std::unique_ptr<Geoid> geoid)
      : heights_(std::move(heights)),
        place_(place),
        geoid_(std::move(geoid)),
        every_(nodes_every(place, heights_->shape())) {}

  GridShape shape() const override { return heights_->shape(); }

  HeightGrid read(const Window& window) const override {
    HeightGrid grid = heights_->read(window);
    const GeoidNodes nodes = nodes_of(window);
    for (std::int64_t row = 0; row < window.rows; ++row) {
      for (std::int64_t column = 0; column < window.columns; ++column) {
        float& height_m = grid.heights_m[static_cast<std::size_t>(row * window.columns + column)];
        if (std::isnan(height_m)) continue;
        height_m =
            static_cast<float>(height_m + nodes.between(window.column + column, window.row + row));
      }
    }
    return grid;
  }

 private:
  GeoidNodes nodes_of(const Window& window) const {
    // the first node that is not before a place of a sample
    const auto after = [&](std::int64_t sample) { return (sample + every_ - 1) / every_; };
    GeoidNodes nodes{.every = every_, .column = window.column / every_, .row = window.row / every_};
    nodes.columns = after(window.column + window.columns - 1) - nodes.column + 1;
    nodes.rows = after(window.row + window.rows - 1) - nodes.row + 1;
    std::vector<GridPosition> positions;
    for (std::int64_t r = 0; r < nodes.rows; ++r) {
      for (std::int64_t c = 0; c < nodes.columns; ++c) {
        positions.push_back({static_cast<double>((nodes.column + c) * every_),
                             static_cast<double>((nodes.row + r) * every_)});
      }
    }
    for (const LonLat& place : place_.to_lon_lat(positions)) {
      nodes.values_m.push_back(geoid_->undulation_m(place));
    }
    return nodes;
  }

  std::unique_ptr<HeightSource> heights_;
  const Georeference& place_;
  std::unique_ptr<Geoid> geoid_;
  std::int64_t every_;
};

}  // namespace

std::unique_ptr<HeightSource> raise_heights(std::unique_ptr<HeightSource> heights,
                                            const Georeference& place,
                                            std::unique_ptr<Geoid> geoid) {
  return std::make_unique<RaisedHeights>(std::move(heights), place, std::move(geoid));
}

}  // namespace terrane::ingest
