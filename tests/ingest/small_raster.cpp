#include "small_raster.h"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>
#include <stdlib.h>

#include <fstream>
#include <stdexcept>

#include "core/errors.h"

namespace terrane::ingest::testing {
namespace {

double counted(int column, int row, int columns) { return row * columns + column; }

void fill(GDALDataset& dataset, const SmallRaster& raster) {
  for (int b = 1; b <= raster.bands; ++b) {
    std::vector<double> values;
    for (int r = 0; r < raster.rows; ++r) {
      for (int c = 0; c < raster.columns; ++c) {
        const double value = raster.value ? raster.value(c, r) : counted(c, r, raster.columns);
        values.push_back(value + 1000 * (b - 1));
      }
    }
    const CPLErr error = dataset.GetRasterBand(b)->RasterIO(
        GF_Write, 0, 0, raster.columns, raster.rows, values.data(), raster.columns, raster.rows,
        GDT_Float64, 0, 0, nullptr);
    if (error != CE_None) throw std::runtime_error("cannot write the test's raster");
  }
}

void set_colours(GDALDataset& dataset, const std::string& colours) {
  if (colours == "rgb") {
    dataset.GetRasterBand(1)->SetColorInterpretation(GCI_RedBand);
    dataset.GetRasterBand(2)->SetColorInterpretation(GCI_GreenBand);
    dataset.GetRasterBand(3)->SetColorInterpretation(GCI_BlueBand);
  } else if (colours == "palette") {
    GDALColorTable table;
    const GDALColorEntry green = {0, 255, 0, 255};
    table.SetColorEntry(0, &green);
    dataset.GetRasterBand(1)->SetColorTable(&table);
  }
}

void set_mask(GDALDataset& dataset, const SmallRaster& raster) {
  if (!raster.masked) return;
  dataset.CreateMaskBand(GMF_PER_DATASET);
  std::vector<unsigned char> mask(static_cast<std::size_t>(raster.columns * raster.rows), 255);
  mask[static_cast<std::size_t>(raster.masked->second * raster.columns + raster.masked->first)] = 0;
  const CPLErr error = dataset.GetRasterBand(1)->GetMaskBand()->RasterIO(
      GF_Write, 0, 0, raster.columns, raster.rows, mask.data(), raster.columns, raster.rows,
      GDT_Byte, 0, 0, nullptr);
  if (error != CE_None) throw std::runtime_error("cannot write the test's mask");
}

void describe(GDALDataset& dataset, const SmallRaster& raster) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (raster.nodata && raster.type == "Int64") {
    band.SetNoDataValueAsInt64(static_cast<std::int64_t>(*raster.nodata));
  } else if (raster.nodata) {
    band.SetNoDataValue(*raster.nodata);
  }
  if (!raster.unit.empty()) band.SetUnitType(raster.unit.c_str());
  if (raster.scale) band.SetScale(*raster.scale);
  if (raster.offset) band.SetOffset(*raster.offset);
  if (raster.geotransform) {
    std::array<double, 6> t = *raster.geotransform;
    dataset.SetGeoTransform(t.data());
  }
  if (!raster.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.SetFromUserInput(raster.crs.c_str()) != OGRERR_NONE) {
      throw std::runtime_error("unknown CRS in a test");
    }
    dataset.SetSpatialRef(&crs);
  }
}

}  // namespace

std::array<double, 6> north_up(double x, double y, double spacing) {
  return {x, spacing, 0, y, 0, -spacing};
}

RasterFolder::RasterFolder() {
  GDALAllRegister();
  std::string name = (std::filesystem::temp_directory_path() / "terrane-XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

RasterFolder::~RasterFolder() { std::filesystem::remove_all(path_); }

std::string RasterFolder::write(const std::string& name, const SmallRaster& raster) const {
  const std::string path = path_of(name);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  char** creation_options = nullptr;
  for (const std::string& option : raster.creation_options) {
    creation_options = CSLAddString(creation_options, option.c_str());
  }
  const GDALDatasetUniquePtr dataset(
      driver->Create(path.c_str(), raster.columns, raster.rows, raster.bands,
                     GDALGetDataTypeByName(raster.type.c_str()), creation_options));
  CSLDestroy(creation_options);
  if (!dataset) throw std::runtime_error("cannot create " + path);
  describe(*dataset, raster);
  set_colours(*dataset, raster.colours);
  fill(*dataset, raster);
  set_mask(*dataset, raster);
  return path;
}

std::string RasterFolder::write_text(const std::string& name, std::string_view text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_of(name);
}

void convert(const std::string& from, const std::string& to,
             const std::vector<std::string>& arguments) {
  char** list = nullptr;
  for (const std::string& argument : arguments) list = CSLAddString(list, argument.c_str());
  GDALTranslateOptions* options = GDALTranslateOptionsNew(list, nullptr);
  CSLDestroy(list);
  const GDALDatasetUniquePtr source(GDALDataset::Open(from.c_str(), GDAL_OF_RASTER));
  const GDALDatasetUniquePtr result(GDALDataset::FromHandle(
      GDALTranslate(to.c_str(), GDALDataset::ToHandle(source.get()), options, nullptr)));
  GDALTranslateOptionsFree(options);
  if (!result) throw std::runtime_error("cannot write " + to);
}

std::unique_ptr<Dem> open_quietly(const std::string& source, const OpenOptions& options) {
  NoProgress progress;
  return open_dem({source}, options, progress);
}

HeightGrid read_all(const Dem& dem) {
  const GridShape shape = dem.heights().shape();
  return dem.heights().read({0, 0, shape.columns, shape.rows});
}

std::string input_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("not an InputError: ") + error.what();
  }
  return "no error";
}

std::string real_dem(const std::string& relative) {
  const std::filesystem::path path = std::filesystem::path(TERRANE_TEST_DATA) / relative;
  return std::filesystem::exists(path) ? path.string() : "";
}

}  // namespace terrane::ingest::testing
