#include "model/ground_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/errors.h"

namespace terrane::model {
namespace {

using hierarchy::volume::Box;
using hierarchy::volume::SurfaceMesh;

constexpr std::int64_t kMargin_cells = 3;  // beyond the box, so that the rim is nowhere near
constexpr std::int64_t kVoidReach_cells = 8;
constexpr double kMostVertices = 2e8;

/// All samples of a DEM near some plan positions.
class Samples {
 public:
  Samples(const ingest::Dem& dem, const std::vector<GridPosition>& wanted) {
    const GridShape shape = dem.heights().shape();
    double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
    for (const GridPosition p : wanted) {
      left = std::min(left, p.column);
      right = std::max(right, p.column);
      top = std::min(top, p.row);
      bottom = std::max(bottom, p.row);
    }
    const auto clamped = [](double value, std::int64_t size) {
      return static_cast<std::int64_t>(std::clamp(value, 0.0, static_cast<double>(size)));
    };
    Window window;
    window.column = clamped(left - kVoidReach_cells - 1, shape.columns);
    window.row = clamped(top - kVoidReach_cells - 1, shape.rows);
    window.columns = clamped(right + kVoidReach_cells + 2, shape.columns) - window.column;
    window.rows = clamped(bottom + kVoidReach_cells + 2, shape.rows) - window.row;
    if (window.columns > 0 && window.rows > 0) grid_ = dem.heights().read(window);
  }

  std::optional<double> at(std::int64_t column, std::int64_t row) const {
    const Window& w = grid_.window;
    const bool is_inside =
        column >= w.column && column < w.column + w.columns && row >= w.row && row < w.row + w.rows;
    if (!is_inside || !grid_.has_data(column, row)) return {};
    return grid_.at(column, row);
  }

  /// Bilinear; nothing where one of the samples around is void.
  std::optional<double> between(GridPosition p) const {
    const double column = std::floor(p.column), row = std::floor(p.row);
    const double s = p.column - column, t = p.row - row;
    double height = 0;
    for (int k = 0; k < 4; ++k) {
      const double weight = ((k & 1) != 0 ? s : 1 - s) * ((k & 2) != 0 ? t : 1 - t);
      if (weight < 1e-9) continue;
      const auto sample = at(static_cast<std::int64_t>(column) + (k & 1),
                             static_cast<std::int64_t>(row) + (k >> 1));
      if (!sample) return {};
      height += weight * *sample;
    }
    return height;
  }

  /// Mean of the samples on the smallest square around that has any.
  std::optional<double> nearest(GridPosition p) const {
    const std::int64_t column = std::llround(p.column), row = std::llround(p.row);
    for (std::int64_t reach = 0; reach <= kVoidReach_cells; ++reach) {
      double sum = 0;
      int count = 0;
      for (std::int64_t j = -reach; j <= reach; ++j) {
        for (std::int64_t i = -reach; i <= reach; ++i) {
          if (std::max(std::abs(i), std::abs(j)) != reach) continue;
          const auto sample = at(column + i, row + j);
          if (!sample) continue;
          sum += *sample;
          ++count;
        }
      }
      if (count > 0) return sum / count;
    }
    return {};
  }

 private:
  HeightGrid grid_;
};

/// Whole positions of the first DEM's grid that cover the box.
struct Posts {
  std::int64_t column, row, columns, rows;

  GridPosition at(std::int64_t k) const {
    return {static_cast<double>(column + k % columns), static_cast<double>(row + k / columns)};
  }
};

Posts posts_over(const GridPlan& plan, const Box& box) {
  std::vector<PlanPosition> rim;
  for (int k = 0; k <= 8; ++k) {
    const double x = box.low.x() + box.size().x() * k / 8;
    const double y = box.low.y() + box.size().y() * k / 8;
    rim.insert(rim.end(),
               {{x, box.low.y()}, {x, box.high.y()}, {box.low.x(), y}, {box.high.x(), y}});
  }
  double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
  for (const GridPosition p : plan.to_grid(rim)) {
    left = std::min(left, p.column);
    right = std::max(right, p.column);
    top = std::min(top, p.row);
    bottom = std::max(bottom, p.row);
  }
  Posts posts{};
  posts.column = static_cast<std::int64_t>(std::floor(left)) - kMargin_cells;
  posts.row = static_cast<std::int64_t>(std::floor(top)) - kMargin_cells;
  posts.columns = static_cast<std::int64_t>(std::ceil(right)) + kMargin_cells + 1 - posts.column;
  posts.rows = static_cast<std::int64_t>(std::ceil(bottom)) + kMargin_cells + 1 - posts.row;
  return posts;
}

/// Rows may run up or down the plan: normals are to point up in both cases.
bool runs_down(const std::vector<PlanPosition>& plan, const Posts& posts) {
  const PlanPosition a = plan[0], b = plan[1], c = plan[static_cast<std::size_t>(posts.columns)];
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0;
}

void join(SurfaceMesh& mesh, const Posts& posts, bool is_downward) {
  for (std::int64_t row = 0; row + 1 < posts.rows; ++row) {
    for (std::int64_t column = 0; column + 1 < posts.columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row * posts.columns + column);
      const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(posts.columns), d = c + 1;
      if (is_downward) {
        mesh.triangles.push_back({a, d, b});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
    }
  }
}

}  // namespace

SurfaceMesh ground_surface(const std::vector<const ingest::Dem*>& dems, const PlanFrame& frame,
                           const Box& box, Progress& progress) {
  const GridPlan first(dems.front()->place(), frame);
  const Posts posts = posts_over(first, box);
  const double count = static_cast<double>(posts.columns) * static_cast<double>(posts.rows);
  if (count > kMostVertices) {
    throw InputError(
        fmt::format("{}: the box holds {:.3g} of its samples, more than {:.3g}. Make "
                    "the box smaller, or thin the DEM out",
                    dems.front()->name(), count, kMostVertices));
  }
  std::vector<GridPosition> own;
  for (std::int64_t k = 0; k < posts.columns * posts.rows; ++k) own.push_back(posts.at(k));
  const std::vector<PlanPosition> plan = first.to_plan(own);
  std::vector<std::optional<double>> heights(own.size());
  std::vector<std::vector<GridPosition>> places;
  std::vector<Samples> samples;
  for (const ingest::Dem* dem : dems) {
    places.push_back(dem == dems.front() ? own : GridPlan(dem->place(), frame).to_grid(plan));
    samples.emplace_back(*dem, places.back());
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (!heights[i]) heights[i] = samples.back().between(places.back()[i]);
    }
  }
  std::size_t bridged = 0;
  SurfaceMesh mesh;
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t d = dems.size(); d-- > 0 && !heights[i];) {
      heights[i] = samples[d].nearest(places[d][i]);
      if (heights[i]) ++bridged;
    }
    if (!heights[i]) {
      throw InputError(
          fmt::format("{}: has no height at x {:.0f} m, y {:.0f} m, within the box or "
                      "beside it, nor has any DEM after it. Make the box smaller, or "
                      "add a DEM",
                      dems.front()->name(), plan[i].x, plan[i].y));
    }
    mesh.points.emplace_back(plan[i].x, plan[i].y, *heights[i]);
  }
  if (bridged > 0) {
    progress.note(fmt::format("{}: {} of {} heights are the mean of samples beside a void",
                              dems.front()->name(), bridged, own.size()));
  }
  join(mesh, posts, runs_down(plan, posts));
  return mesh;
}

}  // namespace terrane::model
