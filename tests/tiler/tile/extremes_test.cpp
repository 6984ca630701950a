#include "tiler/tile/extremes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <set>

#include "tests/tiler/test_dem.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {
namespace {

using Samples = std::set<std::pair<float, float>>;

constexpr std::int64_t kColumns = 37, kRows = 29, kPart = 8;  // the last parts are cut off

/// Rough slopes with holes, one of which takes up all of a part.
double rough(std::int64_t column, std::int64_t row) {
  std::mt19937 random(static_cast<unsigned>(100 * row + column));
  random.discard(5);
  if (random() % 20 == 0 || (column / kPart == 1 && row / kPart == 2)) return NAN;
  const double noise = std::uniform_real_distribution<double>(0, 30)(random);
  return static_cast<double>(column) - 3 * static_cast<double>(row) + noise;
}

/// By its definition, sample after sample: planes from a decomposition of all equations.
Samples extremes_by_definition(const HeightGrid& grid) {
  std::vector<Eigen::Vector3d> terms;
  std::vector<double> heights;
  for (std::int64_t row = 0; row < kRows; ++row) {
    for (std::int64_t column = 0; column < kColumns; ++column) {
      if (!grid.has_data(column, row)) continue;
      terms.emplace_back(1, column, row);
      heights.push_back(grid.at(column, row));
    }
  }
  Eigen::MatrixXd equations(terms.size(), 3);
  for (std::size_t i = 0; i < terms.size(); ++i) equations.row(Eigen::Index(i)) = terms[i];
  const Eigen::VectorXd right =
      Eigen::Map<Eigen::VectorXd>(heights.data(), Eigen::Index(heights.size()));
  const Eigen::Vector3d trend = equations.colPivHouseholderQr().solve(right);
  const Eigen::VectorXd above = right - equations * trend;
  const double tilt = (above.maxCoeff() - above.minCoeff()) / double(std::max(kColumns, kRows));

  Samples samples;
  const Eigen::Vector3d sides[] = {
      {0, 0, 0}, {0, tilt, 0}, {0, -tilt, 0}, {0, 0, tilt}, {0, 0, -tilt}};
  for (std::int64_t part = 0; part < 5 * 4; ++part) {
    for (const Eigen::Vector3d& side : sides) {
      for (const double sign : {1.0, -1.0}) {
        double most = -INFINITY;
        Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < terms.size(); ++i) {
          const bool is_in_part = std::int64_t(terms[i].y()) / kPart == part % 5 &&
                                  std::int64_t(terms[i].z()) / kPart == part / 5;
          const double by = sign * (heights[i] - terms[i].dot(trend + side));
          if (!is_in_part || by <= most) continue;
          most = by;
          farthest = terms[i];
        }
        if (std::isfinite(most)) samples.emplace(float(farthest.y()), float(farthest.z()));
      }
    }
  }
  return samples;
}

TEST(Extremes, AreThoseThatTheirDefinitionNames) {
  const testing::FunctionDem dem({kColumns, kRows}, rough);
  const testing::PlainPlace place(1, 1);
  const WorldFrame world(place, dem.shape());
  const Lattice lattice{std::vector<Eigen::Vector3d>{{0.01, 0.01, 0.01}}};
  const Window window{0, 0, kColumns, kRows};
  const TileFrame frame(world, lattice, window, 0);
  const HeightGrid grid = dem.read(window);
  std::vector<hierarchy::FieldSample> found;
  add_extremes({grid, window, frame}, window, kPart, found);
  Samples samples;
  for (const hierarchy::FieldSample& sample : found) {
    EXPECT_TRUE(samples.emplace(sample.column, sample.row).second);
    EXPECT_NEAR(sample.height_m, grid.at(std::int64_t(sample.column), std::int64_t(sample.row)),
                1e-3);
  }
  EXPECT_EQ(samples, extremes_by_definition(grid));
}

}  // namespace
}  // namespace terrane::tiler
