#include "tiler/tile/grid_census.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hierarchy/mesh/grid_triangles.h"
#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

TEST(GridCensus, CountsWhatTheTriangulationHasHoweverFewRowsAreRead) {
  // holes, single samples and a checkerboard
  const testing::FunctionDem dem({23, 19}, [](auto c, auto r) {
    const bool is_hole = (c * 31 + r * 17) % 7 < 2 || (c > 12 && (c + r) % 2 == 0);
    return is_hole ? double{NAN} : 0.0;
  });
  const Window all{0, 0, 23, 19};
  const hierarchy::GridTriangles full = hierarchy::triangulate(dem.read(all), all);
  for (const std::int64_t samples_at_once : {1, 50, 1000}) {
    const GridCensus census = count_grid(dem, samples_at_once);
    EXPECT_EQ(census.samples, std::ssize(full.vertices));
    EXPECT_EQ(census.triangles, std::ssize(full.triangles));
  }
}

}  // namespace
}  // namespace terrane::tiler
