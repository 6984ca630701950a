#include "model/raster_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "hierarchy/volume/grid_field.h"
#include "ingest/dem.h"
#include "ingest/scan.h"
#include "model/field_over_box.h"

namespace terrane::model {
namespace {

using hierarchy::volume::Box;
using hierarchy::volume::GridField;

constexpr double kMostPosts = 2e8;
constexpr double kOneSample = 1e-6;  // cells: a position this close to a sample is that sample

std::unique_ptr<ingest::Dem> open_band(const FieldSource& source, int band, Progress& progress) {
  ingest::OpenOptions options;
  options.band = band;
  options.vertical_unit = ingest::VerticalUnit::kMetre;  // a field's values are no heights
  if (!source.nodata.empty()) options.nodata = source.nodata;
  return ingest::open_dem({source.raster}, options, progress);
}

std::vector<double> levels_of(const std::string& who, const FieldSource& source, int bands,
                              const Box& box) {
  if (source.levels_m.empty() && bands == 1) return {box.low.z(), box.high.z()};
  if (source.levels_m.size() == static_cast<std::size_t>(bands) && bands > 1) {
    return source.levels_m;
  }
  throw InputError(
      fmt::format("{}: has {} band{}, but levels_m has {} heights. Give one for each, "
                  "two at least (or none for a raster of one band)",
                  who, bands, bands == 1 ? "" : "s", source.levels_m.size()));
}

/// Whether columns run along x, and rows along y.
bool is_aligned(const Georeference& place, const PlanFrame& frame) {
  const PlanPosition a = place.to_plan({0, 0}), b = place.to_plan({1, 0}), c = place.to_plan({0, 1});
  return !frame.is_on_earth() && a.y == b.y && a.x == c.x;
}

/// Places of the samples of one row (or column), rising.
std::vector<double> sample_places(const Georeference& place, std::int64_t count, bool is_row) {
  std::vector<double> axis;
  for (std::int64_t k = 0; k < count; ++k) {
    const double at = static_cast<double>(k);
    axis.push_back(is_row ? place.to_plan({at, 0}).x : place.to_plan({0, at}).y);
  }
  if (axis.back() < axis.front()) std::ranges::reverse(axis);
  return axis;
}

std::vector<double> evenly(double low, double high, double cells) {
  const double steps = std::clamp(std::ceil(cells), 1.0, kMostPosts);
  std::vector<double> axis;
  for (double k = 0; k <= steps; ++k) axis.push_back(low + (high - low) * k / steps);
  return axis;
}

/// Grid positions of the box's corners, and the rectangle around the raster in the plan.
std::array<std::vector<double>, 2> even_posts(const GridPlan& plan, const Box& box) {
  const std::vector<PlanPosition> corners = {{box.low.x(), box.low.y()},
                                             {box.high.x(), box.low.y()},
                                             {box.low.x(), box.high.y()},
                                             {box.high.x(), box.high.y()}};
  const auto at = plan.to_grid(corners);
  const auto cells = [&](std::size_t a, std::size_t b) {
    return std::hypot(at[a].column - at[b].column, at[a].row - at[b].row);
  };
  return {evenly(box.low.x(), box.high.x(), std::max(cells(0, 1), cells(2, 3))),
          evenly(box.low.y(), box.high.y(), std::max(cells(0, 2), cells(1, 3)))};
}

void keep_around(std::vector<double>& axis, double low, double high) {
  const PostRange range = posts_around(axis, low, high);
  axis.erase(axis.begin() + static_cast<std::ptrdiff_t>(range.first + range.count), axis.end());
  axis.erase(axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(range.first));
}

/// Grid positions of all posts, held within the raster.
std::vector<GridPosition> positions_of(const std::string& who, const GridPlan& plan,
                                       const std::array<std::vector<double>, 3>& axes,
                                       GridShape shape) {
  std::vector<PlanPosition> posts;
  for (const double y : axes[1]) {
    for (const double x : axes[0]) posts.push_back({x, y});
  }
  std::vector<GridPosition> positions = plan.to_grid(posts);
  const double right = static_cast<double>(shape.columns - 1);
  const double bottom = static_cast<double>(shape.rows - 1);
  const auto outside = [&](const GridPosition p) {
    // a cell reaches half a spacing beyond its centre
    return p.column < -0.5 || p.column > right + 0.5 || p.row < -0.5 || p.row > bottom + 0.5;
  };
  if (std::ranges::all_of(positions, outside)) {
    throw InputError(fmt::format("{}: lies outside the box. Move one of them", who));
  }
  for (GridPosition& p : positions) {
    p.column = std::clamp(p.column, 0.0, right);
    p.row = std::clamp(p.row, 0.0, bottom);
  }
  return positions;
}

/// The window that some positions need.
Window window_of(const std::vector<GridPosition>& positions, GridShape shape) {
  const auto columns = std::ranges::minmax(positions, {}, &GridPosition::column);
  const auto rows = std::ranges::minmax(positions, {}, &GridPosition::row);
  const auto low = [](double at) { return static_cast<std::int64_t>(std::floor(at)); };
  const auto end = [](double at, std::int64_t size) {
    return std::min(static_cast<std::int64_t>(std::floor(at)) + 2, size);
  };
  Window window;
  window.column = low(columns.min.column);
  window.row = low(rows.min.row);
  window.columns = end(columns.max.column, shape.columns) - window.column;
  window.rows = end(rows.max.row, shape.rows) - window.row;
  return window;
}

double nearly_whole(double at) {
  return std::abs(at - std::round(at)) < kOneSample ? std::round(at) : at;
}

/// Bilinear; NaN where a sample that counts has no data.
double between(const HeightGrid& grid, GridPosition p) {
  const double column = nearly_whole(p.column), row = nearly_whole(p.row);
  const auto i = static_cast<std::int64_t>(std::floor(column));
  const auto j = static_cast<std::int64_t>(std::floor(row));
  const double s = column - std::floor(column), t = row - std::floor(row);
  double value = 0;
  for (int k = 0; k < 4; ++k) {
    const double weight = ((k & 1) != 0 ? s : 1 - s) * ((k & 2) != 0 ? t : 1 - t);
    if (weight != 0) value += weight * static_cast<double>(grid.at(i + (k & 1), j + (k >> 1)));
  }
  return value;
}

}  // namespace

std::shared_ptr<const hierarchy::volume::Field> raster_field(const std::string& name,
                                                             const FieldSource& source,
                                                             const PlanFrame& frame, const Box& box,
                                                             Progress& progress) {
  const std::string who = fmt::format("field {}: {}", name, source.raster);
  const auto first = open_band(source, 1, progress);
  require_same_kind(who, first->place(), frame);
  const int bands = first->description().band_count;
  const GridShape shape = first->heights().shape();
  const GridPlan plan(first->place(), frame);
  std::array<std::vector<double>, 3> axes;
  if (is_aligned(first->place(), frame)) {
    axes[0] = sample_places(first->place(), shape.columns, true);
    axes[1] = sample_places(first->place(), shape.rows, false);
  } else {
    const auto even = even_posts(plan, box);
    axes[0] = even[0];
    axes[1] = even[1];
  }
  axes[2] = levels_of(who, source, bands, box);
  check_reach(who, axes, box, progress);
  for (int k = 0; k < 2; ++k) keep_around(axes[k], box.low[k], box.high[k]);
  const double posts = static_cast<double>(axes[0].size() * axes[1].size()) * bands;
  if (posts > kMostPosts) {
    throw InputError(fmt::format("{}: the box holds {:.3g} of its samples, more than {:.3g}. Make "
                                 "the box smaller, or thin the raster out",
                                 who, posts, kMostPosts));
  }
  const std::vector<GridPosition> positions = positions_of(who, plan, axes, shape);
  std::vector<double> values;
  for (int band = 1; band <= bands; ++band) {
    const auto dem = band == 1 ? nullptr : open_band(source, band, progress);
    const ingest::Dem& layer = band == 1 ? *first : *dem;
    ingest::scan_heights(layer, progress);  // refuses undeclared voids
    const HeightGrid grid = layer.heights().read(window_of(positions, shape));
    for (const GridPosition p : positions) values.push_back(between(grid, p));
  }
  if (source.levels_m.empty()) {
    const std::vector<double> only = values;
    values.insert(values.end(), only.begin(), only.end());
  }
  try {
    return std::make_shared<GridField>(std::move(axes), std::vector<std::vector<double>>{std::move(values)});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", who, error.what()));
  }
}

}  // namespace terrane::model
