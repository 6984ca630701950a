#include "hierarchy/mesh/cell_triangulation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace terrane::hierarchy {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;
using Edge = CellTriangulation::Edge;

constexpr std::int32_t kSide = kUnitsPerCell;

///  0 ─── 3      (y against the rows: 0 is at (0, 0), 2 at (kSide, -kSide))
///  │ ╲   │
///  1 ─── 2
CellTriangulation cell() {
  return {{{0, 0}, {0, -kSide}, {kSide, -kSide}, {kSide, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

bool has_edge(const CellTriangulation& work, std::uint32_t a, std::uint32_t b) {
  return std::ranges::any_of(work.triangles(), [=](const Corners& t) {
    return std::ranges::count(t, a) == 1 && std::ranges::count(t, b) == 1;
  });
}

/// Every triangle counter-clockwise, all of them together the cell: no hole, no overlap.
void expect_sound(const CellTriangulation& work) {
  std::int64_t area = 0;
  for (const auto& [a, b, c] : work.triangles()) {
    const std::int64_t twice = orient2d(work.points()[a], work.points()[b], work.points()[c]);
    EXPECT_GT(twice, 0);
    area += twice;
  }
  EXPECT_EQ(area, 2 * std::int64_t{kSide} * kSide);
  for (const auto& [a, b] : work.edges()) EXPECT_TRUE(has_edge(work, a, b)) << a << " " << b;
}

TEST(CellTriangulation, APointInsideSplitsATriangleInThree) {
  CellTriangulation work = cell();
  EXPECT_EQ(work.insert({kSide / 4, -kSide / 2}), 4U);
  EXPECT_EQ(work.triangles().size(), 4U);
  expect_sound(work);
}

TEST(CellTriangulation, APointOnTheDiagonalSplitsBothTriangles) {
  CellTriangulation work = cell();
  work.insert({kSide / 2, -kSide / 2});
  EXPECT_EQ(work.triangles().size(), 4U);
  expect_sound(work);
}

TEST(CellTriangulation, APointThatIsThereKeepsItsNumber) {
  CellTriangulation work = cell();
  EXPECT_EQ(work.insert({kSide, -kSide}), 2U);
  EXPECT_EQ(work.triangles().size(), 2U);
}

TEST(CellTriangulation, CoversItsSidesAndNothingBeyond) {
  const CellTriangulation work = cell();
  EXPECT_TRUE(work.covers({kSide, -7}));
  EXPECT_FALSE(work.covers({kSide + 1, -7}));
}

TEST(CellTriangulation, JoiningTheOtherCornersFlipsTheDiagonal) {
  CellTriangulation work = cell();
  work.join(3, 1);
  EXPECT_THAT(work.edges(), ElementsAre(Edge{1, 3}));
  EXPECT_EQ(work.triangles().size(), 2U);
  expect_sound(work);
}

TEST(CellTriangulation, AJoinOverAPointOnTheWayMakesTwoEdges) {
  CellTriangulation work = cell();
  const std::uint32_t middle = work.insert({kSide / 2, -kSide / 2});
  work.join(1, 3);
  EXPECT_THAT(work.edges(), UnorderedElementsAre(Edge{1, middle}, Edge{3, middle}));
  expect_sound(work);
}

TEST(CellTriangulation, TwoEdgesThatCrossMeetInAPointOfBoth) {
  CellTriangulation work = cell();
  const std::uint32_t left = work.insert({0, -kSide / 3}), right = work.insert({kSide, -kSide / 2});
  const std::uint32_t top = work.insert({kSide / 2, 0}), bottom = work.insert({kSide / 3, -kSide});
  work.join(left, right);
  work.join(top, bottom);
  const std::uint32_t met = bottom + 1;
  ASSERT_EQ(work.points().size(), met + 1);
  EXPECT_THAT(work.edges(), UnorderedElementsAre(Edge{left, met}, Edge{right, met}, Edge{top, met},
                                                 Edge{bottom, met}));
  expect_sound(work);
}

class RandomLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomLines, StayEdgesOfASoundTriangulation) {
  std::mt19937 random(GetParam());
  CellTriangulation work = cell();
  std::vector<std::uint32_t> ends;
  for (int i = 0; i < 12; ++i) {
    // a few coordinates only, so that points fall on sides, diagonals and each other
    const auto coarse = [&] { return static_cast<std::int32_t>(random() % 9) * kSide / 8; };
    const auto fine = [&] { return static_cast<std::int32_t>(random() % (kSide + 1)); };
    const bool is_fine = random() % 2 == 0;
    const std::int32_t x = is_fine ? fine() : coarse(), y = is_fine ? fine() : coarse();
    ends.push_back(work.insert({x, -y}));
  }
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) work.join(ends[i], ends[i + 1]);
  expect_sound(work);
  work.make_delaunay();
  expect_sound(work);
}

TEST_P(RandomLines, WithoutLinesEveryCircleOfDelaunaysIsEmpty) {
  std::mt19937 random(GetParam());
  CellTriangulation work = cell();
  for (int i = 0; i < 12; ++i) {
    const auto x = static_cast<std::int32_t>(random() % (kSide + 1));
    work.insert({x, -static_cast<std::int32_t>(random() % (kSide + 1))});
  }
  work.make_delaunay();
  expect_sound(work);
  for (const auto& [a, b, c] : work.triangles()) {
    const auto& points = work.points();
    // the circumcentre, by its formula in Cartesian coordinates about a
    const double bx = points[b].x - points[a].x, by = points[b].y - points[a].y;
    const double cx = points[c].x - points[a].x, cy = points[c].y - points[a].y;
    const double d = 2 * (bx * cy - by * cx);
    const double x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
    const double y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
    const double radius = std::hypot(x, y);
    for (const GridPoint p : points) {
      EXPECT_GE(std::hypot(p.x - points[a].x - x, p.y - points[a].y - y), radius * (1 - 1e-9));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLines, ::testing::Range(0U, 200U));

}  // namespace
}  // namespace terrane::hierarchy
