#include "tiler/verify/grid_locator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace terrane::verify {
namespace {

constexpr int kMostNodes = 17;  // a side; 90 km apart (1,450 km in all) are off by 160 m half-way
constexpr int kMostSteps = 20;
constexpr double kCloseEnough = 1e-7;  // cells

int node_count(std::int64_t samples) {
  return static_cast<int>(std::clamp<std::int64_t>(samples, 2, kMostNodes));
}

}  // namespace

GridLocator::GridLocator(const World& world, const Window& window)
    : world_(world),
      begin_{static_cast<double>(window.column), static_cast<double>(window.row)},
      node_columns_(node_count(window.columns)),
      node_rows_(node_count(window.rows)) {
  spacing_.column = static_cast<double>(window.columns - 1) / (node_columns_ - 1);
  spacing_.row = static_cast<double>(window.rows - 1) / (node_rows_ - 1);
  std::vector<GridPosition> positions;
  for (int row = 0; row < node_rows_; ++row) {
    for (int column = 0; column < node_columns_; ++column) {
      positions.push_back(
          {begin_.column + column * spacing_.column, begin_.row + row * spacing_.row});
    }
  }
  nodes_ = world.plumb(positions);
  const Local middle = local_at(positions[positions.size() / 2]);
  column_size_m_ = middle.base_by_column.norm();
  row_size_m_ = middle.base_by_row.norm();
}

GridLocator::Local GridLocator::local_at(const GridPosition& at) const {
  const double u = (at.column - begin_.column) / spacing_.column;
  const double v = (at.row - begin_.row) / spacing_.row;
  const int column = std::clamp(static_cast<int>(std::floor(u)), 0, node_columns_ - 2);
  const int row = std::clamp(static_cast<int>(std::floor(v)), 0, node_rows_ - 2);
  const double a = u - column;
  const double b = v - row;
  const Plumb* p = &nodes_[static_cast<std::size_t>(row * node_columns_ + column)];
  const Plumb* q = p + node_columns_;
  const auto blend = [&](auto member) -> Eigen::Vector3d {
    return (1 - b) * ((1 - a) * p[0].*member + a * p[1].*member) +
           b * ((1 - a) * q[0].*member + a * q[1].*member);
  };
  const auto by_column = [&](auto member) -> Eigen::Vector3d {
    return ((1 - b) * (p[1].*member - p[0].*member) + b * (q[1].*member - q[0].*member)) /
           spacing_.column;
  };
  const auto by_row = [&](auto member) -> Eigen::Vector3d {
    return ((1 - a) * (q[0].*member - p[0].*member) + a * (q[1].*member - p[1].*member)) /
           spacing_.row;
  };
  return {blend(&Plumb::base),  blend(&Plumb::up),     by_column(&Plumb::base),
          by_row(&Plumb::base), by_column(&Plumb::up), by_row(&Plumb::up)};
}

Eigen::Vector3d GridLocator::step_to(const Local& local, double height,
                                     const Eigen::Vector3d& offset) {
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = local.base_by_column + height * local.up_by_column;
  jacobian.col(1) = local.base_by_row + height * local.up_by_row;
  jacobian.col(2) = local.up;
  return jacobian.inverse() * offset;
}

GridLocator::Located GridLocator::locate(const Eigen::Vector3d& point) const {
  GridPosition at{begin_.column + spacing_.column * (node_columns_ - 1) / 2,
                  begin_.row + spacing_.row * (node_rows_ - 1) / 2};
  double height = 0;
  Local local = local_at(at);
  for (int i = 0; i < kMostSteps; ++i) {  // Newton; the map is close to linear
    const Eigen::Vector3d step = step_to(local, height, point - local.base - height * local.up);
    at.column += step[0];
    at.row += step[1];
    height += step[2];
    local = local_at(at);
    if (std::abs(step[0]) + std::abs(step[1]) < kCloseEnough) break;
  }
  return {at, local.up};
}

void GridLocator::refine(std::span<const Eigen::Vector3d> points,
                         std::span<GridPosition> positions) const {
  for (int i = 0; i < 2; ++i) {
    const std::vector<Plumb> exact = world_.plumb(positions);
    for (std::size_t n = 0; n < points.size(); ++n) {
      const Eigen::Vector3d from_base = points[n] - exact[n].base;
      const double height = from_base.dot(exact[n].up);
      const Eigen::Vector3d step =
          step_to(local_at(positions[n]), height, from_base - height * exact[n].up);
      positions[n].column += step[0];
      positions[n].row += step[1];
    }
  }
}

}  // namespace terrane::verify
