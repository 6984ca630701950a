#include "model/rectilinear_field.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "hierarchy/volume/grid_field.h"
#include "ingest/rectilinear_grid.h"
#include "model/field_over_box.h"

namespace terrane::model {
namespace {

using Axes = std::array<std::vector<double>, 3>;

/// Keeps the posts that a box needs.
void cut(ingest::RectilinearGrid& grid, const hierarchy::volume::Box& box) {
  std::array<PostRange, 3> range;
  Axes axes;
  for (int k = 0; k < 3; ++k) {
    const auto& axis = grid.axes[k];
    range[k] = posts_around(axis, box.low[k], box.high[k]);
    const auto first = axis.begin() + static_cast<std::ptrdiff_t>(range[k].first);
    axes[k].assign(first, first + static_cast<std::ptrdiff_t>(range[k].count));
  }
  std::vector<double> values;
  values.reserve(range[0].count * range[1].count * range[2].count);
  for (std::size_t k = range[2].first; k < range[2].first + range[2].count; ++k) {
    for (std::size_t j = range[1].first; j < range[1].first + range[1].count; ++j) {
      const std::size_t row = (k * grid.axes[1].size() + j) * grid.axes[0].size();
      for (std::size_t i = 0; i < range[0].count; ++i) {
        values.push_back(grid.values[row + range[0].first + i]);
      }
    }
  }
  grid.axes = std::move(axes);
  grid.values = std::move(values);
}

}  // namespace

std::shared_ptr<const hierarchy::volume::Field> rectilinear_field(
    const std::string& name, const FieldSource& source, const hierarchy::volume::Box& box,
    Progress& progress) {
  ingest::RectilinearGrid grid = ingest::read_rectilinear_grid(source.grid, source.array);
  const std::string who = fmt::format("field {}: {}", name, source.grid);
  check_reach(who, grid.axes, box, progress);
  cut(grid, box);
  try {
    return std::make_shared<hierarchy::volume::GridField>(std::move(grid.axes),
                                                          std::vector<std::vector<double>>{std::move(grid.values)});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", who, error.what()));
  }
}

}  // namespace terrane::model
