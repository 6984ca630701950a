#include "ingest/fill_beside.h"

#include <cpl_string.h>
#include <gdal_alg.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace terrane::ingest {
namespace {

bool read_row(GDALRasterBand& band, int row, std::vector<float>& values) {
  const int columns = band.GetXSize();
  return band.RasterIO(GF_Read, 0, row, columns, 1, values.data(), columns, 1, GDT_Float32, 0, 0,
                       nullptr) == CE_None;
}

bool write_row(GDALRasterBand& band, int row, std::vector<float>& values) {
  const int columns = band.GetXSize();
  return band.RasterIO(GF_Write, 0, row, columns, 1, values.data(), columns, 1, GDT_Float32, 0, 0,
                       nullptr) == CE_None;
}

GDALDatasetUniquePtr raster_in_memory(const GDALRasterBand& like, GDALDataType type) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  auto& band = const_cast<GDALRasterBand&>(like);  // GDAL's getters are not const
  return GDALDatasetUniquePtr(
      driver->Create("", band.GetXSize(), band.GetYSize(), 1, type, nullptr));
}

/// Distances to the nearest data in cells, as far as it matters; null if GDAL fails.
GDALDatasetUniquePtr distances(GDALRasterBand& heights, int most_cells) {
  GDALDatasetUniquePtr has_data = raster_in_memory(heights, GDT_Byte);
  GDALDatasetUniquePtr result = raster_in_memory(heights, GDT_Float32);
  if (!has_data || !result) return nullptr;
  std::vector<float> row(static_cast<std::size_t>(heights.GetXSize()));
  for (int r = 0; r < heights.GetYSize(); ++r) {
    if (!read_row(heights, r, row)) return nullptr;
    std::ranges::transform(row, row.begin(), [](float h) { return std::isnan(h) ? 0.0F : 1.0F; });
    if (!write_row(*has_data->GetRasterBand(1), r, row)) return nullptr;
  }
  const std::string most = "MAXDIST=" + std::to_string(most_cells + 1);
  const char* const options[] = {most.c_str(), "DISTUNITS=PIXEL", "VALUES=1", "NODATA=-1", nullptr};
  const bool is_done =
      GDALComputeProximity(has_data->GetRasterBand(1), result->GetRasterBand(1),
                           const_cast<char**>(options), nullptr, nullptr) == CE_None;
  return is_done ? std::move(result) : nullptr;
}

}  // namespace

bool fill_beside(GDALRasterBand& heights, const BesideOptions& options) {
  const int reach = options.kept_cells + options.ramp_cells;
  const GDALDatasetUniquePtr distance = distances(heights, reach);
  if (!distance) return false;
  constexpr int kSmoothings = 20;  // else what comes from different rims meets in steps
  const char* const in_memory[] = {"TEMP_FILE_DRIVER=MEM", nullptr};
  if (GDALFillNodata(&heights, nullptr, reach + 1, 0, kSmoothings, const_cast<char**>(in_memory),
                     nullptr, nullptr) != CE_None) {
    return false;
  }
  const auto kept_cells = static_cast<float>(options.kept_cells);
  std::vector<float> row(static_cast<std::size_t>(heights.GetXSize())), cells(row);
  for (int r = 0; r < heights.GetYSize(); ++r) {
    if (!read_row(heights, r, row) || !read_row(*distance->GetRasterBand(1), r, cells))
      return false;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (std::isnan(row[c]) || (cells[c] >= 0 && cells[c] <= kept_cells)) continue;
      const double beyond =
          cells[c] < 0 ? options.ramp_cells : double{cells[c]} - options.kept_cells;
      const double share = std::clamp(1 - beyond / options.ramp_cells, 0.0, 1.0);
      row[c] = static_cast<float>(options.fill_m + share * (row[c] - options.fill_m));
    }
    if (!write_row(heights, r, row)) return false;
  }
  return true;
}

}  // namespace terrane::ingest
