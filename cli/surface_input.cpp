#include "cli/surface_input.h"

#include <utility>

#include "cli/dem_options.h"
#include "hierarchy/levels/check_surface.h"
#include "hierarchy/levels/grid_surface.h"
#include "hierarchy/levels/read_surface.h"
#include "ingest/scan.h"
#include "tiler/tile/world_frame.h"

namespace terrane::cli {
namespace {

/// Distance of neighbouring samples at the centre of the DEM, along a row and along a column.
std::pair<double, double> spacing_m(const ingest::Dem& dem) {
  const GridShape shape = dem.heights().shape();
  const tiler::WorldFrame world(dem.place(), shape);
  const double column = static_cast<double>(shape.columns / 2 - 1);
  const double row = static_cast<double>(shape.rows / 2 - 1);
  const std::array<GridPosition, 3> at{{{column, row}, {column + 1, row}, {column, row + 1}}};
  const auto plumbs = world.plumbs(at);
  return {(plumbs[1].base - plumbs[0].base).norm(), (plumbs[2].base - plumbs[0].base).norm()};
}

hierarchy::SurfaceMesh surface_of_dem(const SurfaceInput& input, Progress& progress) {
  ingest::OpenOptions options{.band = input.band, .nodata = input.nodata};
  if (input.crs) options.crs = *input.crs;
  if (input.vertical_unit) options.vertical_unit = vertical_unit_of(*input.vertical_unit);
  const auto dem = ingest::open_dem({input.input}, options, progress);
  ingest::scan_heights(*dem, progress);
  const GridShape shape = dem->heights().shape();
  const auto [column_m, row_m] = spacing_m(*dem);
  return hierarchy::surface_of(dem->heights().read({0, 0, shape.columns, shape.rows}), column_m,
                               row_m);
}

}  // namespace

void add_surface_options(CLI::App& command, SurfaceInput& input) {
  command.add_option("--band", input.band, "Of a DEM: band with the heights, from 1");
  command.add_option("--nodata", input.nodata, "Of a DEM: stored value of no data, or none");
  command.add_option("--vertical-unit", input.vertical_unit,
                     "Of a DEM: metre, foot or us-survey-foot");
  command.add_option("--crs", input.crs, "Of a DEM: coordinate reference system");
}

hierarchy::SurfaceMesh read_input(const SurfaceInput& input, Progress& progress) {
  hierarchy::SurfaceMesh mesh = hierarchy::is_surface_file(input.input)
                                    ? hierarchy::read_surface(input.input)
                                    : surface_of_dem(input, progress);
  return hierarchy::check_surface(std::move(mesh), input.input, progress);
}

}  // namespace terrane::cli
