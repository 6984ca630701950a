#include "tiler/files/mesh_file.h"

#include <gmock/gmock.h>
#include <tiny_gltf.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <vector>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using hierarchy::kUnitsPerCell;
using hierarchy::TerrainMesh;
using ::testing::ElementsAre;
using testing::PlainPlace;

/// Half a cell wide steps in plan, so that coordinates have fractions.
TerrainMesh one_triangle() {
  const auto vertex = [](double column, double row, double height_m) {
    return hierarchy::TerrainVertex{.place = {{static_cast<std::int32_t>(column * kUnitsPerCell),
                                               static_cast<std::int32_t>(-row * kUnitsPerCell)},
                                              height_m,
                                              {}}};
  };
  return {{vertex(0, 0, 1234.123456), vertex(0, 2, 2), vertex(1.0 / kUnitsPerCell, 0, -3)},
          {{0, 1, 2}}};
}

constexpr GridShape kShape{3, 3};

// OpenMesh is no reader for this: it takes every coordinate through a float.
struct ReadMesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;  ///< from 0
};

ReadMesh read_obj(const std::string& text) {
  ReadMesh mesh;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what, a, b, c;
    words >> what >> a >> b >> c;
    if (what == "v") mesh.points.push_back({std::stod(a), std::stod(b), std::stod(c)});
    if (what == "f") {
      mesh.triangles.push_back({std::stoi(a) - 1, std::stoi(b) - 1, std::stoi(c) - 1});
    }
  }
  return mesh;
}

ReadMesh read_ply(const std::string& bytes) {
  ReadMesh mesh;
  std::istringstream stream(bytes);
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(stream, line) && line != "end_header";) {
    std::sscanf(line.c_str(), "element vertex %zu", &vertices);
    std::sscanf(line.c_str(), "element face %zu", &faces);
  }
  mesh.points.resize(vertices);
  stream.read(reinterpret_cast<char*>(mesh.points.data()),
              static_cast<std::streamsize>(vertices * sizeof(mesh.points[0])));
  mesh.triangles.resize(faces);
  for (auto& triangle : mesh.triangles) {
    EXPECT_EQ(stream.get(), 3);
    stream.read(reinterpret_cast<char*>(triangle.data()), sizeof triangle);
  }
  EXPECT_TRUE(stream.good());
  EXPECT_EQ(stream.peek(), EOF);
  return mesh;
}

double area_in_plan(const ReadMesh& mesh) {
  const auto& a = mesh.points[mesh.triangles[0][0]];
  const auto& b = mesh.points[mesh.triangles[0][1]];
  const auto& c = mesh.points[mesh.triangles[0][2]];
  return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

struct Format {
  MeshFormat format;
  ReadMesh (*read)(const std::string&);
};

class TextAndBinary : public ::testing::TestWithParam<Format> {
 protected:
  static ReadMesh written(const Georeference& place) {
    return GetParam().read(encode_mesh(one_triangle(), GetParam().format, place, kShape));
  }
};

TEST_P(TextAndBinary, HoldsCoordinatesOfTheCrsToTheLastBit) {
  const ReadMesh mesh = written(PlainPlace(30, 30));
  ASSERT_EQ(mesh.points.size(), 3U);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_THAT(mesh.points[0], ElementsAre(500000, 4000000, 1234.123456));
  EXPECT_THAT(mesh.points[1], ElementsAre(500000, 3999940, 2));
  // 30 / 2^14 m beside half a million: a float would lose it
  EXPECT_THAT(mesh.points[2], ElementsAre(500000.0018310547, 4000000, -3));
}

TEST_P(TextAndBinary, TrianglesFaceUpWhicheverWayTheRowsRun) {
  EXPECT_GT(area_in_plan(written(PlainPlace(30, 30))), 0);
  EXPECT_GT(area_in_plan(written(PlainPlace(30, -30))), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, TextAndBinary,
                         ::testing::Values(Format{MeshFormat::kObj, read_obj},
                                           Format{MeshFormat::kPly, read_ply}));

struct Glb {
  tinygltf::Model model;

  explicit Glb(const std::string& bytes) {
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(
        &model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<unsigned>(bytes.size())));
    EXPECT_EQ(error + warning, "");
  }
  const float* position(std::size_t vertex) const {
    return reinterpret_cast<const float*>(model.buffers[0].data.data() +
                                          model.bufferViews[0].byteOffset) +
           3 * vertex;
  }
};

TEST(GlbFile, HoldsLocalMetresFromTheCentreWithYUpAndZSouth) {
  const Glb glb(encode_mesh(one_triangle(), MeshFormat::kGlb, PlainPlace(30, 20), kShape));
  EXPECT_THAT(std::vector<float>(glb.position(1), glb.position(2)), ElementsAre(-30, 2, 20));
  EXPECT_EQ(glb.model.accessors[0].maxValues[1], 1234.123456F);
  EXPECT_EQ(glb.model.nodes[0].extras.Get("terrane").Get("origin").Get("x").GetNumberAsDouble(),
            500030);
}

TEST(GlbFile, AGeographicGridIsInMetresOfItsCentre) {
  // one degree along the equator of WGS84: 6378137 m * pi / 180; along the meridian, the radius
  // a (1 - e^2) = 6335439.327 m
  const testing::GeographicPlace place({10, 0.001}, 0.001);
  const Glb glb(encode_mesh(one_triangle(), MeshFormat::kGlb, place, kShape));
  EXPECT_NEAR(glb.position(0)[0], -111.31949, 1e-4);
  EXPECT_NEAR(glb.position(0)[2], -110.57428, 1e-4);
}

TEST(MeshFormatOf, GoesByTheExtension) {
  EXPECT_EQ(mesh_format_of("a/b.obj"), MeshFormat::kObj);
  EXPECT_EQ(mesh_format_of("B.PLY"), MeshFormat::kPly);
  EXPECT_EQ(mesh_format_of("b.ply.glb"), MeshFormat::kGlb);
  EXPECT_THROW(mesh_format_of("b.stl"), ConfigError);
  EXPECT_THROW(mesh_format_of("obj"), ConfigError);
}

}  // namespace
}  // namespace terrane::tiler
