#include "ingest/warp_heights.h"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/geographic_inverse.h"
#include "ingest/height_dataset.h"

namespace terrane::ingest {
namespace {

/// Longitudes and latitudes to columns and rows of a DEM.
class SourcePlace {
 public:
  SourcePlace(const Dem& dem, const GridExtent& extent) : extent_(extent) {
    if (extent.is_affine) return;
    inverse_.emplace(dem.place(), dem.heights().shape());
  }

  std::vector<PlanPosition> to_grid(const std::vector<PlanPosition>& lon_lat) const {
    if (extent_.is_affine) {
      std::vector<PlanPosition> result;
      result.reserve(lon_lat.size());
      for (const PlanPosition& at : lon_lat) result.push_back(affine(at));
      return result;
    }
    // Newton's method needs places near the DEM: others are put far away from it
    std::vector<PlanPosition> result(lon_lat.size(), {kFarAway, kFarAway});
    std::vector<PlanPosition> near;
    std::vector<std::size_t> number;
    const GeographicArea& area = inverse_->area();
    for (std::size_t i = 0; i < lon_lat.size(); ++i) {
      const double x = inverse_->unwrapped(lon_lat[i].x), y = lon_lat[i].y;
      if (x < area.west_deg || x > area.east_deg || y < area.south_deg || y > area.north_deg) {
        continue;
      }
      near.push_back({x, y});
      number.push_back(i);
    }
    if (near.empty()) return result;
    const std::vector<PlanPosition> found = inverse_->to_grid(near);
    for (std::size_t i = 0; i < near.size(); ++i) result[number[i]] = found[i];
    return result;
  }

 private:
  static constexpr double kFarAway = -1e6;

  PlanPosition affine(const PlanPosition& at) const {
    const double east_deg = std::remainder(at.x - extent_.middle.longitude_deg, 360.0);
    return {extent_.middle_column + east_deg / extent_.column_deg,
            extent_.middle_row + (at.y - extent_.middle.latitude_deg) / extent_.row_deg};
  }

  const GridExtent& extent_;
  std::optional<GeographicInverse> inverse_;
};

/// What GDAL's warper asks: where a pixel of the new raster lies in the DEM.
struct Transform {
  const WarpTarget& target;
  const SourcePlace& source;
  int first_column;

  static int call(void* self, int to_source, int count, double* x, double* y, double* /*z*/,
                  int* is_done) {
    std::fill_n(is_done, count, to_source);
    if (!to_source) return FALSE;
    const Transform& t = *static_cast<const Transform*>(self);
    std::vector<PlanPosition> places;
    for (int i = 0; i < count; ++i) {
      const LonLat at = t.target.place(x[i], y[i]);
      places.push_back({at.longitude_deg, at.latitude_deg});
    }
    const std::vector<PlanPosition> at = t.source.to_grid(places);
    for (int i = 0; i < count; ++i) {
      // pixels are areas to GDAL: their middles are the samples
      x[i] = at[i].x + 0.5 + t.first_column;
      y[i] = at[i].y + 0.5;
    }
    return TRUE;
  }
};

GDALDatasetUniquePtr create_file(const std::filesystem::path& file, const WarpTarget& target,
                                 const GdalScope& gdal) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* const options[] = {"TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE", "BIGTIFF=YES",
                                 nullptr};
  GDALDatasetUniquePtr dataset(driver->Create(file.c_str(), static_cast<int>(target.columns),
                                              static_cast<int>(target.rows), 1, GDT_Float32,
                                              const_cast<char**>(options)));
  if (!dataset) {
    throw OutputError(fmt::format("{}: cannot be written ({}). Choose another output folder",
                                  file.string(), gdal.reason()));
  }
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  return dataset;
}

int CPL_STDCALL advance(double complete, const char* /*message*/, void* to) {
  auto& [progress, steps] = *static_cast<std::pair<Progress*, std::int64_t>*>(to);
  const auto now = static_cast<std::int64_t>(complete * 1000);
  if (now > steps) progress->advance(now - steps);
  steps = std::max(steps, now);
  return TRUE;
}

}  // namespace

GDALDatasetUniquePtr warp_heights(const Dem& dem, const GridExtent& extent,
                                  const WarpTarget& target, const std::filesystem::path& file,
                                  Progress& progress) {
  const GdalScope gdal;
  const SourcePlace source(dem, extent);
  HeightDataset from(dem.heights(), extent.goes_round);
  GDALDatasetUniquePtr to = create_file(file, target, gdal);
  Transform transform{target, source, from.first_column()};
  constexpr double kExact_cells = 0.01;
  void* approximate = extent.is_affine
                          ? nullptr
                          : GDALCreateApproxTransformer(&Transform::call, &transform, kExact_cells);

  const std::unique_ptr<GDALWarpOptions, void (*)(GDALWarpOptions*)> options(
      GDALCreateWarpOptions(), GDALDestroyWarpOptions);
  options->hSrcDS = &from;
  options->hDstDS = to.get();
  options->eResampleAlg = target.method == "average" ? GRA_Average : GRA_Bilinear;
  options->dfWarpMemoryLimit = 64 << 20;
  GDALWarpInitDefaultBandMapping(options.get(), 1);
  GDALWarpInitSrcNoDataReal(options.get(), std::numeric_limits<double>::quiet_NaN());
  GDALWarpInitDstNoDataReal(options.get(), std::numeric_limits<double>::quiet_NaN());
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SAMPLE_GRID", "YES");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SOURCE_EXTRA", "8");
  if (target.method == "bilinear") {
    // else the kernel's width is guessed from each chunk, and differs at the DEM's edges
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "XSCALE", "1");
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "YSCALE", "1");
  }
  options->pfnTransformer = approximate != nullptr ? GDALApproxTransform : &Transform::call;
  options->pTransformerArg = approximate != nullptr ? approximate : &transform;
  progress.begin("resample", 1000);
  std::pair<Progress*, std::int64_t> steps{&progress, 0};
  options->pfnProgress = advance;
  options->pProgressArg = &steps;

  GDALWarpOperation operation;
  const bool is_done = operation.Initialize(options.get()) == CE_None &&
                       operation.ChunkAndWarpImage(0, 0, static_cast<int>(target.columns),
                                                   static_cast<int>(target.rows)) == CE_None;
  if (approximate != nullptr) GDALDestroyApproxTransformer(approximate);
  if (!is_done) {
    throw InputError(fmt::format("{}: cannot be resampled ({})", dem.name(), gdal.reason()));
  }
  return to;
}

}  // namespace terrane::ingest
