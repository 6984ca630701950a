#include <cpl_conv.h>
#include <fmt/format.h>

#include <utility>

#include "core/errors.h"
#include "ingest/dem.h"
#include "ingest/gdal_scope.h"
#include "ingest/grid_place.h"
#include "ingest/height_conversion.h"
#include "ingest/mosaic.h"
#include "ingest/raise_heights.h"
#include "ingest/raster_file.h"
#include "ingest/synthetic.h"
#include "ingest/water_level.h"

namespace terrane::ingest {
namespace {

std::string name_of(const std::vector<std::string>& sources) {
  const std::string first = CPLGetFilename(sources.front().c_str());
  return sources.size() == 1 ? first : fmt::format("{} and {} more", first, sources.size() - 1);
}

bool wants_every_value(const OpenOptions& options) { return options.nodata == "none"; }

void add_suspects(std::vector<SuspectHeight>& suspects, const RasterFacts& facts) {
  for (SuspectHeight& suspect : suspects_of(facts.conversion)) {
    suspects.push_back(std::move(suspect));
  }
}

/// What the heights of a compound CRS, or one of three dimensions, are over.
std::string vertical_crs_of(const OGRSpatialReference& crs) {
  const GdalScope gdal;
  if (crs.IsCompound()) {
    const char* name = crs.GetAttrValue("COMPD_CS|VERT_CS");
    return name == nullptr ? "a vertical CRS without a name" : name;
  }
  return crs.GetAxesCount() == 3 ? kEllipsoidalHeight : "";
}

std::unique_ptr<Dem> open_rasters(const std::vector<std::string>& sources,
                                  const OpenOptions& options, Progress& progress) {
  auto heights = std::make_unique<Mosaic>(sources, options);
  const RasterFacts& first = heights->files().front()->facts();
  std::vector<SuspectHeight> suspects;
  if (!wants_every_value(options)) {
    for (const auto& file : heights->files()) add_suspects(suspects, file->facts());
  }
  DemDescription description = first.description;
  description.files = sources;
  description.vertical_crs = vertical_crs_of(first.crs);
  const std::string name = name_of(sources);
  auto place = place_grid(name, heights->shape(), heights->geotransform(), first.crs, options.crs,
                          description, progress);
  return std::make_unique<Dem>(name, std::move(description), std::move(suspects),
                               std::move(heights), std::move(place));
}

void refuse_options_of_files(const std::string& source, const OpenOptions& options) {
  const char* option = options.band            ? "--band"
                       : options.nodata        ? "--nodata"
                       : options.vertical_unit ? "--vertical-unit"
                       : !options.crs.empty()  ? "--crs"
                                               : nullptr;
  if (option == nullptr) return;
  throw InputError(fmt::format("{}: {} describes files, and this DEM is computed. Leave it away",
                               source, option));
}

}  // namespace

Dem::Dem(std::string name, DemDescription description, std::vector<SuspectHeight> suspects,
         std::unique_ptr<HeightSource> heights, std::unique_ptr<Georeference> place)
    : name_(std::move(name)),
      description_(std::move(description)),
      suspects_(std::move(suspects)),
      heights_(std::move(heights)),
      place_(std::move(place)) {}

void Dem::level_water(const WaterRows& water) {
  heights_ = ingest::level_water(std::move(heights_), water);
}

void Dem::raise(std::unique_ptr<Geoid> geoid) {
  raised_by_ = geoid.get();
  heights_ = raise_heights(std::move(heights_), *place_, std::move(geoid));
}

double Dem::raised_m(std::span<const GridPosition> places) const {
  if (raised_by_ == nullptr || places.empty()) return 0;
  double sum_m = 0;
  for (const LonLat& at : place_->to_lon_lat(places)) sum_m += raised_by_->undulation_m(at);
  return sum_m / static_cast<double>(places.size());
}

std::unique_ptr<Dem> open_dem(const std::vector<std::string>& sources, const OpenOptions& options,
                              Progress& progress) {
  if (sources.empty()) throw InputError("no DEM is given. Name at least one raster file");
  for (const std::string& source : sources) {
    if (!is_synthetic(source)) continue;
    if (sources.size() > 1) {
      throw InputError(fmt::format("{}: is synthetic and makes no mosaic. Give it alone", source));
    }
    refuse_options_of_files(source, options);
    return open_synthetic_dem(source);
  }
  return open_rasters(sources, options, progress);
}

}  // namespace terrane::ingest
