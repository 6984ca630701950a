#include "ingest/mercator_resample.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/grid_extent.h"
#include "ingest/warp_heights.h"

namespace terrane::ingest {
namespace {

constexpr int kMostZoom = 22;
constexpr double kEdge_deg = 85.0511287798066;  // where the square ends

/// Distance of neighbouring samples in the middle of the DEM, the smaller one, as a share of the
/// Earth's circumference in the plane of web mercator.
double spacing_across(const Dem& dem) {
  const GridShape shape = dem.heights().shape();
  const double c = static_cast<double>(shape.columns - 2) / 2;
  const double r = static_cast<double>(shape.rows - 2) / 2;
  const std::array<GridPosition, 3> around{{{c, r}, {c + 1, r}, {c, r + 1}}};
  const std::vector<LonLat> at = dem.place().to_lon_lat(around);
  constexpr MercatorZoom kWhole{.zoom = 0, .tile_px = 1};
  const auto distance = [&](std::size_t k) {
    return std::hypot(std::remainder(at[k].longitude_deg - at[0].longitude_deg, 360.0) / 360,
                      kWhole.row_of(at[k].latitude_deg) - kWhole.row_of(at[0].latitude_deg));
  };
  return std::min(distance(1), distance(2));
}

/// The coarsest zoom whose pixels are no larger than the DEM's cells by more than a tenth.
int fitting_zoom(double spacing, int tile_px) {
  constexpr double kLarger = 1.1;
  int zoom = 0;
  while (zoom < kMostZoom && 1 / MercatorZoom{zoom, tile_px}.pixels_across() > kLarger * spacing) {
    ++zoom;
  }
  return zoom;
}

MercatorTiles tiles_over(const GridExtent& extent, const MercatorZoom& zoom) {
  const double px = zoom.tile_px;
  constexpr double kTouch_px = 1e-6;  // what only touches a border does not reach beyond
  const auto first = [&](double pixels) {
    return static_cast<std::int64_t>(std::floor((pixels + kTouch_px) / px));
  };
  const auto end = [&](double pixels) {
    return static_cast<std::int64_t>(std::ceil((pixels - kTouch_px) / px));
  };
  const std::int64_t across = zoom.tiles_across();
  const double north_deg = std::min(extent.area.north_deg, kEdge_deg);
  const double south_deg = std::max(extent.area.south_deg, -kEdge_deg);
  MercatorTiles tiles{.zoom = zoom.zoom,
                      .x = first(zoom.column_of(extent.area.west_deg)),
                      .y = std::clamp<std::int64_t>(first(zoom.row_of(north_deg)), 0, across - 1)};
  tiles.columns = std::max<std::int64_t>(1, end(zoom.column_of(extent.area.east_deg)) - tiles.x);
  tiles.rows = std::clamp<std::int64_t>(end(zoom.row_of(south_deg)) - tiles.y, 1, across - tiles.y);
  if (extent.goes_round || tiles.columns >= across) {
    tiles.x = 0;
    tiles.columns = across;
  }
  return tiles;
}

class MercatorFile final : public MercatorHeights {
 public:
  MercatorFile(const MercatorPlan& plan, const std::filesystem::path& file)
      : plan_(plan), file_(file) {
    const GdalScope gdal;
    dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (!dataset_) throw_unreadable(gdal);
  }
  ~MercatorFile() override {
    const GdalScope gdal;
    dataset_.reset();
  }

  int tile_px() const override { return plan_.tile_px; }
  MercatorTiles tiles() const override { return plan_.tiles; }

  std::vector<float> read(std::int64_t x, std::int64_t y) const override {
    const GdalScope gdal;
    const int px = plan_.tile_px;
    const auto left = static_cast<int>((x - plan_.tiles.x) * px);
    const auto top = static_cast<int>((y - plan_.tiles.y) * px);
    std::vector<float> heights(static_cast<std::size_t>(px) * static_cast<std::size_t>(px));
    if (dataset_->GetRasterBand(1)->RasterIO(GF_Read, left, top, px, px, heights.data(), px, px,
                                             GDT_Float32, 0, 0, nullptr) != CE_None) {
      throw_unreadable(gdal);
    }
    return heights;
  }

 private:
  [[noreturn]] void throw_unreadable(const GdalScope& gdal) const {
    throw InputError(
        fmt::format("{}: cannot be read ({}). Build again", file_.string(), gdal.reason()));
  }

  MercatorPlan plan_;
  std::filesystem::path file_;
  GDALDatasetUniquePtr dataset_;
};

}  // namespace

MercatorPlan plan_mercator(const Dem& dem, const MercatorOptions& options) {
  if (dem.place().crs_wkt().empty()) {
    throw InputError(
        fmt::format("{}: has no CRS, so it has no place on a map. Name it with --crs", dem.name()));
  }
  if (options.zoom && (*options.zoom < 0 || *options.zoom > kMostZoom)) {
    throw ConfigError(fmt::format("--max-zoom {}: must be from 0 to {}", *options.zoom, kMostZoom));
  }
  const GridExtent extent = extent_of(dem);
  if (extent.area.south_deg >= kEdge_deg || extent.area.north_deg <= -kEdge_deg) {
    throw InputError(fmt::format(
        "{}: lies beyond 85 degrees, where web mercator ends. Use --scheme geodetic", dem.name()));
  }
  const int fitting = fitting_zoom(spacing_across(dem), options.tile_px);
  const MercatorZoom zoom{options.zoom.value_or(fitting), options.tile_px};
  MercatorPlan plan{.tiles = tiles_over(extent, zoom),
                    .tile_px = options.tile_px,
                    .method = zoom.zoom < fitting ? "average" : "bilinear",
                    .west_deg = extent.area.west_deg,
                    .south_deg = std::max(extent.area.south_deg, -kEdge_deg),
                    .east_deg = extent.area.east_deg,
                    .north_deg = std::min(extent.area.north_deg, kEdge_deg)};
  if (std::max(plan.tiles.columns, plan.tiles.rows) >
      std::numeric_limits<int>::max() / options.tile_px) {
    throw ConfigError(
        fmt::format("--max-zoom {}: is too fine for a DEM of that extent", zoom.zoom));
  }
  return plan;
}

std::unique_ptr<MercatorHeights> resample_to_mercator(const Dem& dem, const MercatorPlan& plan,
                                                      const std::filesystem::path& file,
                                                      Progress& progress) {
  const MercatorZoom zoom{plan.tiles.zoom, plan.tile_px};
  const auto left = static_cast<double>(plan.tiles.x * plan.tile_px);
  const auto top = static_cast<double>(plan.tiles.y * plan.tile_px);
  const WarpTarget target{
      .columns = plan.tiles.columns * plan.tile_px,
      .rows = plan.tiles.rows * plan.tile_px,
      .place = [&](double column, double row) { return zoom.at(left + column, top + row); },
      .method = plan.method};
  {
    const GdalScope gdal;
    warp_heights(dem, extent_of(dem), target, file, progress);  // written when it is closed
  }
  return std::make_unique<MercatorFile>(plan, file);
}

}  // namespace terrane::ingest
