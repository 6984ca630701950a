#include "ingest/raise_heights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/ingest/small_raster.h"

namespace terrane::ingest {
namespace {

using testing::north_up;
using testing::open_quietly;
using testing::RasterFolder;

/// The sea, with one sample that is not there, from (6, 47) to the south-east.
std::unique_ptr<Dem> sea(const RasterFolder& folder, double spacing_deg) {
  return open_quietly(folder.write(
      "sea.tif", {.columns = 70,
                  .rows = 50,
                  .value = [](int column, int row) { return column == 3 && row == 4 ? -1 : 0; },
                  .nodata = -1,
                  .geotransform = north_up(6 - spacing_deg / 2, 47 + spacing_deg / 2, spacing_deg),
                  .crs = "EPSG:4326"}));
}

double largest_difference_m(const Dem& dem, const Geoid& geoid, double spacing_deg) {
  const HeightGrid grid = testing::read_all(dem);
  double largest_m = 0;
  for (std::int64_t row = 0; row < 50; ++row) {
    for (std::int64_t column = 0; column < 70; ++column) {
      if (column == 3 && row == 4) continue;
      const LonLat at{6 + static_cast<double>(column) * spacing_deg,
                      47 - static_cast<double>(row) * spacing_deg};
      largest_m =
          std::max(largest_m, std::abs(double{grid.at(column, row)} - geoid.undulation_m(at)));
    }
  }
  return largest_m;
}

TEST(RaiseHeights, TheSeaIsAsHighAsTheGeoid) {
  const RasterFolder folder;
  const auto geoid = open_geoid("egm96");
  for (const auto& [spacing_deg, within_m] :
       {std::pair{0.0003, 0.02}, {0.003, 0.02}, {0.1, 1e-4}}) {
    const auto dem = sea(folder, spacing_deg);
    dem->raise(open_geoid("egm96"));
    EXPECT_LE(largest_difference_m(*dem, *geoid, spacing_deg), within_m) << spacing_deg;
    EXPECT_TRUE(std::isnan(testing::read_all(*dem).at(3, 4)));
  }
}

TEST(RaiseHeights, AWindowHasTheBitsOfTheWhole) {
  const RasterFolder folder;
  const auto dem = sea(folder, 0.0003);
  dem->raise(open_geoid("egm96"));
  const HeightGrid whole = testing::read_all(*dem);
  for (const Window window :
       {Window{0, 0, 1, 1}, {69, 49, 1, 1}, {13, 7, 40, 30}, {29, 0, 3, 50}}) {
    const HeightGrid part = dem->heights().read(window);
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        if (column == 3 && row == 4) continue;
        ASSERT_EQ(part.at(column, row), whole.at(column, row)) << column << " " << row;
      }
    }
  }
}

}  // namespace
}  // namespace terrane::ingest
