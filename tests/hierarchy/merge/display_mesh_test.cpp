#include "hierarchy/merge/display_mesh.h"

#include <gtest/gtest.h>

#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

/// What a GPU has that is sent nothing but the ranges that are reported.
struct Mirror {
  std::vector<std::uint32_t> indices;
  std::vector<float> positions;

  void upload(const DisplayMesh& display) {
    indices.resize(display.indices().size());
    positions.resize(display.positions().size());
    for (const auto& [begin, end] : display.changed_triangles()) {
      std::copy(display.indices().begin() + 3 * begin, display.indices().begin() + 3 * end,
                indices.begin() + 3 * begin);
    }
    for (const auto& [begin, end] : display.changed_vertices()) {
      std::copy(display.positions().begin() + 3 * begin, display.positions().begin() + 3 * end,
                positions.begin() + 3 * begin);
    }
  }
};

TEST(DisplayMesh, ReportsEveryChangeOfItsArrays) {
  for (const MergeTree& tree : {build_merge_tree(hills(33, 33)), build_merge_tree(sphere(3))}) {
    MergeFront front(tree);
    RandomViews views(tree, 2);
    Mirror mirror;
    for (int frame = 0; frame < 100; ++frame) {
      front.update(ViewJudge(tree, views.camera(), views.criteria()));
      mirror.upload(front.display());
      front.display().forget_changes();
      ASSERT_EQ(mirror.indices, front.display().indices());
      ASSERT_EQ(mirror.positions, front.display().positions());
    }
  }
}

TEST(DisplayMesh, ItsArraysHoldThePlacesOfTheTrianglesThatShow) {
  const MergeTree tree = build_merge_tree(torn_torus(40, 16));
  MergeFront front(tree);
  RandomViews views(tree, 4);
  for (int frame = 0; frame < 50; ++frame) {
    front.update(ViewJudge(tree, views.camera(), views.criteria()));
    const DisplayMesh& display = front.display();
    ASSERT_EQ(display.indices().size(), 3 * display.triangle_count());
    std::set<std::uint32_t> vertices;
    for (std::size_t i = 0; i < display.indices().size(); ++i) {
      const std::uint32_t vertex = tree.triangles[display.shown()[i / 3]][i % 3];
      const std::size_t slot = display.indices()[i];
      vertices.insert(vertex);
      const Eigen::Vector3f place = tree.place(vertex);
      ASSERT_EQ(place, Eigen::Map<const Eigen::Vector3f>(&display.positions()[3 * slot]));
      ASSERT_EQ(tree.normals[vertex],
                Eigen::Map<const Eigen::Vector3f>(&display.normals()[3 * slot]));
    }
    ASSERT_EQ(vertices.size(), display.vertex_count());
  }
}

TEST(DisplayMesh, JoinsRangesThatAreNear) {
  const MergeTree tree = build_merge_tree(sphere(3));
  const DisplayMesh display(tree);
  EXPECT_EQ(display.changed_triangles(), (std::vector<ChangedRange>{{0, tree.coarsest_triangles}}));
}

}  // namespace
}  // namespace terrane::hierarchy
