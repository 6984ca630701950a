#include "hierarchy/levels/read_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/errors.h"
#include "hierarchy/levels/write_surface.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

using ::testing::HasSubstr;

class ReadSurface : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& content) {
    const auto file = folder_ / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  std::string refusal(const std::filesystem::path& file) {
    try {
      read_surface(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  ~ReadSurface() override { std::filesystem::remove_all(folder_); }

 private:
  std::filesystem::path folder_ = [] {
    std::string name = (std::filesystem::temp_directory_path() / "read_surface_XXXXXX").string();
    return std::filesystem::path(mkdtemp(name.data()));
  }();
};

const char* const kTetrahedronStl =
    "solid t\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "endsolid t\n";

TEST_F(ReadSurface, GivesBackWhatWasWrittenAsPlyAndObj) {
  SurfaceMesh mesh = testing::torus(7, 5);
  // places that a float holds, as OpenMesh's readers do. (Not by a cast there and back: the SLP
  // vectoriser of g++ 12, -O2 and up, leaves two of three coordinates as they are.)
  for (Eigen::Vector3d& p : mesh.points) p = (1024 * p).array().round() / 1024;
  for (const auto& [name, bytes] :
       {std::pair("t.ply", encode_ply(mesh)), std::pair("t.obj", encode_obj(mesh))}) {
    const SurfaceMesh read = read_surface(write(name, bytes));
    EXPECT_EQ(read.triangles, mesh.triangles) << name;
    EXPECT_EQ(read.points, mesh.points) << name;
  }
}

TEST_F(ReadSurface, SkipsTheTargetsOfAMorph) {
  const SurfaceMesh mesh = testing::Slab(1, 1).mesh();
  const SurfaceMesh read = read_surface(write("m.ply", encode_ply(mesh, mesh.points)));
  EXPECT_EQ(read.points, mesh.points);
  EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST_F(ReadSurface, ReadsOffAndMakesAFanOfAQuad) {
  const SurfaceMesh read =
      read_surface(write("q.OFF", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
  EXPECT_EQ(read.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(ReadSurface, JoinsTheVerticesOfAnStl) {
  const SurfaceMesh read = read_surface(write("t.stl", kTetrahedronStl));
  EXPECT_EQ(read.points.size(), 4U);
  EXPECT_EQ(read.triangles.size(), 4U);
  EXPECT_EQ(testing::Oracle(read.triangles).euler, 2);
}

TEST_F(ReadSurface, KeepsFacesThatAreNotManifoldForTheOneWhoRefusesThem) {
  const SurfaceMesh read = read_surface(
      write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n"));
  EXPECT_EQ(read.triangles.size(), 3U);
}

TEST_F(ReadSurface, RefusesFilesThatAreMissingEmptyOrSomethingElse) {
  EXPECT_THAT(refusal("/nowhere/gone.ply"), HasSubstr("/nowhere/gone.ply: cannot be read"));
  EXPECT_THAT(refusal(write("empty.obj", "")), HasSubstr("empty.obj"));
  EXPECT_THAT(refusal(write("points.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n")), HasSubstr("no face"));
  EXPECT_THAT(refusal(write("letter.ply", "Dear Sir or Madam")), HasSubstr("letter.ply"));
}

TEST_F(ReadSurface, RefusesAFaceOfAVertexThatIsNotThere) {
  EXPECT_NE(refusal(write("far.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n")), "");
}

TEST(IsSurfaceFile, KnowsTheFourKindsInAnyCase) {
  EXPECT_TRUE(is_surface_file("a/b.PLY"));
  EXPECT_TRUE(is_surface_file("b.obj"));
  EXPECT_FALSE(is_surface_file("dem.tif"));
  EXPECT_FALSE(is_surface_file("ply"));
}

}  // namespace
}  // namespace terrane::hierarchy
