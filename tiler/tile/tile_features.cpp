#include "tiler/tile/tile_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrane::tiler {
namespace {

// a place is rounded by half a step on each axis
constexpr double kRounding_steps = 0.71;

std::int64_t first_tile(double a, double b, std::int64_t cells) {
  // a place on a border belongs to the tile before it, too
  const double tile = std::ceil(std::min(a, b) / static_cast<double>(cells)) - 1;
  return std::max<std::int64_t>(0, static_cast<std::int64_t>(tile));
}

std::int64_t last_tile(double a, double b, std::int64_t cells) {
  return static_cast<std::int64_t>(std::floor(std::max(a, b) / static_cast<double>(cells)));
}

bool is_same(const GridPosition& a, const GridPosition& b) {
  return a.column == b.column && a.row == b.row;
}

}  // namespace

TileFeatures::TileFeatures(const GridFeatures& features, const Pyramid& pyramid,
                           const Lattice& lattice, const std::vector<double>& tolerance_m)
    : features_(features), water_(features) {
  for (const FeatureLine& line : features.lines) {
    for (std::size_t piece = 0; piece + 1 < line.points.size(); ++piece) {
      add(line, piece, pyramid.leaf_cells());
    }
  }
  for (int level = 0; level < pyramid.level_count(); ++level) {
    const bool is_first = level == 0;
    const double step_m = lattice.step_m(level).x();
    const bool is_rounded = is_first || lattice.step_m(level - 1).x() < step_m;
    const double taken_m = is_first ? features.off_plan_m : tolerance_m[level - 1];
    const double rounding_m = is_rounded ? kRounding_steps * step_m : 0;
    tolerances_.push_back({.most_m = std::max(0.0, tolerance_m[level] - taken_m - rounding_m),
                           .column_m = features.column_m,
                           .row_m = features.row_m});
  }
}

void TileFeatures::add(const FeatureLine& line, std::size_t piece, std::int64_t cells) {
  const GridPosition &a = line.points[piece], &b = line.points[piece + 1];
  for (std::int64_t y = first_tile(a.row, b.row, cells); y <= last_tile(a.row, b.row, cells); ++y) {
    for (std::int64_t x = first_tile(a.column, b.column, cells);
         x <= last_tile(a.column, b.column, cells); ++x) {
      std::vector<FeatureLine>& of_tile = lines_[{y, x}];
      const bool goes_on = !of_tile.empty() && of_tile.back().height_m == line.height_m &&
                           is_same(of_tile.back().points.back(), a);
      if (goes_on) {
        of_tile.back().points.push_back(b);
      } else {
        of_tile.push_back({{a, b}, line.height_m});
      }
    }
  }
}

std::span<const FeatureLine> TileFeatures::lines_of(const TileId& leaf) const {
  const auto at = lines_.find({leaf.y, leaf.x});
  if (at == lines_.end()) return {};
  return at->second;
}

float TileFeatures::water_m(const hierarchy::SampleId& sample) const {
  float height_m = std::numeric_limits<float>::quiet_NaN();
  const auto row = features_.water.find(sample.row);
  if (row == features_.water.end()) return height_m;
  for (const WaterSpan& span : row->second) {
    if (span.first <= sample.column && sample.column <= span.last) height_m = span.height_m;
  }
  return height_m;
}

}  // namespace terrane::tiler
