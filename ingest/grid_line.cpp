#include "ingest/grid_line.h"

#include <algorithm>
#include <cmath>

#include "core/grid_features.h"

namespace terrane::ingest {
namespace {

double laid(double value, double snap_cells) {
  const double line = std::round(value);
  if (std::abs(value - line) <= snap_cells) return line;
  return std::round(value * kLinePartsPerCell) / kLinePartsPerCell;
}

/// Where, from 0 to 1, a coordinate passes whole numbers on its way from a to b.
void add_crossings(double a, double b, std::vector<double>& at) {
  const double low = std::min(a, b), high = std::max(a, b);
  for (double line = std::floor(low) + 1; line < high; ++line) at.push_back((line - a) / (b - a));
}

}  // namespace

std::vector<GridPosition> lay_on_grid(std::span<const GridPosition> line, double snap_cells) {
  std::vector<GridPosition> result;
  const auto add = [&](double column, double row) {
    const GridPosition next{laid(column, snap_cells), laid(row, snap_cells)};
    const bool is_new =
        result.empty() || result.back().column != next.column || result.back().row != next.row;
    if (is_new) result.push_back(next);
  };
  std::vector<double> crossings;
  add(line.front().column, line.front().row);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const GridPosition a = line[i], b = line[i + 1];
    crossings.clear();
    add_crossings(a.column, b.column, crossings);
    add_crossings(a.row, b.row, crossings);
    std::ranges::sort(crossings);
    // a crossing is off its column or row by rounding alone: snapping puts it there
    for (const double t : crossings) {
      add(a.column + t * (b.column - a.column), a.row + t * (b.row - a.row));
    }
    add(b.column, b.row);
  }
  if (result.size() < 2) result.clear();
  return result;
}

}  // namespace terrane::ingest
