#include "hierarchy/levels/level_sequence.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "hierarchy/levels/build_levels.h"
#include "hierarchy/levels/level_error.h"
#include "hierarchy/levels/levels_file.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

using testing::mesh_at;
using testing::shape_of_mesh;

SurfaceMesh open_mesh() {
  std::mt19937 random(5);
  SurfaceMesh mesh = testing::saddle(24, 19);
  testing::pierce(mesh, 6, random);
  return mesh;
}

TEST(LevelSequence, GoesBackToTheInputExactly) {
  // coordinates that the lattice holds exactly: sixteenths of a unit
  SurfaceMesh mesh = open_mesh();
  for (Eigen::Vector3d& p : mesh.points) p = (p * 16).array().round().matrix() / 16;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    mesh.points[v].x() = v % 24;
    mesh.points[v].y() = v / 24;
  }
  const LevelSequence sequence = build_levels(mesh);
  ASSERT_GT(sequence.level_count(), 5U);
  EXPECT_EQ(shape_of_mesh(mesh_at(sequence, 0)), shape_of_mesh(mesh));
}

TEST(LevelSequence, RoundsTheInputByLessThanAMillionthOfItsExtent) {
  const SurfaceMesh mesh = testing::torus(17, 13);
  const LevelSequence sequence = build_levels(mesh);
  LevelErrorMeter meter(sequence);
  for (const Eigen::Vector3d& p : mesh.points) {
    double nearest = 1;
    for (const Eigen::Vector3d& q : meter.finest().points) {
      nearest = std::min(nearest, (p - q).norm());
    }
    EXPECT_LT(nearest, 2.8e-6);
  }
}

TEST(LevelSequence, BlendBeginsAtALevelAndEndsAtTheNext) {
  for (const SurfaceMesh& mesh : {open_mesh(), testing::torus(16, 12)}) {
    const LevelSequence sequence = build_levels(mesh, {.most_levels = 6});
    for (std::uint32_t i = 0; i < sequence.level_count(); ++i) {
      EXPECT_EQ(shape_of_mesh(blended(sequence, i, 0)), shape_of_mesh(mesh_at(sequence, i)));
      EXPECT_EQ(shape_of_mesh(blended(sequence, i, 1)), shape_of_mesh(mesh_at(sequence, i + 1)));
    }
  }
}

TEST(LevelSequence, BlendMovesCornersInAStraightLine) {
  const LevelSequence sequence = build_levels(testing::torus(16, 12), {.most_levels = 3});
  const SurfaceMesh from = blended(sequence, 1, 0), to = blended(sequence, 1, 1);
  const SurfaceMesh half = blended(sequence, 1, 0.5);
  for (std::size_t v = 0; v < half.points.size(); ++v) {
    EXPECT_NEAR((half.points[v] - (from.points[v] + to.points[v]) / 2).norm(), 0, 1e-15);
  }
}

TEST(LevelSequence, MorphOverSeveralLevelsEndsAtTheLast) {
  const LevelSequence sequence = build_levels(open_mesh(), {.most_levels = 7});
  const MorphingMesh morph = morphing(sequence, 2, 4);
  EXPECT_EQ(shape_of_mesh(morph.mesh), shape_of_mesh(mesh_at(sequence, 2)));
  EXPECT_EQ(shape_of_mesh({morph.targets, morph.mesh.triangles}),
            shape_of_mesh(mesh_at(sequence, 6)));
  const MorphingMesh last = morphing(sequence, sequence.level_count(), 3);
  EXPECT_EQ(last.targets, last.mesh.points);
}

TEST(LevelSequence, RefusesALevelOrBlendThatIsNotThere) {
  const LevelSequence sequence = build_levels(testing::torus(8, 8), {.most_levels = 2});
  EXPECT_THROW(blended(sequence, 3, 0), ConfigError);
  EXPECT_THROW(blended(sequence, 0, 1.5), ConfigError);
  EXPECT_THROW(blended(sequence, 0, -0.1), ConfigError);
  EXPECT_THROW(morphing(sequence, 9, 1), ConfigError);
}

TEST(LevelsFile, GivesBackWhatWasWritten) {
  for (const SurfaceMesh& mesh :
       {open_mesh(), testing::torus(16, 12), testing::Slab(2, 2).mesh()}) {
    const LevelSequence sequence = build_levels(mesh);
    const LevelSequence read = decode_levels(encode_levels(sequence), "a.levels");
    EXPECT_EQ(read.levels, sequence.levels);
    EXPECT_EQ(read.coarsest_points, sequence.coarsest_points);
    EXPECT_EQ(read.coarsest_triangles, sequence.coarsest_triangles);
    EXPECT_EQ(read.lattice.origin(), sequence.lattice.origin());
    EXPECT_EQ(read.lattice.step(), sequence.lattice.step());
  }
}

TEST(LevelsFile, RefusesEveryTruncationAndEveryFlippedByte) {
  const std::string bytes = encode_levels(build_levels(testing::torus(8, 8)));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_THROW(decode_levels(std::string_view(bytes).substr(0, size), "a.levels"), InputError);
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    EXPECT_THROW(decode_levels(flipped, "a.levels"), InputError) << "byte " << i;
  }
}

TEST(LevelsFile, NamesTheFileAndWhatToDo) {
  try {
    decode_levels("Dear Sir or Madam", "letter.levels");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "letter.levels: is no file of levels. Name one that terrane levels wrote");
  }
}

}  // namespace
}  // namespace terrane::hierarchy
