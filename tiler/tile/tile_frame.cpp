#include "tiler/tile/tile_frame.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

using hierarchy::GridPoint;
using hierarchy::kUnitsPerCell;
using hierarchy::Place;

// the ends of a side are up to 0.71 steps off by rounding, and a whole step is what counts as
// covered
constexpr double kShareOfStep = 0.2;

// what the corners of most triangles differ by in height
constexpr double kRelief_m = 1000;

GridPoint grid_point(double column, double row) {
  return {static_cast<std::int32_t>(std::lround(column * kUnitsPerCell)),
          static_cast<std::int32_t>(std::lround(-row * kUnitsPerCell))};
}

/// count places from -1 to 1 that keep an interpolating polynomial from swinging.
Eigen::VectorXd chebyshev_nodes(int count) {
  return Eigen::VectorXd::NullaryExpr(count, [count](Eigen::Index i) {
    return -std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / count);
  });
}

void powers(double value, int degree, double* result) {
  result[0] = 1;
  for (int i = 1; i <= degree; ++i) result[i] = result[i - 1] * value;
}

}  // namespace

TileFrame::TileFrame(const WorldFrame& world, const Lattice& lattice, const Window& window,
                     int level)
    : lattice_(lattice),
      level_(level),
      first_column_(static_cast<double>(window.column)),
      first_row_(static_cast<double>(window.row)),
      half_columns_(static_cast<double>(window.columns - 1) / 2),
      half_rows_(static_cast<double>(window.rows - 1) / 2) {
  const double wanted_accuracy_m = lattice.step_m(level).minCoeff() / 256;
  for (int degree = 1; !fit(world, window, degree, wanted_accuracy_m); ++degree) {
    if (degree < kHighestDegree) continue;
    throw InputError(fmt::format(
        "columns {} to {}, rows {} to {}: the DEM's projection bends too much to be followed. "
        "Reproject the DEM with gdalwarp, or check --crs",
        window.column, window.column + window.columns - 1, window.row,
        window.row + window.rows - 1));
  }
  derive(window);
}

/// \return whether the polynomials of this degree are as exact as wanted.
bool TileFrame::fit(const WorldFrame& world, const Window& window, int degree,
                    double wanted_accuracy_m) {
  degree_ = degree;
  const int n = degree + 1;
  const auto position = [&](double s, double t) {
    return GridPosition{static_cast<double>(window.column) + half_columns_ * (1 + s),
                        static_cast<double>(window.row) + half_rows_ * (1 + t)};
  };
  const Eigen::VectorXd nodes = chebyshev_nodes(n);
  std::vector<GridPosition> positions;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) positions.push_back(position(nodes[i], nodes[j]));
  }
  const std::vector<Plumb> known = world.plumbs(positions);
  Eigen::MatrixXd powers_at_nodes(n * n, n * n);
  Eigen::MatrixXd values(n * n, 6);
  std::vector<double> s(n), t(n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      powers(nodes[i], degree, s.data());
      powers(nodes[j], degree, t.data());
      const int node = j * n + i;
      for (int k = 0; k < n * n; ++k) powers_at_nodes(node, k) = s[k % n] * t[k / n];
      values.row(node) << known[node].base.transpose(), known[node].up.transpose();
    }
  }
  coefficients_ = powers_at_nodes.colPivHouseholderQr().solve(values).transpose();

  // between the nodes, where an interpolation is at its worst, and at the corners
  constexpr int kProbes = 7;
  std::vector<GridPosition> probes;
  for (int j = 0; j <= kProbes; ++j) {
    for (int i = 0; i <= kProbes; ++i) {
      probes.push_back(position(2.0 * i / kProbes - 1, 2.0 * j / kProbes - 1));
    }
  }
  const std::vector<Plumb> exact = world.plumbs(probes);
  constexpr double kHighest_m = 9000;
  double worst_m = 0;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const Plumb guess = plumb(probes[i].column - static_cast<double>(window.column),
                              probes[i].row - static_cast<double>(window.row));
    worst_m = std::max({worst_m, (guess.base - exact[i].base).norm(),
                        (guess.up - exact[i].up).norm() * kHighest_m});
  }
  accuracy_m_ = 2 * worst_m;
  return accuracy_m_ <= wanted_accuracy_m;
}

void TileFrame::derive(const Window& window) {
  const double h = 0.5;
  const double c = half_columns_, r = half_rows_;
  const auto base = [this](double column, double row) { return plumb(column, row).base; };
  const Plumb middle = plumb(c, r);
  const Eigen::Vector3d per_column = (base(c + h, r) - base(c - h, r)) / (2 * h);
  const Eigen::Vector3d per_row = (base(c, r + h) - base(c, r - h)) / (2 * h);
  Eigen::Matrix3d world_per_grid;
  world_per_grid << per_column, per_row, middle.up;
  grid_per_world_ = world_per_grid.inverse();
  along_row_ = per_column;
  handedness_ = per_column.cross(-per_row).dot(middle.up) > 0 ? 1 : -1;
  // parts of a cell are equal in columns and rows, whatever the parallel
  spacing_m_ =
      lattice_.over_grid({}, level_) ? per_row.norm() : std::min(per_column.norm(), per_row.norm());

  // second differences over the whole tile: smaller steps would drown in rounding
  const double u = std::max(1.0, static_cast<double>(window.columns - 1) / 2);
  const double v = std::max(1.0, static_cast<double>(window.rows - 1) / 2);
  const auto depth = [&](double column, double row) {
    return -(base(column, row) - middle.base).dot(middle.up);
  };
  curvature_ << (depth(c + u, r) + depth(c - u, r)) / (2 * u * u),
      (depth(c + u, r + v) - depth(c - u, r + v) - depth(c + u, r - v) + depth(c - u, r - v)) /
          (4 * u * v),
      (depth(c, r + v) + depth(c, r - v)) / (2 * v * v);
  longest_straight_units_ =
      kUnitsPerCell * longest_straight_m() / std::max(per_column.norm(), per_row.norm());
}

/// A straight line bends over the grid with the square of its length, and the plumb lines at its
/// ends lean with it.
double TileFrame::longest_straight_m() const {
  if (lattice_.over_grid({}, level_)) return std::numeric_limits<double>::infinity();
  double bend_per_m2 = 0, lean_per_m = 0;
  constexpr int kParts = 4;
  const auto at = [&](int i, int j) {
    return GridPoint{static_cast<std::int32_t>(half_columns_ * 2 * kUnitsPerCell * i / kParts),
                     -static_cast<std::int32_t>(half_rows_ * 2 * kUnitsPerCell * j / kParts)};
  };
  const auto take_in = [&](GridPoint a, GridPoint b) {
    const Plumb from = plumb(hierarchy::column_of(a), hierarchy::row_of(a));
    const Plumb to = plumb(hierarchy::column_of(b), hierarchy::row_of(b));
    const double length_m = (to.base - from.base).norm();
    if (!(length_m > 0)) return;
    bend_per_m2 = std::max(bend_per_m2, bend_m({.plan = a}, {.plan = b}) / (length_m * length_m));
    lean_per_m = std::max(lean_per_m, (to.up - from.up).norm() / length_m);
  };
  for (int j = 0; j < kParts; ++j) {
    for (int i = 0; i < kParts; ++i) {
      take_in(at(i, j), at(i + 1, j));
      take_in(at(i, j), at(i, j + 1));
      take_in(at(i, j), at(i + 1, j + 1));
      take_in(at(i + 1, j), at(i, j + 1));
    }
  }
  const double most_m = kShareOfStep * lattice_.step_m(level_).x();
  const double off_per_m = lean_per_m * kRelief_m / 2;
  return 2 * most_m / (off_per_m + std::sqrt(off_per_m * off_per_m + 4 * bend_per_m2 * most_m));
}

Plumb TileFrame::plumb(double column, double row) const {
  const int n = degree_ + 1;
  double s[kHighestDegree + 1];
  powers(half_columns_ > 0 ? column / half_columns_ - 1 : 0, degree_, s);
  const double t = half_rows_ > 0 ? row / half_rows_ - 1 : 0;
  Eigen::Matrix<double, 6, 1> value = Eigen::Matrix<double, 6, 1>::Zero();
  for (int j = degree_; j >= 0; --j) {
    value *= t;
    for (int i = 0; i < n; ++i) value += coefficients_.col(j * n + i) * s[i];
  }
  return {value.head<3>(), value.tail<3>()};
}

TileFrame::Row TileFrame::row(double row) const {
  const int n = degree_ + 1;
  const double t = half_rows_ > 0 ? row / half_rows_ - 1 : 0;
  Row result;
  result.half_columns_ = half_columns_;
  result.coefficients_ = coefficients_.middleCols(degree_ * n, n);
  for (int j = degree_ - 1; j >= 0; --j) {
    result.coefficients_ = t * result.coefficients_ + coefficients_.middleCols(j * n, n);
  }
  return result;
}

Plumb TileFrame::Row::plumb(double column) const {
  const double s = half_columns_ > 0 ? column / half_columns_ - 1 : 0;
  Eigen::Matrix<double, 6, 1> value = coefficients_.rightCols<1>();
  for (Eigen::Index i = coefficients_.cols() - 2; i >= 0; --i) {
    value = s * value + coefficients_.col(i);
  }
  return {value.head<3>(), value.tail<3>()};
}

TileFrame::AlongRow TileFrame::Row::along(const Eigen::Vector3d& direction,
                                          Eigen::Index first_value) const {
  AlongRow result;
  // of a single column there is the middle alone
  if (half_columns_ > 0) result.degree = static_cast<int>(coefficients_.cols()) - 1;
  if (half_columns_ > 0) result.per_column = 1 / half_columns_;
  for (Eigen::Index i = 0; i <= result.degree; ++i) {
    result.coefficients[static_cast<std::size_t>(i)] =
        direction.dot(coefficients_.block<3, 1>(first_value, i));
  }
  return result;
}

Place TileFrame::solve(const Eigen::Vector3d& at) const {
  Eigen::Vector3d grid(half_columns_, half_rows_, 0);
  constexpr int kMostSteps = 40;
  constexpr double kAccuracy = 0.25 / kUnitsPerCell;
  for (int step = 0; step < kMostSteps; ++step) {
    const Plumb here = plumb(grid[0], grid[1]);
    const Eigen::Vector3d move = grid_per_world_ * (at - here.base - grid[2] * here.up);
    grid += move;
    if (std::abs(move[0]) < kAccuracy && std::abs(move[1]) < kAccuracy) break;
  }
  Place place{.plan = grid_point(grid[0], grid[1])};
  place.height_m = grid[2] - drop_m(grid[0], grid[1]);
  return place;
}

Place TileFrame::place_of(const Lattice::OverGrid& at) const {
  const double column = at.at.column - first_column_, row = at.at.row - first_row_;
  return {.plan = grid_point(column, row), .height_m = at.height_m - drop_m(column, row)};
}

Place TileFrame::place_of(const LatticePoint& point) const {
  const auto over_grid = lattice_.over_grid(point, level_);
  Place place = over_grid ? place_of(*over_grid) : solve(lattice_.world(point, level_));
  place.lattice = point;
  return place;
}

Place TileFrame::place_of_finer(const LatticePoint& point) const {
  const auto over_grid = lattice_.over_grid(point, level_ - 1);
  Place place = over_grid ? place_of(*over_grid) : solve(lattice_.world(point, level_ - 1));
  place.lattice = lattice_.coarsen(point, level_ - 1);
  return place;
}

Place TileFrame::place(GridPoint plan, double height_m) const {
  const double column = hierarchy::column_of(plan), row = hierarchy::row_of(plan);
  const double true_height_m = height_m + drop_m(column, row);
  if (lattice_.over_grid({}, level_)) {
    return place_of(lattice_.nearest_over_grid(
        {{first_column_ + column, first_row_ + row}, true_height_m}, level_));
  }
  const Plumb here = plumb(column, row);
  const LatticePoint point = lattice_.nearest(here.base + true_height_m * here.up, level_);
  const Eigen::Vector3d rounding =
      lattice_.world(point, level_) - here.base - true_height_m * here.up;
  // the rounding is a step at most: the map is linear enough over that
  const Eigen::Vector3d move = grid_per_world_ * rounding;
  Place place{.plan = grid_point(column + move[0], row + move[1]), .lattice = point};
  place.height_m = true_height_m + move[2] - drop_m(column + move[0], row + move[1]);
  return place;
}

double TileFrame::over_datum_m(GridPoint plan, double height_m) const {
  return height_m - drop_m(hierarchy::column_of(plan), hierarchy::row_of(plan));
}

double TileFrame::bend_m(const Place& a, const Place& b) const {
  const auto base = [this](GridPoint p) {
    return plumb(hierarchy::column_of(p), hierarchy::row_of(p)).base;
  };
  const Eigen::Vector3d from = base(a.plan), to = base(b.plan);
  const Plumb middle = plumb((hierarchy::column_of(a.plan) + hierarchy::column_of(b.plan)) / 2,
                             (hierarchy::row_of(a.plan) + hierarchy::row_of(b.plan)) / 2);
  const Eigen::Vector3d gap = middle.base - (from + to) / 2;
  return (gap - gap.dot(middle.up) * middle.up).norm();
}

void TileFrame::look_down(std::span<const Place> places,
                          std::span<hierarchy::PlanPoint> seen) const {
  const auto n = static_cast<double>(places.size());
  double column = 0, row = 0;
  for (const Place& place : places) {
    column += hierarchy::column_of(place.plan) / n;
    row += hierarchy::row_of(place.plan) / n;
  }
  const Plumb middle = plumb(column, row);
  const Eigen::Vector3d right = (along_row_ - along_row_.dot(middle.up) * middle.up).normalized();
  const Eigen::Vector3d upwards = handedness_ * middle.up.cross(right);
  const double units_per_m = kUnitsPerCell / spacing_m_;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double at_column = hierarchy::column_of(places[k].plan);
    const double at_row = hierarchy::row_of(places[k].plan);
    const Plumb foot = plumb(at_column, at_row);
    const Eigen::Vector3d off =
        foot.base - middle.base + (places[k].height_m + drop_m(at_column, at_row)) * foot.up;
    seen[k] = {off.dot(right) * units_per_m, off.dot(upwards) * units_per_m};
  }
}

bool TileFrame::is_straight(const Place& a, const Place& b) const {
  return bend_m(a, b) <= kShareOfStep * lattice_.step_m(level_).x();
}

}  // namespace terrane::tiler
