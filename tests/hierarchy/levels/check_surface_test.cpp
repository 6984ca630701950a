#include "hierarchy/levels/check_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/errors.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Notes final : public Progress {
 public:
  std::vector<std::string> lines;
  void begin(std::string_view, std::int64_t) override {}
  void advance(std::int64_t) override {}
  void note(std::string_view line) override { lines.emplace_back(line); }
};

std::string refusal(const SurfaceMesh& mesh) {
  NoProgress progress;
  try {
    check_surface(mesh, "bad.ply", progress);
  } catch (const TopologyError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckSurface, LetsAGoodMeshPassUnchanged) {
  Notes notes;
  const SurfaceMesh mesh = testing::torus(6, 5);
  const SurfaceMesh checked = check_surface(mesh, "torus", notes);
  EXPECT_EQ(checked.triangles, mesh.triangles);
  EXPECT_EQ(checked.points, mesh.points);
  EXPECT_THAT(notes.lines, IsEmpty());
}

TEST(CheckSurface, RefusesAnEdgeWithThreeTrianglesAndNamesThem) {
  SurfaceMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                   {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_EQ(refusal(mesh),
            "bad.ply: edge 0-1 has more than two triangles (0, 1, 2). Cut the mesh there: an edge "
            "of a surface has two");
}

TEST(CheckSurface, RefusesNeighboursOfDifferentOrientation) {
  SurfaceMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_THAT(refusal(mesh), HasSubstr("triangles 0 and 1 face opposite sides at edge 0-1"));
}

TEST(CheckSurface, RefusesAVertexInUseThatIsNotFinite) {
  SurfaceMesh mesh = testing::torus(6, 5);
  mesh.points[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(mesh), HasSubstr("vertex 7 of triangle"));
}

TEST(CheckSurface, LeavesOutVerticesThatNobodyUsesNotFiniteOnesToo) {
  SurfaceMesh mesh = testing::torus(6, 5);
  mesh.points.insert(mesh.points.begin(), {std::numeric_limits<double>::infinity(), 0, 0});
  for (Corners& corners : mesh.triangles) {
    for (std::uint32_t& v : corners) ++v;
  }
  Notes notes;
  EXPECT_EQ(check_surface(mesh, "m", notes).points.size(), 30U);
  EXPECT_THAT(notes.lines,
              ElementsAre("m: 1 vertices that no triangle uses are left out (the first: 0)"));
}

TEST(CheckSurface, LeavesOutTrianglesThatRepeatACornerOrAreThereTwice) {
  SurfaceMesh mesh = testing::torus(6, 5);
  mesh.triangles.insert(mesh.triangles.begin() + 3, {4, 4, 5});
  const auto [a, b, c] = mesh.triangles[0];
  mesh.triangles.push_back({b, c, a});
  mesh.triangles.push_back({c, b, a});  // turned over
  Notes notes;
  EXPECT_EQ(check_surface(mesh, "m", notes).triangles, testing::torus(6, 5).triangles);
  EXPECT_THAT(notes.lines,
              ElementsAre("m: 1 triangles that repeat a corner are left out (the first: 3)",
                          "m: 2 triangles that are there twice are left out (the first: 61)"));
}

TEST(CheckSurface, SaysThatThereAreSeveralComponents) {
  SurfaceMesh mesh = testing::torus(6, 5);
  for (const Corners& corners : testing::torus(6, 5).triangles) {
    mesh.triangles.push_back({corners[0] + 30, corners[1] + 30, corners[2] + 30});
  }
  for (int i = 0; i < 30; ++i) mesh.points.push_back(mesh.points[i] + Eigen::Vector3d(5, 0, 0));
  Notes notes;
  EXPECT_EQ(check_surface(mesh, "m", notes).triangles.size(), 120U);
  EXPECT_THAT(notes.lines, ElementsAre("m: 2 components; each keeps to itself"));
}

TEST(CheckSurface, SaysThatTrianglesHaveNoArea) {
  SurfaceMesh mesh = testing::torus(6, 5);
  mesh.points[3] = mesh.points[4];
  Notes notes;
  check_surface(mesh, "m", notes);
  ASSERT_EQ(notes.lines.size(), 1U);
  EXPECT_THAT(notes.lines[0], HasSubstr("2 triangles have no area"));
}

TEST(CheckSurface, RefusesAMeshWithoutTriangles) {
  EXPECT_THAT(refusal({{{0, 0, 0}}, {}}), HasSubstr("no triangle is left"));
}

}  // namespace
}  // namespace terrane::hierarchy
