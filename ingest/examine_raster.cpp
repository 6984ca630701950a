#include <fmt/format.h>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/raster_file.h"

namespace terrane::ingest {
namespace {

void refuse_unusable(GDALDataset& dataset, GDALRasterBand& band, const std::string& file) {
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  if (columns < 2 || rows < 2) {
    throw InputError(
        fmt::format("{}: has {} x {} samples, and a terrain needs at least 2 x 2. Give "
                    "a larger raster",
                    file, columns, rows));
  }
  if (GDALDataTypeIsComplex(band.GetRasterDataType())) {
    throw InputError(
        fmt::format("{}: band {} holds complex numbers ({}), not heights. Pick another "
                    "band with --band, or another file",
                    file, band.GetBand(), GDALGetDataTypeName(band.GetRasterDataType())));
  }
}

struct ChosenUnit {
  VerticalUnit unit;
  std::string origin;
};

std::optional<ChosenUnit> unit_of_band(GDALRasterBand& band, const std::string& file) {
  const std::string word = band.GetUnitType();
  if (word.empty()) return std::nullopt;
  const auto unit = recognise_vertical_unit(word);
  if (unit) return ChosenUnit{*unit, "the band"};
  throw InputError(
      fmt::format("{}: cannot tell the unit of heights from '{}'. Say it with "
                  "--vertical-unit metre, foot or us-survey-foot",
                  file, word));
}

std::optional<ChosenUnit> unit_of_crs(const OGRSpatialReference& crs, const std::string& file) {
  if (!crs.IsCompound() && !crs.IsVertical()) return std::nullopt;
  const char* name = "";
  const double length_m = crs.GetTargetLinearUnits("VERT_CS", &name);
  const auto unit = recognise_vertical_unit(length_m);
  if (unit) return ChosenUnit{*unit, "the CRS"};
  throw InputError(
      fmt::format("{}: its CRS counts heights in '{}'. Say the unit with "
                  "--vertical-unit metre, foot or us-survey-foot",
                  file, name));
}

ChosenUnit choose_unit(GDALRasterBand& band, const OGRSpatialReference& crs,
                       const std::string& file, const OpenOptions& options) {
  if (options.vertical_unit) return {*options.vertical_unit, "--vertical-unit"};
  if (const auto unit = unit_of_band(band, file)) return *unit;
  if (const auto unit = unit_of_crs(crs, file)) return *unit;
  return {VerticalUnit::kMetre, "nothing said; metre is assumed"};
}

std::optional<double> nodata_of_band(GDALRasterBand& band) {
  int is_set = 0;
  double value = 0;
  // GDAL keeps 64-bit integers apart, as a double cannot hold them all; the samples become doubles
  // as well, so the rounded value still meets its samples
  if (band.GetRasterDataType() == GDT_Int64) {
    value = static_cast<double>(band.GetNoDataValueAsInt64(&is_set));
  } else if (band.GetRasterDataType() == GDT_UInt64) {
    value = static_cast<double>(band.GetNoDataValueAsUInt64(&is_set));
  } else {
    value = band.GetNoDataValue(&is_set);
  }
  return is_set ? std::optional(value) : std::nullopt;
}

void add_nodata(RasterFacts& facts, GDALRasterBand& band, const std::string& file,
                const OpenOptions& options) {
  const int flags = band.GetMaskFlags();
  const bool has_mask = (flags & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  std::vector<double>& nodata = facts.conversion.nodata;
  std::string& origin = facts.description.nodata_origin;
  if (options.nodata) {
    nodata = parse_nodata(*options.nodata, file);
    origin = "--nodata";
    facts.has_mask = has_mask && *options.nodata != "none";
  } else {
    if (const auto declared = nodata_of_band(band)) {
      nodata.push_back(*declared);
      origin = "the band";
    }
    facts.has_mask = has_mask || (flags & GMF_PER_DATASET) != 0;
    if (facts.has_mask) origin += origin.empty() ? "a mask" : " and a mask";
  }
  if (band.GetRasterDataType() == GDT_Float32) {
    for (double& value : nodata) value = rounded_to_float(value);
  }
  facts.description.nodata = nodata;
}

std::optional<Geotransform> geotransform_of(GDALDataset& dataset, const std::string& file) {
  Geotransform t;
  if (dataset.GetGeoTransform(t.data()) != CE_None) return std::nullopt;
  // the area of a cell; NaN is not above zero either
  if (std::abs(t[1] * t[5] - t[2] * t[4]) > 0) return t;
  throw InputError(
      fmt::format("{}: its geotransform ({}) gives cells no area, so nothing can be "
                  "placed. Mend it with gdal_edit.py -a_ullr",
                  file, fmt::join(t, ", ")));
}

OGRSpatialReference crs_of(GDALDataset& dataset, const std::string& file,
                           const OpenOptions& options) {
  OGRSpatialReference crs;
  if (options.crs.empty()) {
    if (const OGRSpatialReference* own = dataset.GetSpatialRef()) crs = *own;
    return crs;
  }
  const GdalScope gdal;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (crs.SetFromUserInput(options.crs.c_str()) == OGRERR_NONE) return crs;
  throw InputError(
      fmt::format("{}: the CRS '{}' is not known ({}). Give --crs a code like "
                  "EPSG:4326, or WKT",
                  file, options.crs, gdal.reason()));
}

}  // namespace

RasterFacts examine_raster(GDALDataset& dataset, const std::string& file,
                           const OpenOptions& options) {
  GDALRasterBand& band = choose_band(dataset, file, options.band);
  refuse_unusable(dataset, band, file);
  RasterFacts facts;
  facts.shape = {dataset.GetRasterXSize(), dataset.GetRasterYSize()};
  facts.geotransform = geotransform_of(dataset, file);
  facts.crs = crs_of(dataset, file, options);
  const ChosenUnit unit = choose_unit(band, facts.crs, file, options);
  facts.conversion.scale = band.GetScale();
  facts.conversion.offset = band.GetOffset();
  facts.conversion.metres_per_unit = metres_per_unit(unit.unit);

  int block_columns = 1;
  int block_rows = 1;
  band.GetBlockSize(&block_columns, &block_rows);
  DemDescription& about = facts.description;
  about.files = {file};
  about.format = dataset.GetDriverName();
  about.band = band.GetBand();
  about.band_count = dataset.GetRasterCount();
  about.data_type = GDALGetDataTypeName(band.GetRasterDataType());
  about.scale = facts.conversion.scale;
  about.offset = facts.conversion.offset;
  about.vertical_unit = unit.unit;
  about.vertical_unit_origin = unit.origin;
  about.block_columns = block_columns;
  about.block_rows = block_rows;
  add_nodata(facts, band, file, options);
  return facts;
}

}  // namespace terrane::ingest
