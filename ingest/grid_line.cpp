#include "ingest/grid_line.h"

#include <algorithm>
#include <cmath>

#include "core/grid_features.h"

namespace terrane::ingest {
namespace {

double laid(double value, double snap_cells, int parts) {
  const double line = std::round(value);
  if (std::abs(value - line) <= snap_cells) return line;
  const double cell = std::floor(value);
  const double in_cell = std::round((value - cell) * parts) / parts;
  return cell + std::round(in_cell * kLinePartsPerCell) / kLinePartsPerCell;
}

/// Where, from 0 to 1, a coordinate passes whole numbers on its way from a to b.
void add_crossings(double a, double b, std::vector<double>& at) {
  const double low = std::min(a, b), high = std::max(a, b);
  for (double line = std::floor(low) + 1; line < high; ++line) at.push_back((line - a) / (b - a));
}

}  // namespace

std::vector<GridPosition> lay_on_grid(std::span<const GridPosition> line,
                                      const LineRounding& rounding) {
  std::vector<GridPosition> result;
  const auto add = [&](double column, double row) {
    const GridPosition next{laid(column, rounding.snap_cells, rounding.column_parts),
                            laid(row, rounding.snap_cells, rounding.row_parts)};
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
