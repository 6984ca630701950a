#include "ingest/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ingest/dem_samples.h"
#include "ingest/post_surface.h"
#include "ingest/resampling_error.h"
#include "ingest/scan.h"
#include "tests/ingest/small_raster.h"

namespace terrane::ingest {
namespace {

using testing::north_up;
using testing::open_quietly;
using testing::RasterFolder;
using testing::SmallRaster;

class ResampleTest : public ::testing::Test {
 protected:
  std::unique_ptr<GeodeticHeights> resampled(const std::string& dem, ResampleOptions options = {}) {
    dem_ = open_quietly(dem);
    NoProgress progress;
    plan_ = plan_resampling(*dem_, scan_heights(*dem_, progress), options);
    return resample(*dem_, plan_, options, folder_.path_of("posts.tif"), progress);
  }

  /// The height at a post of the finest zoom that stands at a place.
  float at(const GeodeticHeights& heights, const LonLat& place) const {
    const double cell_deg = GeodeticZoom{plan_.tiles.zoom}.cell_deg();
    const auto column = std::llround((place.longitude_deg + 180) / cell_deg);
    const auto row = std::llround((90 - place.latitude_deg) / cell_deg);
    return heights.read(plan_.tiles.zoom, {column, row, 1, 1}).heights_m.front();
  }

  RasterFolder folder_;
  std::unique_ptr<Dem> dem_;
  Resampling plan_;
};

/// A plane over longitudes and latitudes, sampled every 1/64 degree from (8, 47) on.
SmallRaster plane() {
  return {.columns = 129,
          .rows = 129,
          .value = [](int column, int row) { return 1000 + 10.0 * column - 4.0 * row; },
          .geotransform = north_up(8 - 0.5 / 64, 47 + 0.5 / 64, 1.0 / 64),
          .crs = "EPSG:4326"};
}

TEST_F(ResampleTest, APlaneStaysWhereItIsWithoutAHalfCellsShift) {
  const auto heights = resampled(folder_.write("plane.tif", plane()));
  EXPECT_EQ(plan_.method, "bilinear");
  // cells of 180 / 64 / 2^8 degrees are the coarsest below 1.1 / 64
  EXPECT_EQ(plan_.tiles.zoom, 8);
  const double cell_deg = GeodeticZoom{8}.cell_deg();
  for (int k = 10; k < 100; k += 9) {
    const LonLat place{9 + (k - 50) * cell_deg / 2 * 2 - std::fmod(9 + 180, cell_deg),
                       46 + (50 - k) * cell_deg - std::fmod(46 + 90, cell_deg)};
    const double expected =
        1000 + 640 * (place.longitude_deg - 8) - 256 * (47 - place.latitude_deg);
    EXPECT_NEAR(at(*heights, place), expected, 0.01);
  }
}

TEST_F(ResampleTest, CoarserZoomsHaveThePostsOfTheFinest) {
  const auto heights = resampled(folder_.write("plane.tif", plane()));
  const Window fine = plan_.tiles.posts();
  const HeightGrid coarse = heights->read(6, {fine.column / 4, fine.row / 4, 9, 9});
  for (std::int64_t row = 0; row < 9; ++row) {
    for (std::int64_t column = 0; column < 9; ++column) {
      const Window post{(fine.column / 4 + column) * 4, (fine.row / 4 + row) * 4, 1, 1};
      EXPECT_EQ(coarse.at(coarse.window.column + column, coarse.window.row + row),
                heights->read(8, post).heights_m.front());
    }
  }
}

TEST_F(ResampleTest, ThereIsAHeightEverywhereOnEarth) {
  const auto heights = resampled(folder_.write("plane.tif", plane()), {.fill_m = -7});
  EXPECT_EQ(at(*heights, {-120, -33.75}), -7);
  EXPECT_EQ(heights->read(0, {0, 0, 129, 65}).heights_m.front(), -7);
  // no wall at the edge: the plane's corner goes on for a while
  EXPECT_NEAR(at(*heights, {7.9, 47.1}), 1000, 30);
}

TEST_F(ResampleTest, SmallVoidsAreInterpolated) {
  SmallRaster raster = plane();
  const auto whole = raster.value;
  raster.value = [whole](int column, int row) {
    return std::hypot(column - 64, row - 64) < 4 ? -9999 : whole(column, row);
  };
  raster.nodata = -9999;
  const auto heights = resampled(folder_.write("void.tif", raster));
  EXPECT_NEAR(at(*heights, {9, 46}), 1000 + 10 * 64 - 4 * 64, 40);
}

TEST_F(ResampleTest, TheGeoidIsAdded) {
  const auto geoid = open_geoid("egm96");
  const std::string file = folder_.write("plane.tif", plane());
  const auto heights = resampled(file, {.geoid = geoid.get()});
  const ResamplingError error = measure_resampling(*dem_, *heights, geoid.get());
  EXPECT_EQ(error.samples, 129 * 129);
  // posts beside the DEM do not go on with its slope: that is what is left, along its edge
  EXPECT_LT(error.rms_m, 0.5);
  EXPECT_GT(measure_resampling(*dem_, *heights, nullptr).rms_m, 40);  // it is 48 m there
}

TEST_F(ResampleTest, ADemAcross180DegreesStaysInOnePiece) {
  SmallRaster raster = plane();
  raster.geotransform = north_up(179 - 0.5 / 64, 17 + 0.5 / 64, 1.0 / 64);
  const auto heights = resampled(folder_.write("pacific.tif", raster));
  EXPECT_LE(plan_.tiles.columns, 4);
  EXPECT_LT(measure_resampling(*dem_, *heights, nullptr).rms_m, 0.5);
}

TEST_F(ResampleTest, ADemOfTheWholeEarthHasNoGapWhereItsEndsMeet) {
  SmallRaster raster{.columns = 360,
                     .rows = 181,
                     .value = [](int column, int) { return 100 * std::cos(column * M_PI / 180); },
                     .geotransform = north_up(-0.5, 90.5, 1),
                     .crs = "EPSG:4326"};
  const auto heights = resampled(folder_.write("earth.tif", raster), {.fill_m = -500});
  EXPECT_EQ(plan_.tiles.columns, GeodeticZoom{plan_.tiles.zoom}.tiles_around());
  const Window all = plan_.tiles.posts();
  const HeightGrid equator =
      heights->read(plan_.tiles.zoom, {all.column, all.rows / 2, all.columns, 1});
  for (std::size_t k = 0; k < equator.heights_m.size(); ++k) {
    const double turn = 2 * M_PI * static_cast<double>(k) / static_cast<double>(all.columns - 1);
    EXPECT_NEAR(std::abs(equator.heights_m[k]), std::abs(100 * std::cos(turn)), 1) << k;
  }
}

TEST_F(ResampleTest, PostsMeetASummitBetweenThem) {
  SmallRaster raster = plane();
  raster.value = [](int column, int row) { return column == 70 && row == 60 ? 500 : 0; };
  const std::string file = folder_.write("summit.tif", raster);
  // the four posts around it do not see all of it
  EXPECT_GT(measure_resampling(*dem_, *resampled(file), nullptr).max_m, 100);
  const auto heights = resampled(file, {.fit_to_m = 2});
  EXPECT_LE(measure_resampling(*dem_, *heights, nullptr).max_m, 2.001);
  // far from it nothing was moved
  EXPECT_EQ(at(*heights, {8.5, 46.5}), 0);
}

TEST_F(ResampleTest, PostsMeetEverySampleOfNoiseWhereTheyAreTwiceAsDense) {
  SmallRaster raster = plane();
  std::mt19937 random(1);
  std::vector<double> noise(129 * 129);
  for (double& height : noise) height = static_cast<double>(random() % 1000) / 10;
  raster.value = [&](int column, int row) {
    return noise[static_cast<std::size_t>(row * 129 + column)];
  };
  const std::string file = folder_.write("noise.tif", raster);
  const auto heights = resampled(file, {.zoom = 9, .fit_to_m = 0.5});
  EXPECT_LE(measure_resampling(*dem_, *heights, nullptr).max_m, 0.501);
}

TEST_F(ResampleTest, TheSamplesOfADemAreWhereItPutsThem) {
  SmallRaster raster = plane();
  raster.geotransform = north_up(179 - 0.5 / 64, 17 + 0.5 / 64, 1.0 / 64);
  const auto heights = resampled(folder_.write("pacific.tif", raster));
  const Window posts = plan_.tiles.posts();
  const std::vector<LooseSample> samples = heights->dem_samples(posts);
  ASSERT_EQ(samples.size(), 129U * 129U);
  const double cell_deg = GeodeticZoom{plan_.tiles.zoom}.cell_deg();
  for (const LooseSample& sample : samples) {
    const double east_deg = -180 + sample.column * cell_deg - 179,
                 north = 90 - sample.row * cell_deg;
    ASSERT_NEAR(sample.height_m, 1000 + 640 * east_deg - 256 * (17 - north), 1e-2);
  }
  // each is in one of two halves; those on the meridian between them, which is one of samples, in
  // both
  const std::int64_t half = posts.columns / 2;
  EXPECT_EQ(heights->dem_samples({posts.column, posts.row, half + 1, posts.rows}).size() +
                heights->dem_samples({posts.column + half, posts.row, half + 1, posts.rows}).size(),
            129U * 129U + 129U);
}

TEST(PostSurface, RunsThroughItsPostsAndAlongTheDiagonalsOfTiles) {
  // in the middle of a cell half of two opposite corners
  const auto inner = on_surface(70.5, 70.5, 1000);
  EXPECT_EQ(inner.share, (std::array{0.5, 0.0, 0.5, 0.0}));
  // the cell in the north-east corner of a tile
  const auto corner = on_surface(127.5, 64.5, 1000);
  EXPECT_EQ(corner.share, (std::array{0.0, 0.5, 0.0, 0.5}));
  EXPECT_EQ(on_surface(70, 70, 1000).share, (std::array{1.0, 0.0, 0.0, 0.0}));
}

TEST_F(ResampleTest, RefusesADemWithoutACrsAndAZoomOutOfRange) {
  SmallRaster raster = plane();
  raster.crs = "";
  const std::string nowhere = folder_.write("nowhere.tif", raster);
  EXPECT_NE(testing::input_error_of([&] { resampled(nowhere); }).find("--crs"), std::string::npos);
  const std::string file = folder_.write("plane.tif", plane());
  EXPECT_NE(testing::input_error_of([&] { resampled(file, {.zoom = 40}); }).find("--max-zoom 40"),
            std::string::npos);
}

}  // namespace
}  // namespace terrane::ingest
