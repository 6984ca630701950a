#include "ingest/resample.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "ingest/dem_samples.h"
#include "ingest/fill_beside.h"
#include "ingest/fit_posts.h"
#include "ingest/gdal_scope.h"
#include "ingest/grid_extent.h"
#include "ingest/warp_heights.h"

namespace terrane::ingest {
namespace {

// voids up to twice as wide are interpolated
constexpr int kKeptCells = 32;

/// The coarsest zoom whose cells are no larger than the DEM's by more than a tenth.
int fitting_zoom(double spacing_deg) {
  constexpr double kLarger = 1.1;
  int zoom = 0;
  while (zoom < kFinestZoom && GeodeticZoom{zoom}.cell_deg() > kLarger * spacing_deg) ++zoom;
  return zoom;
}

GeodeticTiles tiles_over(const GridExtent& extent, int zoom) {
  const GeodeticZoom of{zoom};
  constexpr double kTouch = 1e-9;  // of a tile: what only touches a border does not reach beyond
  const auto first = [&](double deg) {
    return static_cast<std::int64_t>(std::floor(deg / of.tile_deg() + kTouch));
  };
  const auto end = [&](double deg) {
    return static_cast<std::int64_t>(std::ceil(deg / of.tile_deg() - kTouch));
  };
  GeodeticTiles tiles{
      .zoom = zoom,
      .x = first(extent.area.west_deg + 180),
      .y = std::clamp<std::int64_t>(first(90 - extent.area.north_deg), 0, of.tiles_down() - 1)};
  tiles.columns = std::max<std::int64_t>(1, end(extent.area.east_deg + 180) - tiles.x);
  tiles.rows = std::clamp<std::int64_t>(end(90 - extent.area.south_deg) - tiles.y, 1,
                                        of.tiles_down() - tiles.y);
  if (extent.goes_round || tiles.columns >= of.tiles_around() || tiles.at(0).columns > 2) {
    // from where the DEM begins, if that is a root's border, so that the seam is where its own is
    const std::int64_t half = of.tiles_around() / 2;
    tiles.x = tiles.x % half == 0 ? tiles.x : 0;
    tiles.columns = of.tiles_around();
  }
  return tiles;
}

/// As many cells as the heights fall by from the DEM to what fills the rest, so that the slope is 1
/// at most, if that is not too many.
int ramp_cells(const HeightStatistics& statistics, double fill_m, int zoom) {
  constexpr double kCircumference_m = 40075017, kFewest = 16, kMost = 1024;
  const double fall_m = std::max(std::abs(statistics.max_height_m - fill_m),
                                 std::abs(statistics.min_height_m - fill_m));
  const double cell_m = kCircumference_m * GeodeticZoom{zoom}.cell_deg() / 360;
  return static_cast<int>(std::clamp(std::ceil(fall_m / cell_m), kFewest, kMost));
}

/// The posts of the tiles and of what goes on beside them.
Window posts_with_ramp(const Resampling& plan) {
  Window posts = plan.tiles.posts();
  const std::int64_t margin = kKeptCells + plan.ramp_cells + 1;
  const GeodeticZoom zoom{plan.tiles.zoom};
  const std::int64_t around = zoom.tiles_around() * kGeodeticTileCells;
  const std::int64_t last_row = zoom.tiles_down() * kGeodeticTileCells;
  const std::int64_t bottom = std::min(posts.row + posts.rows - 1 + margin, last_row);
  posts.row = std::max<std::int64_t>(0, posts.row - margin);
  posts.rows = bottom - posts.row + 1;
  if (posts.columns + 2 * margin > around) {
    posts.columns = around + 1;
    return posts;
  }
  posts.column -= margin;
  posts.columns += 2 * margin;
  return posts;
}

bool has_data(GDALRasterBand& band) {
  std::vector<float> row(static_cast<std::size_t>(band.GetXSize()));
  for (int r = 0; r < band.GetYSize(); ++r) {
    if (band.RasterIO(GF_Read, 0, r, band.GetXSize(), 1, row.data(), band.GetXSize(), 1,
                      GDT_Float32, 0, 0, nullptr) != CE_None) {
      return false;
    }
    if (!std::ranges::all_of(row, [](float h) { return std::isnan(h); })) return true;
  }
  return false;
}

void warp(const Dem& dem, const Resampling& plan, const ResampleOptions& asked,
          const std::filesystem::path& file, Progress& progress) {
  const GdalScope gdal;
  const GeodeticZoom zoom{plan.tiles.zoom};
  const WarpTarget target{
      .columns = plan.posts.columns,
      .rows = plan.posts.rows,
      .place =
          [&](double column, double row) {
            // posts are in the middles of pixels
            return LonLat{
                -180 + (static_cast<double>(plan.posts.column) + column - 0.5) * zoom.cell_deg(),
                90 - (static_cast<double>(plan.posts.row) + row - 0.5) * zoom.cell_deg()};
          },
      .method = plan.method};
  const GDALDatasetUniquePtr to = warp_heights(dem, extent_of(dem), target, file, progress);
  if (!has_data(*to->GetRasterBand(1))) {
    throw InputError(fmt::format("{}: no post of zoom {} gets a height. Use a larger --max-zoom",
                                 dem.name(), plan.tiles.zoom));
  }
  if (!fill_beside(
          *to->GetRasterBand(1),
          {.fill_m = asked.fill_m, .kept_cells = kKeptCells, .ramp_cells = plan.ramp_cells})) {
    throw InputError(fmt::format("{}: its voids cannot be filled ({})", dem.name(), gdal.reason()));
  }
  if (plan.method == "bilinear" && std::isfinite(asked.fit_to_m)) {
    fit_posts(*to->GetRasterBand(1), plan.posts, DemSamples(dem, plan.tiles.zoom, nullptr),
              plan.tiles.zoom, asked.fit_to_m);
  }
}

/// Heights from the file, raised to the ellipsoid, and what fills the rest of the Earth.
class ResampledHeights final : public GeodeticHeights {
 public:
  ResampledHeights(const Dem& dem, const Resampling& plan, const ResampleOptions& options,
                   const std::filesystem::path& file)
      : tiles_(plan.tiles),
        posts_(plan.posts),
        options_(options),
        file_(file),
        samples_(dem, plan.tiles.zoom, options.geoid) {
    const GdalScope gdal;
    dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (!dataset_) throw_unreadable(gdal);
  }
  ~ResampledHeights() override {
    const GdalScope gdal;
    dataset_.reset();
  }

  GeodeticTiles tiles() const override { return tiles_; }
  std::vector<LooseSample> dem_samples(const Window& posts) const override {
    return samples_.in(posts);
  }
  double min_height_m() const override { return min_m_; }
  double max_height_m() const override { return max_m_; }

  void find_bounds() {
    min_m_ = INFINITY;
    max_m_ = -INFINITY;
    constexpr std::int64_t kRows = 64;
    for (std::int64_t row = 0; row < posts_.rows; row += kRows) {
      const HeightGrid grid = read(tiles_.zoom, {posts_.column, posts_.row + row, posts_.columns,
                                                 std::min(kRows, posts_.rows - row)});
      for (const float height : grid.heights_m) {
        min_m_ = std::min(min_m_, double{height});
        max_m_ = std::max(max_m_, double{height});
      }
    }
    // sea level where the rest of the Earth is filled with it: geoids are between these
    constexpr double kLowestGeoid_m = -110, kHighestGeoid_m = 90;
    const bool has_geoid = options_.geoid != nullptr;
    min_m_ = std::min(min_m_, options_.fill_m + (has_geoid ? kLowestGeoid_m : 0));
    max_m_ = std::max(max_m_, options_.fill_m + (has_geoid ? kHighestGeoid_m : 0));
  }

  HeightGrid read(int zoom, const Window& window) const override {
    const std::int64_t every = std::int64_t{1} << (tiles_.zoom - zoom);
    const std::int64_t around = GeodeticZoom{tiles_.zoom}.tiles_around() * kGeodeticTileCells;
    HeightGrid grid{window, std::vector<float>(
                                static_cast<std::size_t>(window.columns * window.rows), kNoHeight)};
    for (std::int64_t column = 0; column < window.columns;) {
      const std::int64_t beyond = (window.column + column) * every - posts_.column;
      const std::int64_t from = (beyond % around + around) % around;
      const std::int64_t end = from < posts_.columns ? posts_.columns : around;
      const std::int64_t count =
          std::min((end - from + every - 1) / every, window.columns - column);
      if (from < posts_.columns) read_columns(window, every, column, count, from, grid);
      column += count;
    }
    raise(zoom, grid);
    return grid;
  }

 private:
  [[noreturn]] void throw_unreadable(const GdalScope& gdal) const {
    throw InputError(
        fmt::format("{}: cannot be read ({}). Build again", file_.string(), gdal.reason()));
  }

  /// \param part  of the file.
  void read_file(const Window& part, float* to, std::int64_t columns_in_line) const {
    const GdalScope gdal;
    if (dataset_->GetRasterBand(1)->RasterIO(
            GF_Read, static_cast<int>(part.column), static_cast<int>(part.row),
            static_cast<int>(part.columns), static_cast<int>(part.rows), to,
            static_cast<int>(part.columns), static_cast<int>(part.rows), GDT_Float32, 0,
            columns_in_line * static_cast<GSpacing>(sizeof(float)), nullptr) != CE_None) {
      throw_unreadable(gdal);
    }
  }

  /// Some columns of a window, from column \p from of the file on.
  void read_columns(const Window& window, std::int64_t every, std::int64_t column,
                    std::int64_t count, std::int64_t from, HeightGrid& grid) const {
    const auto in_file = [&](std::int64_t row) { return (window.row + row) * every - posts_.row; };
    std::int64_t first = 0, end = window.rows;
    while (first < end && in_file(first) < 0) ++first;
    while (end > first && in_file(end - 1) >= posts_.rows) --end;
    if (first == end) return;
    if (every == 1) {
      read_file({from, in_file(first), count, end - first},
                grid.heights_m.data() + first * window.columns + column, window.columns);
      return;
    }
    std::vector<float> line(static_cast<std::size_t>((count - 1) * every + 1));
    for (std::int64_t row = first; row < end; ++row) {
      const auto length = static_cast<std::int64_t>(line.size());
      read_file({from, in_file(row), length, 1}, line.data(), length);
      for (std::int64_t i = 0; i < count; ++i) {
        grid.heights_m[static_cast<std::size_t>(row * window.columns + column + i)] =
            line[static_cast<std::size_t>(i * every)];
      }
    }
  }

  void raise(int zoom, HeightGrid& grid) const {
    const GeodeticZoom of{zoom};
    const Window& window = grid.window;
    for (std::int64_t row = 0; row < window.rows; ++row) {
      for (std::int64_t column = 0; column < window.columns; ++column) {
        float& height = grid.heights_m[static_cast<std::size_t>(row * window.columns + column)];
        double over_m = std::isnan(height) ? options_.fill_m : height;
        if (options_.geoid != nullptr) {
          over_m += options_.geoid->undulation_m(of.at({static_cast<double>(window.column + column),
                                                        static_cast<double>(window.row + row)}));
        }
        height = static_cast<float>(over_m);
      }
    }
  }

  GeodeticTiles tiles_;
  Window posts_;
  ResampleOptions options_;
  std::filesystem::path file_;
  DemSamples samples_;
  GDALDatasetUniquePtr dataset_;
  double min_m_ = 0, max_m_ = 0;
};

}  // namespace

Resampling plan_resampling(const Dem& dem, const HeightStatistics& statistics,
                           const ResampleOptions& options) {
  if (dem.place().crs_wkt().empty()) {
    throw InputError(fmt::format(
        "{}: has no CRS, so it has no place in the geodetic quadtree. Name it with --crs",
        dem.name()));
  }
  if (options.zoom && (*options.zoom < 0 || *options.zoom > kFinestZoom)) {
    throw ConfigError(
        fmt::format("--max-zoom {}: must be from 0 to {}", *options.zoom, kFinestZoom));
  }
  const GridExtent extent = extent_of(dem);
  const int fitting = fitting_zoom(extent.spacing_deg);
  const int zoom = options.zoom.value_or(fitting);
  Resampling plan{.tiles = tiles_over(extent, zoom),
                  .method = zoom < fitting ? "average" : "bilinear"};
  plan.ramp_cells = ramp_cells(statistics, options.fill_m, zoom);
  plan.posts = posts_with_ramp(plan);
  return plan;
}

std::unique_ptr<GeodeticHeights> resample(const Dem& dem, const Resampling& plan,
                                          const ResampleOptions& options,
                                          const std::filesystem::path& file, Progress& progress) {
  warp(dem, plan, options, file, progress);
  auto heights = std::make_unique<ResampledHeights>(dem, plan, options, file);
  heights->find_bounds();
  return heights;
}

}  // namespace terrane::ingest
