#include "ingest/raster_file.h"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <utility>

#include "core/errors.h"

namespace terrane::ingest {
namespace {

bool looks_like_a_path(const std::string& file) {
  return file.find(':') == std::string::npos && file.find('<') == std::string::npos;
}

GDALDatasetUniquePtr open_dataset(const std::string& file, const GdalScope& gdal) {
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset) return dataset;
  VSIStatBufL status;
  if (looks_like_a_path(file) && VSIStatL(file.c_str(), &status) != 0) {
    throw InputError(fmt::format("{}: no such file. Check the path", file));
  }
  throw InputError(
      fmt::format("{}: not a raster that GDAL can read ({}). `gdalinfo --formats` "
                  "lists what it can",
                  file, gdal.reason()));
}

// false if GDAL fails
template <typename Sample>
bool read_samples(GDALRasterBand& band, const Window& window, GDALDataType type,
                  std::vector<Sample>& samples) {
  samples.resize(static_cast<std::size_t>(window.columns * window.rows));
  return band.RasterIO(GF_Read, static_cast<int>(window.column), static_cast<int>(window.row),
                       static_cast<int>(window.columns), static_cast<int>(window.rows),
                       samples.data(), static_cast<int>(window.columns),
                       static_cast<int>(window.rows), type, 0, 0, nullptr) == CE_None;
}

[[noreturn]] void throw_unreadable(const std::string& file, const Window& window,
                                   const GdalScope& gdal) {
  throw InputError(
      fmt::format("{}: cannot read columns {} to {}, rows {} to {} ({}). The file may "
                  "be cut short or damaged; get it again",
                  file, window.column, window.column + window.columns - 1, window.row,
                  window.row + window.rows - 1, gdal.reason()));
}

}  // namespace

RasterFile::RasterFile(const std::string& file, const OpenOptions& options) : file_(file) {
  const GdalScope gdal;
  // not the member yet: that one would be closed outside of the scope if the file is refused
  GDALDatasetUniquePtr dataset = open_dataset(file, gdal);
  facts_ = examine_raster(*dataset, file, options);
  dataset_ = std::move(dataset);
}

RasterFile::~RasterFile() { close(); }

GDALRasterBand& RasterFile::open_band(const GdalScope& gdal) const {
  if (!dataset_) dataset_ = open_dataset(file_, gdal);
  return *dataset_->GetRasterBand(facts_.description.band);
}

HeightGrid RasterFile::read(const Window& window) const {
  std::vector<double> stored;
  std::vector<unsigned char> mask;
  {
    const GdalScope gdal;
    GDALRasterBand& band = open_band(gdal);
    if (!read_samples(band, window, GDT_Float64, stored)) throw_unreadable(file_, window, gdal);
    if (facts_.has_mask && !read_samples(*band.GetMaskBand(), window, GDT_Byte, mask)) {
      throw_unreadable(file_, window, gdal);
    }
  }
  HeightGrid grid{window, std::vector<float>(stored.size())};
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const bool is_masked = !mask.empty() && mask[i] == 0;
    grid.heights_m[i] = is_masked ? kNoHeight : facts_.conversion.height_m(stored[i]);
  }
  return grid;
}

void RasterFile::close() const {
  const GdalScope gdal;
  dataset_.reset();
}

}  // namespace terrane::ingest
