#include "tiler/verify/water_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace terrane::verify {
namespace {

constexpr std::int64_t kBlock = 64;

bool is_same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || a == b ||
         (std::isnan(a) && std::isnan(b));
}

class WaterCheck {
 public:
  WaterCheck(const Georeference& place, std::span<const WaterArea> areas, double tolerance_m)
      : shores_(place, areas, tolerance_m) {
    findings.heights_m.resize(areas.size());
  }

  void check(const HeightGrid& dem, const HeightGrid& reference) {
    const Window& window = dem.window;
    std::vector<GridPosition> positions;
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        positions.push_back({static_cast<double>(column), static_cast<double>(row)});
      }
    }
    const std::vector<WaterShores::Place> places = shores_.find(positions);
    for (std::size_t i = 0; i < places.size(); ++i) {
      judge(positions[i], places[i], dem.heights_m[i], reference.heights_m[i]);
    }
  }

  WaterFindings findings;

 private:
  void judge(const GridPosition& position, const WaterShores::Place& place, float dem_m,
             float reference_m) {
    if (place.near.empty()) {
      if (!is_same(dem_m, reference_m)) note(position, "on land", reference_m, dem_m);
      return;
    }
    // near a shore, or in several bodies
    if (std::isfinite(place.inside_m) || place.near.size() > 1) return;
    std::optional<float>& height_m = findings.heights_m[place.near.front()];
    ++findings.under_water;
    if (!height_m) height_m = reference_m;
    if (!is_same(*height_m, reference_m)) note(position, "in water", reference_m, *height_m);
  }

  void note(const GridPosition& at, const char* where, float found_m, float wanted_m) {
    ++findings.wrong;
    if (findings.wrong > 1) return;
    findings.problems.push_back(
        fmt::format("a sample {} at (column {}, row {}) counts as {} m and not as {} m", where,
                    at.column, at.row, found_m, wanted_m));
  }

  WaterShores shores_;
};

}  // namespace

WaterFindings check_water(const HeightSource& dem, const HeightSource& reference,
                          const Georeference& place, std::span<const WaterArea> areas,
                          double tolerance_m) {
  WaterCheck check(place, areas, tolerance_m);
  const GridShape shape = dem.shape();
  for (std::int64_t row = 0; row < shape.rows; row += kBlock) {
    for (std::int64_t column = 0; column < shape.columns; column += kBlock) {
      const Window window{column, row, std::min(kBlock, shape.columns - column),
                          std::min(kBlock, shape.rows - row)};
      check.check(dem.read(window), reference.read(window));
    }
  }
  return std::move(check.findings);
}

}  // namespace terrane::verify
