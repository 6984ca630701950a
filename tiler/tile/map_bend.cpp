#include "tiler/tile/map_bend.h"

#include <algorithm>
#include <cmath>

namespace terrane::tiler {
namespace {

constexpr int kProbes = 6;
constexpr double kShareAtPole = 0.001;

}  // namespace

MapBend::MapBend(const TileFrame& frame, const Window& tile) {
  const auto columns = static_cast<double>(tile.columns - 1);
  const auto rows = static_cast<double>(tile.rows - 1);
  const double u = std::max(1.0, columns / kProbes), v = std::max(1.0, rows / kProbes);
  for (int j = 1; j < kProbes; ++j) {
    for (int i = 1; i < kProbes; ++i) add(frame, columns * i / kProbes, rows * j / kProbes, u, v);
  }
  const auto is_a_point = [&](double row) {
    const Eigen::Vector3d along = frame.plumb(columns, row).base - frame.plumb(0, row).base;
    return along.norm() < kShareAtPole * columns * frame.spacing_m();
  };
  meets_pole_ = is_a_point(0) || is_a_point(rows);
}

double MapBend::cells(double columns, double rows) const {
  constexpr double kToBeSure = 2;
  return kToBeSure / 8 *
         (columns_ * columns * columns + 2 * both_ * std::abs(columns * rows) +
          rows_ * rows * rows);
}

/// Takes the second derivatives at a place, from steps of u columns and v rows.
void MapBend::add(const TileFrame& frame, double column, double row, double u, double v) {
  const Eigen::Vector3d up = frame.plumb(column, row).up;
  const auto base = [&](double i, double j) {
    return frame.plumb(column + i * u, row + j * v).base;
  };
  const auto flat_cells = [&](const Eigen::Vector3d& bend) {
    return (bend - bend.dot(up) * up).norm() / frame.spacing_m();
  };
  const Eigen::Vector3d here = base(0, 0);
  columns_ = std::max(columns_, flat_cells(base(1, 0) + base(-1, 0) - 2 * here) / (u * u));
  rows_ = std::max(rows_, flat_cells(base(0, 1) + base(0, -1) - 2 * here) / (v * v));
  both_ = std::max(both_,
                   flat_cells(base(1, 1) + base(-1, -1) - base(1, -1) - base(-1, 1)) / (4 * u * v));
}

}  // namespace terrane::tiler
