#include "ingest/resample.h"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "ingest/dem_samples.h"
#include "ingest/fill_beside.h"
#include "ingest/fit_posts.h"
#include "ingest/gdal_scope.h"
#include "ingest/geographic_inverse.h"
#include "ingest/grid_extent.h"
#include "ingest/height_dataset.h"

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

/// What GDAL's warper asks: where a pixel of the posts lies in the DEM.
struct Transform {
  GeodeticZoom zoom;
  Window posts;
  const SourcePlace& source;
  int first_column;

  static int call(void* self, int to_source, int count, double* x, double* y, double* /*z*/,
                  int* is_done) {
    std::fill_n(is_done, count, to_source);
    if (!to_source) return FALSE;
    const Transform& t = *static_cast<const Transform*>(self);
    std::vector<PlanPosition> places;
    for (int i = 0; i < count; ++i) {
      // pixels are areas to GDAL: their middles are the posts
      places.push_back(
          {-180 + (static_cast<double>(t.posts.column) + x[i] - 0.5) * t.zoom.cell_deg(),
           90 - (static_cast<double>(t.posts.row) + y[i] - 0.5) * t.zoom.cell_deg()});
    }
    const std::vector<PlanPosition> at = t.source.to_grid(places);
    for (int i = 0; i < count; ++i) {
      x[i] = at[i].x + 0.5 + t.first_column;
      y[i] = at[i].y + 0.5;
    }
    return TRUE;
  }
};

GDALDatasetUniquePtr create_file(const std::filesystem::path& file, const Window& posts,
                                 const GdalScope& gdal) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const char* const options[] = {"TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE", "BIGTIFF=YES",
                                 nullptr};
  GDALDatasetUniquePtr dataset(driver->Create(file.c_str(), static_cast<int>(posts.columns),
                                              static_cast<int>(posts.rows), 1, GDT_Float32,
                                              const_cast<char**>(options)));
  if (!dataset) {
    throw OutputError(fmt::format("{}: cannot be written ({}). Choose another output folder",
                                  file.string(), gdal.reason()));
  }
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  return dataset;
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

int CPL_STDCALL advance(double complete, const char* /*message*/, void* to) {
  auto& [progress, steps] = *static_cast<std::pair<Progress*, std::int64_t>*>(to);
  const auto now = static_cast<std::int64_t>(complete * 1000);
  if (now > steps) progress->advance(now - steps);
  steps = std::max(steps, now);
  return TRUE;
}

void warp(const Dem& dem, const Resampling& plan, const ResampleOptions& asked,
          const std::filesystem::path& file, Progress& progress) {
  const GdalScope gdal;
  const GridExtent extent = extent_of(dem);
  const SourcePlace source(dem, extent);
  HeightDataset from(dem.heights(), extent.goes_round);
  const Window posts = plan.posts;
  const GDALDatasetUniquePtr to = create_file(file, posts, gdal);
  Transform transform{{plan.tiles.zoom}, posts, source, from.first_column()};
  constexpr double kExact_cells = 0.01;
  void* approximate = extent.is_affine
                          ? nullptr
                          : GDALCreateApproxTransformer(&Transform::call, &transform, kExact_cells);

  const std::unique_ptr<GDALWarpOptions, void (*)(GDALWarpOptions*)> options(
      GDALCreateWarpOptions(), GDALDestroyWarpOptions);
  options->hSrcDS = &from;
  options->hDstDS = to.get();
  options->eResampleAlg = plan.method == "average" ? GRA_Average : GRA_Bilinear;
  options->dfWarpMemoryLimit = 64 << 20;
  GDALWarpInitDefaultBandMapping(options.get(), 1);
  GDALWarpInitSrcNoDataReal(options.get(), std::numeric_limits<double>::quiet_NaN());
  GDALWarpInitDstNoDataReal(options.get(), std::numeric_limits<double>::quiet_NaN());
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SAMPLE_GRID", "YES");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SOURCE_EXTRA", "8");
  if (plan.method == "bilinear") {
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
                       operation.ChunkAndWarpImage(0, 0, static_cast<int>(posts.columns),
                                                   static_cast<int>(posts.rows)) == CE_None;
  if (approximate != nullptr) GDALDestroyApproxTransformer(approximate);
  if (!is_done) {
    throw InputError(fmt::format("{}: cannot be resampled ({})", dem.name(), gdal.reason()));
  }
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
    fit_posts(*to->GetRasterBand(1), posts, DemSamples(dem, plan.tiles.zoom, nullptr),
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
