#include "cli/dem_options.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace terrane::cli {

CLI::Option* add_dem_options(CLI::App& command, DemOptions& options) {
  CLI::Option* dem =
      command.add_option("dem", options.dem,
                         "Raster with heights, in any format that GDAL reads; several make a "
                         "mosaic; or synthetic:caldera?size=513&seed=1");
  command.add_option("--band", options.band, "Band with the heights, from 1 [the only one]");
  command.add_option("--nodata", options.nodata,
                     "Stored value that means no data, or none: all are heights [as the file "
                     "says]");
  command.add_option("--vertical-unit", options.vertical_unit,
                     "Unit of the heights: metre, foot or us-survey-foot [as the file says, else "
                     "metre]");
  command.add_option("--crs", options.crs,
                     "Coordinate reference system, like EPSG:4326 [as the file says, else local "
                     "metres]");
  return dem;
}

void apply(const DemOptions& options, ingest::OpenOptions& settings) {
  if (options.band) settings.band = options.band;
  if (options.nodata) settings.nodata = options.nodata;
  if (options.vertical_unit) settings.vertical_unit = vertical_unit_of(*options.vertical_unit);
  if (options.crs) settings.crs = *options.crs;
}

void add_feature_options(CLI::App& command, DemOptions& options) {
  command.add_option("--lines", options.lines,
                     "Lines that the mesh keeps as edges, within the tolerance in plan: any vector "
                     "file, or FILE:LAYER");
  command.add_option("--water", options.water,
                     "Polygons whose inside is one flat height and whose shore the mesh keeps; "
                     "geodetic: those of the water mask");
  command.add_option(
      "--water-height", options.water_height_m,
      "Height of the water in metres, over what the DEM's heights are over [the median "
      "along its shore]");
}

void apply(const DemOptions& options, ingest::FeatureOptions& settings) {
  if (!options.lines.empty()) settings.lines = options.lines;
  if (!options.water.empty()) settings.water = options.water;
  if (options.water_height_m) settings.water_height_m = options.water_height_m;
}

ingest::VerticalUnit vertical_unit_of(const std::string& word) {
  const auto unit = ingest::parse_vertical_unit(word);
  if (unit) return *unit;
  throw ConfigError(
      fmt::format("--vertical-unit {}: is not known. Use metre, foot or us-survey-foot", word));
}

}  // namespace terrane::cli
