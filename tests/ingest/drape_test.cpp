#include "ingest/drape.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using testing::north_up;
using testing::open_quietly;
using testing::RasterFolder;
using testing::SmallRaster;

constexpr double kWest_deg = -122.2, kNorth_deg = 46.2, kPixel_deg = 0.001;

/// A DEM in UTM over the middle of the image below: 33 x 33 samples, 60 m apart.
std::unique_ptr<Dem> dem_in(const RasterFolder& folder) {
  return open_quietly(folder.write("dem.tif", {.columns = 33,
                                               .rows = 33,
                                               .value = [](int, int) { return 100; },
                                               .geotransform = north_up(563000, 5115000, 60),
                                               .crs = "EPSG:32610"}));
}

/// Grey that grows by 2 with each pixel to the east: 100 x 100 pixels of a thousandth of a degree.
SmallRaster ramp() {
  return {.columns = 100,
          .rows = 100,
          .type = "Byte",
          .value = [](int column, int) { return 20 + 2 * column; },
          .geotransform = north_up(kWest_deg, kNorth_deg, kPixel_deg),
          .crs = "EPSG:4326"};
}

/// The grey of the ramp at a longitude.
double grey_at(double longitude_deg) {
  return 20 + 2 * ((longitude_deg - kWest_deg) / kPixel_deg - 0.5);
}

/// Red values of an encoded picture, row by row.
std::vector<unsigned char> red_of(const std::string& picture, int columns, int rows) {
  const GdalScope gdal;
  std::string copy = picture;
  VSIFCloseL(VSIFileFromMemBuffer("/vsimem/drape_test", reinterpret_cast<GByte*>(copy.data()),
                                  copy.size(), FALSE));
  std::vector<unsigned char> red(static_cast<std::size_t>(columns * rows));
  {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open("/vsimem/drape_test"));
    EXPECT_EQ(dataset->GetRasterXSize(), columns);
    EXPECT_EQ(dataset->GetRasterYSize(), rows);
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, red.data(), columns,
                                                  rows, GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  VSIUnlink("/vsimem/drape_test");
  return red;
}

std::string error_of_drape(const std::vector<std::string>& images, const Dem& dem) {
  return input_error_of(
      [&] { open_drape({.images = images}, dem.place(), dem.heights().shape()); });
}

TEST(Drape, ATexelHasTheColourOfThePlaceWhereItsGridPositionStands) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  for (const PictureFormat format : {PictureFormat::kJpeg, PictureFormat::kWebp}) {
    const auto drape = open_drape({{folder.write("ramp.tif", ramp())}, format}, dem->place(),
                                  dem->heights().shape());
    const Window window{8, 4, 17, 17};
    constexpr int kTexels = 33;
    const auto red = red_of(drape->cut(window, kTexels, kTexels), kTexels, kTexels);
    for (int row = 0; row < kTexels; row += 8) {
      for (int column = 0; column < kTexels; column += 4) {
        const GridPosition at{8 + column / 2.0, 4 + row / 2.0};
        const double grey = grey_at(dem->place().to_lon_lat({&at, 1})[0].longitude_deg);
        // lossy, and rounded to bytes
        EXPECT_NEAR(red[static_cast<std::size_t>(row * kTexels + column)], grey, 3) << column;
      }
    }
  }
}

TEST(Drape, NeighboursHaveTheSameTexelsAlongTheirBorder) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  const auto drape =
      open_drape({{folder.write("ramp.tif", ramp())}}, dem->place(), dem->heights().shape());
  constexpr int kTexels = 33;
  const auto west = red_of(drape->cut({0, 0, 17, 17}, kTexels, kTexels), kTexels, kTexels);
  const auto east = red_of(drape->cut({16, 0, 17, 17}, kTexels, kTexels), kTexels, kTexels);
  for (int row = 0; row < kTexels; ++row) {
    EXPECT_NEAR(west[static_cast<std::size_t>(row * kTexels + kTexels - 1)],
                east[static_cast<std::size_t>(row * kTexels)], 3);
  }
}

TEST(Drape, KnowsHowDenseItIs) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  const auto drape =
      open_drape({{folder.write("ramp.tif", ramp())}}, dem->place(), dem->heights().shape());
  // 60 m to the east are 0.00078 degrees at 46 degrees north
  EXPECT_NEAR(drape->texels_per_cell(), 60 / (111320 * std::cos(46.16 * M_PI / 180)) / kPixel_deg,
              0.02);
}

TEST(Drape, WhereThereIsNoImageIsTheGreyOfBareTiles) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  SmallRaster narrow = ramp();
  narrow.columns = 26;  // the DEM begins at the 17th
  const auto drape =
      open_drape({{folder.write("narrow.tif", narrow)}}, dem->place(), dem->heights().shape());
  const auto red = red_of(drape->cut({0, 0, 33, 33}, 65, 65), 65, 65);
  EXPECT_NEAR(red[32 * 65 + 60], 206, 3);
}

TEST(Drape, TheLaterImageLiesOnTop) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  SmallRaster top = ramp();
  top.value = [](int, int) { return 7; };
  const auto drape = open_drape({{folder.write("ramp.tif", ramp()), folder.write("top.tif", top)}},
                                dem->place(), dem->heights().shape());
  for (const unsigned char value : red_of(drape->cut({0, 0, 17, 17}, 16, 16), 16, 16)) {
    EXPECT_NEAR(value, 7, 2);
  }
}

TEST(Drape, SameImagesHaveTheSameFingerprintAndOthersAnother) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  SmallRaster changed = ramp();
  changed.value = [](int column, int) { return 21 + 2 * column; };
  const auto print = [&](const SmallRaster& raster, const char* name) {
    return open_drape({{folder.write(name, raster)}}, dem->place(), dem->heights().shape())
        ->fingerprint();
  };
  EXPECT_EQ(print(ramp(), "a.tif"), print(ramp(), "b.tif"));
  EXPECT_NE(print(ramp(), "a.tif"), print(changed, "c.tif"));
}

TEST(Drape, OneOtherPixelIsAnotherFingerprintInAPartOfAMosaicToo) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  const auto image = [](int lonely) {
    SmallRaster raster = ramp();
    raster.columns = raster.rows = 1000;  // few of its pixels were in a sample of 256 x 256
    raster.value = [lonely](int column, int row) {
      return column == 777 && row == 333 ? lonely : column / 5;
    };
    raster.geotransform = north_up(kWest_deg, kNorth_deg, kPixel_deg / 10);
    return raster;
  };
  const auto prints = [&](int lonely) {
    const std::string file = folder.write("image.tif", image(lonely));
    testing::convert(file, folder.path_of("mosaic.vrt"), {"-of", "VRT"});
    const auto print = [&](const std::string& name) {
      return open_drape({{name}}, dem->place(), dem->heights().shape())->fingerprint();
    };
    return std::pair{print(file), print(folder.path_of("mosaic.vrt"))};
  };
  const auto [file, mosaic] = prints(0);
  const auto [other_file, other_mosaic] = prints(1);
  EXPECT_NE(file, other_file);
  EXPECT_NE(mosaic, other_mosaic);
}

TEST(Drape, RefusesWhatCannotBeLaidOverTheDem) {
  const RasterFolder folder;
  const auto dem = dem_in(folder);
  SmallRaster elsewhere = ramp(), deep = ramp(), nowhere = ramp(), bare = ramp();
  elsewhere.geotransform = north_up(10, 50, kPixel_deg);
  deep.type = "UInt16";
  nowhere.geotransform.reset();
  bare.crs.clear();
  EXPECT_THAT(error_of_drape({folder.write("elsewhere.tif", elsewhere)}, *dem),
              AllOf(HasSubstr("elsewhere.tif"), HasSubstr("does not lie over the DEM")));
  EXPECT_THAT(error_of_drape({folder.write("deep.tif", deep)}, *dem),
              AllOf(HasSubstr("deep.tif"), HasSubstr("8 bits")));
  EXPECT_THAT(error_of_drape({folder.write("nowhere.tif", nowhere)}, *dem),
              HasSubstr("does not say where it lies"));
  EXPECT_THAT(error_of_drape({folder.write("bare.tif", bare)}, *dem), HasSubstr("has no CRS"));
  EXPECT_THAT(error_of_drape({folder.path_of("gone.tif")}, *dem), HasSubstr("gone.tif"));
}

}  // namespace
}  // namespace terrane::ingest
