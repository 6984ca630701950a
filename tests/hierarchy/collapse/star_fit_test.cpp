#include "hierarchy/collapse/star_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hierarchy/collapse/lanes.h"
#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::field_of;
using testing::grid_of;

constexpr std::int32_t kCells = 8;  // the octagon's diameter

GridPoint at(double column, double row) {
  return {static_cast<std::int32_t>(std::lround(column * kUnitsPerCell)),
          static_cast<std::int32_t>(std::lround(-row * kUnitsPerCell))};
}

/// An octagon with the core edge a-b in its middle:
///
///      p3 ─ p2 ─ p1        the corners lie on the square of kCells, counter-clockwise on the map;
///      │         │         the edge's collapse leaves one star with eight sectors
///      p4  b  a  p0
///      │         │
///      p5 ─ p6 ─ p7
class Octagon {
 public:
  explicit Octagon(const SampleField& field, double corner_height_m = 0, StarJudge judge = {})
      : vertices_(corners(corner_height_m)),
        mesh_(10, triangles()),
        samples_(field, vertices_, triangles(), mesh_.triangle_count()),
        judge_(std::move(judge)) {
    StencilWalker walker(mesh_);
    Stencil stencil;
    // triangle 8 is (a, p2, b): its last side is the edge b-a
    EXPECT_EQ(walker.around_edge(HalfedgeMesh::halfedge(TriangleId{8}, 2), stencil),
              Collapsibility::kYes);
    star_.gather(stencil, mesh_, vertices_, samples_);
  }

  const Star& star() const { return star_; }
  double origin_m() const { return star_.origin().height_m; }

  StarVerdict fit(GridPoint centre, float tolerance_m, StarHeights& heights) {
    return judge_.fit(star_, star_.centre(centre), tolerance_m, 0, heights, tried_++);
  }
  bool holds(GridPoint centre, double height_m, double tolerance_m) {
    return judge_.holds(star_, {centre, height_m, {}}, tolerance_m);
  }
  std::vector<std::uint32_t> sectors() const {
    const auto of_star = judge_.sectors(star_);
    return {of_star.begin(), of_star.end()};
  }
  const Place& corner(int k) const { return vertices_[k].place; }

 private:
  static std::vector<TerrainVertex> corners(double height_m) {
    const double h = kCells / 2.0, s = kCells;
    const GridPoint plan[] = {at(s, h), at(s, 0), at(h, 0), at(0, 0), at(0, h),
                              at(0, s), at(h, s), at(s, s), at(5, h), at(3, h)};
    std::vector<TerrainVertex> vertices;
    for (const GridPoint p : plan) vertices.push_back({.place = {p, height_m, {}}});
    return vertices;
  }
  static std::vector<Corners> triangles() {
    constexpr std::uint32_t a = 8, b = 9;
    return {{a, 6, 7}, {a, 7, 0}, {a, 0, 1}, {a, 1, 2}, {b, 2, 3},
            {b, 3, 4}, {b, 4, 5}, {b, 5, 6}, {a, 2, b}, {b, 6, a}};
  }

  std::vector<TerrainVertex> vertices_;
  HalfedgeMesh mesh_;
  CoveredSamples samples_;
  Star star_;
  StarJudge judge_;
  std::size_t tried_ = 0;
};

TEST(StarJudge, FindsThePeakOfAPyramidExactly) {
  const SampleField field = field_of(grid_of(9, 9, [](auto c, auto r) {
    return 10.0 * (4 - std::max(std::abs(c - 4), std::abs(r - 4)));
  }));
  Octagon octagon(field);
  StarHeights heights;
  ASSERT_EQ(octagon.fit(at(4, 4), 1, heights), StarVerdict::kFeasible);
  EXPECT_NEAR(octagon.origin_m() + heights.best, 40, 1e-5);
  EXPECT_NEAR(heights.squared_error, 0, 1e-2);
  // the peak itself is the tightest sample: it alone has the whole weight of the centre
  EXPECT_NEAR(octagon.origin_m() + heights.lowest, 39, 1e-5);
  EXPECT_NEAR(octagon.origin_m() + heights.highest, 41, 1e-5);
}

TEST(StarJudge, RefusesWhereTwoSamplesCannotBothBeKept) {
  // a spike beside the centre and a pit on the other side: 10 m apart, 1 m tolerance
  const SampleField field = field_of(grid_of(9, 9, [](auto c, auto r) {
    return r != 4 ? 0 : c == 3 ? 5 : c == 5 ? -5 : 0;
  }));
  Octagon octagon(field);
  StarHeights heights;
  EXPECT_EQ(octagon.fit(at(4, 4), 1, heights), StarVerdict::kOverTolerance);
}

TEST(StarJudge, RefusesACentreThatThePolygonDoesNotSee) {
  Octagon octagon(field_of(grid_of(9, 9, [](auto, auto) { return 0; })));
  StarHeights heights;
  EXPECT_EQ(octagon.fit(at(8.5, 4), 1, heights), StarVerdict::kNotStarShaped);
  EXPECT_EQ(octagon.fit(at(8, 4), 1, heights), StarVerdict::kNotStarShaped);
}

TEST(StarJudge, SamplesWithoutDataConstrainNothing) {
  const SampleField field =
      field_of(grid_of(9, 9, [](auto c, auto r) { return c == 3 && r == 3 ? NAN : 0; }));
  Octagon octagon(field);
  EXPECT_EQ(octagon.star().sample_count(), 9U * 9 - 1);
  EXPECT_TRUE(octagon.holds(at(4, 4), 0, 1e-12));
}

TEST(StarJudge, IsNotDecidedWhereNoSampleHasWeight) {
  SampleField field = field_of(grid_of(9, 9, [](auto, auto) { return NAN; }));
  Octagon octagon(field);
  StarHeights heights;
  ASSERT_EQ(octagon.fit(at(4, 4), 1, heights), StarVerdict::kFeasible);
  EXPECT_EQ(heights.highest - heights.lowest, INFINITY);
}

/// Height over a place of the star around a centre: by trying every sector, in double precision.
double height_of_star(const Octagon& octagon, GridPoint centre, double centre_m, double column,
                      double row) {
  for (int k = 0; k < 8; ++k) {
    const Place& p = octagon.corner(k);
    const Place& q = octagon.corner((k + 1) % 8);
    const double cx = column_of(centre), cy = row_of(centre);
    const double px = column_of(p.plan) - cx, py = row_of(p.plan) - cy;
    const double qx = column_of(q.plan) - cx, qy = row_of(q.plan) - cy;
    const double x = column - cx, y = row - cy, area = px * qy - py * qx;
    const double of_p = (x * qy - y * qx) / area, of_q = (px * y - py * x) / area;
    if (of_p < -1e-9 || of_q < -1e-9 || of_p + of_q > 1 + 1e-9) continue;
    return centre_m + of_p * (p.height_m - centre_m) + of_q * (q.height_m - centre_m);
  }
  ADD_FAILURE() << "no sector holds " << column << ", " << row;
  return 0;
}

double worst_m(const Octagon& octagon, const SampleField& field, GridPoint centre,
               double centre_m) {
  double worst = 0;
  for (std::int64_t row = 0; row < field.rows; ++row) {
    for (std::int64_t column = 0; column < field.columns; ++column) {
      const double z = height_of_star(octagon, centre, centre_m, static_cast<double>(column),
                                      static_cast<double>(row));
      worst = std::max(worst, std::abs(z - field.row(row)[column]));
    }
  }
  return worst;
}

TEST(StarJudge, AgreesWithEverySectorTriedOnRandomStars) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(-1, 1), place(1, 7);
  int feasible = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const SampleField field = field_of(grid_of(9, 9, [&](auto c, auto r) {
      // the border is where the polygon is, so that the inside decides
      const bool is_border = c == 0 || r == 0 || c == 8 || r == 8;
      return is_border ? 500.0 : 500 + height(random);
    }));
    Octagon octagon(field, 500);
    const GridPoint centre = at(place(random), place(random));
    StarHeights heights;
    constexpr double kTolerance_m = 1.2, kRounding_m = 1e-3;
    if (octagon.fit(centre, kTolerance_m, heights) != StarVerdict::kFeasible) continue;
    ++feasible;
    const double lowest = octagon.origin_m() + heights.lowest;
    const double highest = octagon.origin_m() + heights.highest;
    EXPECT_LE(worst_m(octagon, field, centre, lowest), kTolerance_m + kRounding_m);
    EXPECT_LE(worst_m(octagon, field, centre, highest), kTolerance_m + kRounding_m);
    EXPECT_GT(worst_m(octagon, field, centre, highest + 2 * kRounding_m), kTolerance_m);
    EXPECT_GT(worst_m(octagon, field, centre, lowest - 2 * kRounding_m), kTolerance_m);

    const double best = octagon.origin_m() + heights.best;
    const double exact = worst_m(octagon, field, centre, best);
    EXPECT_TRUE(octagon.holds(centre, best, exact + 1e-9));
    EXPECT_FALSE(octagon.holds(centre, best, exact - 1e-9));
  }
  EXPECT_GT(feasible, 50);
}

TEST(StarJudge, SaysTheSameToTheBitWithWideLanesAndWithout) {
  if (!has_wide_lanes()) GTEST_SKIP() << "this machine has no AVX2";
  std::mt19937 random(11);
  std::uniform_real_distribution<double> height(499, 501), place(0.5, 7.5);
  int feasible = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const SampleField field = field_of(grid_of(9, 9, [&](auto, auto) { return height(random); }));
    Octagon wide(field, 500, StarJudge(true)), portable(field, 500, StarJudge(false));
    // places one after the other, as the second is first asked about what refused the first
    for (int k = 0; k < 4; ++k) {
      const GridPoint centre = at(place(random), place(random));
      StarHeights by_wide, by_portable;
      const StarVerdict verdict = portable.fit(centre, 1.4F, by_portable);
      ASSERT_EQ(wide.fit(centre, 1.4F, by_wide), verdict);
      if (verdict != StarVerdict::kFeasible) continue;
      ++feasible;
      EXPECT_EQ(by_wide.lowest, by_portable.lowest);
      EXPECT_EQ(by_wide.highest, by_portable.highest);
      EXPECT_EQ(by_wide.best, by_portable.best);
      EXPECT_EQ(by_wide.squared_error, by_portable.squared_error);
      ASSERT_TRUE(wide.holds(centre, 500, 100) && portable.holds(centre, 500, 100));
      EXPECT_EQ(wide.sectors(), portable.sectors());
    }
  }
  EXPECT_GT(feasible, 50);
}

}  // namespace
}  // namespace terrane::hierarchy
