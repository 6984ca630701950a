#include "hierarchy/volume/tetra_mesh.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/errors.h"
#include "hierarchy/volume/refinement_queues.h"

namespace terrane::hierarchy::volume {
namespace {

using Lattice = std::array<std::uint32_t, 3>;
using Shape = std::multiset<double>;

const Box kCube{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)};

std::vector<CellId> leaves_of(const TetraMesh& mesh) {
  std::vector<CellId> leaves;
  mesh.for_each_leaf([&](CellId leaf) { leaves.push_back(leaf); });
  return leaves;
}

std::vector<NodeId> mergeable(const TetraMesh& mesh) {
  std::vector<NodeId> middles;
  for (std::uint32_t n = 0; n < mesh.node_capacity(); ++n) {
    if (mesh.has(NodeId{n}) && mesh.can_merge(NodeId{n})) middles.push_back(NodeId{n});
  }
  return middles;
}

double volume_of(const TetraMesh& mesh, CellId leaf) {
  const auto& c = mesh.corners(leaf);
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = mesh.position(c[i + 1]) - mesh.position(c[0]);
  return std::abs(edges.determinant()) / 6;
}

bool is_on_one_side_of_the_box(const std::array<Lattice, 3>& face) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t end : {0u, 1u << 30}) {
      if (std::ranges::all_of(face, [&](const Lattice& p) { return p[axis] == end; })) return true;
    }
  }
  return false;
}

// Knows nothing of rings and trees: faces are sets of three places. A hanging vertex would leave
// faces without a partner inside the box.
void expect_conforming(const TetraMesh& mesh) {
  std::map<std::array<Lattice, 3>, std::vector<CellId>> cells_at;
  double volume = 0;
  for (const CellId leaf : leaves_of(mesh)) {
    volume += volume_of(mesh, leaf);
    for (int i = 0; i < 4; ++i) {
      std::array<Lattice, 3> face;
      for (int k = 0; k < 3; ++k) face[k] = mesh.lattice(mesh.corners(leaf)[(i + 1 + k) % 4]);
      std::ranges::sort(face);
      cells_at[face].push_back(leaf);
    }
  }
  EXPECT_NEAR(volume, mesh.box().size().prod(), 1e-9 * mesh.box().size().prod());
  for (const auto& [face, cells] : cells_at) {
    ASSERT_EQ(cells.size(), is_on_one_side_of_the_box(face) ? 1 : 2);
    if (cells.size() == 1) continue;
    ASSERT_EQ(std::ranges::count(mesh.neighbours(cells[0]), cells[1]), 1);
    ASSERT_EQ(std::ranges::count(mesh.neighbours(cells[1]), cells[0]), 1);
  }
}

void split(TetraMesh& mesh, CellId cell) {
  while (mesh.is_leaf(cell)) mesh.split_towards(cell);
}

std::set<std::array<Lattice, 4>> places(const TetraMesh& mesh) {
  std::set<std::array<Lattice, 4>> cells;
  for (const CellId leaf : leaves_of(mesh)) {
    std::array<Lattice, 4> cell;
    std::ranges::transform(mesh.corners(leaf), cell.begin(),
                           [&](NodeId node) { return mesh.lattice(node); });
    std::ranges::sort(cell);
    cells.insert(cell);
  }
  return cells;
}

TEST(TetraMesh, StartsAsSixTetrahedraAroundTheDiagonal) {
  const TetraMesh mesh(kCube);
  EXPECT_EQ(mesh.leaf_count(), 6);
  EXPECT_EQ(mesh.node_count(), 8);
  for (const CellId leaf : leaves_of(mesh)) {
    EXPECT_DOUBLE_EQ(volume_of(mesh, leaf), 1.0 / 6);
    const auto [a, b] = mesh.split_edge(leaf);
    EXPECT_EQ((mesh.position(b) - mesh.position(a)).cwiseAbs(), Eigen::Vector3d::Ones());
  }
  expect_conforming(mesh);
}

TEST(TetraMesh, UniformBisectionDoublesTheCellsAndKnowsThreeShapes) {
  TetraMesh mesh(kCube);
  std::set<std::vector<long>> shapes;
  for (int level = 1; level <= 9; ++level) {
    for (const CellId leaf : leaves_of(mesh)) split(mesh, leaf);
    EXPECT_EQ(mesh.leaf_count(), std::size_t{6} << level);
    for (const CellId leaf : leaves_of(mesh)) {
      ASSERT_EQ(mesh.level(leaf), level);
      std::vector<double> edges;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          edges.push_back(
              (mesh.position(mesh.corners(leaf)[i]) - mesh.position(mesh.corners(leaf)[j]))
                  .squaredNorm());
        }
      }
      std::ranges::sort(edges);
      std::vector<long> ratios;
      for (const double edge : edges) ratios.push_back(std::lround(12 * edge / edges.front()));
      shapes.insert(ratios);
    }
    expect_conforming(mesh);
  }
  EXPECT_EQ(shapes.size(), 3);
  // three levels halve the cubes: the vertices of level 9 are the corners of 8 x 8 x 8 cubes
  EXPECT_EQ(mesh.node_count(), 9 * 9 * 9);
}

TEST(TetraMesh, BisectsTheLongestEdgeInACube) {
  TetraMesh mesh(kCube);
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const auto leaves = leaves_of(mesh);
    split(mesh, leaves[random() % leaves.size()]);
  }
  for (const CellId leaf : leaves_of(mesh)) {
    const auto [a, b] = mesh.split_edge(leaf);
    const double length = (mesh.position(a) - mesh.position(b)).norm();
    for (const NodeId c : mesh.corners(leaf)) {
      for (const NodeId d : mesh.corners(leaf)) {
        EXPECT_LE((mesh.position(c) - mesh.position(d)).norm(), length * (1 + 1e-12));
      }
    }
  }
}

TEST(TetraMesh, StaysConformingThroughRandomSplitsAndMerges) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    TetraMesh mesh({Eigen::Vector3d(-3, 2, 0), Eigen::Vector3d(7, 4, 1)});
    for (int round = 0; round < 25; ++round) {
      for (int i = 0; i < 40; ++i) {
        const auto middles = mergeable(mesh);
        if (random() % 3 == 0 && !middles.empty()) {
          mesh.merge(middles[random() % middles.size()]);
        } else {
          const auto leaves = leaves_of(mesh);
          mesh.split_towards(leaves[random() % leaves.size()]);
        }
      }
      expect_conforming(mesh);
    }
  }
}

TEST(TetraMesh, StaysConformingWhenRefinedDeepIntoACorner) {
  TetraMesh mesh(kCube);
  CellId cell{0};
  for (int level = 0; level < TetraMesh::kMostLevels; ++level) {
    split(mesh, cell);
    cell = mesh.children(cell)[0];
  }
  EXPECT_EQ(mesh.level(cell), TetraMesh::kMostLevels);
  expect_conforming(mesh);
}

TEST(TetraMesh, MergingEverythingLeavesTheSixRoots) {
  TetraMesh mesh(kCube);
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const auto leaves = leaves_of(mesh);
    split(mesh, leaves[random() % leaves.size()]);
  }
  for (auto middles = mergeable(mesh); !middles.empty(); middles = mergeable(mesh)) {
    mesh.merge(middles[random() % middles.size()]);
  }
  EXPECT_EQ(places(mesh), places(TetraMesh(kCube)));
  EXPECT_EQ(mesh.node_count(), 8);
  expect_conforming(mesh);
}

TEST(TetraMesh, TheOrderOfSplitsDoesNotMatter) {
  const auto refine = [](unsigned seed) {
    TetraMesh mesh(kCube);
    std::mt19937 random(seed);
    const auto is_wanted = [&](CellId leaf) {
      return mesh.level(leaf) < 12 && std::ranges::any_of(mesh.corners(leaf), [&](NodeId node) {
               return (mesh.position(node) - Eigen::Vector3d(0.3, 0.6, 0.1)).norm() <
                      0.05 * (13 - mesh.level(leaf));
             });
    };
    for (;;) {
      auto leaves = leaves_of(mesh);
      std::erase_if(leaves, [&](CellId leaf) { return !is_wanted(leaf); });
      if (leaves.empty()) return places(mesh);
      mesh.split_towards(leaves[random() % leaves.size()]);
    }
  };
  const auto first = refine(1);
  EXPECT_GT(first.size(), 200);
  EXPECT_EQ(first, refine(2));
}

TEST(TetraMesh, NeedsAtMost64BytesForATetrahedron) {
  TetraMesh mesh(kCube);
  for (int level = 0; level < 12; ++level) {
    for (const CellId leaf : leaves_of(mesh)) split(mesh, leaf);
  }
  EXPECT_LE(static_cast<double>(mesh.bytes()) / static_cast<double>(mesh.leaf_count()), 64);
}

TEST(TetraMesh, RefusesABoxWithoutExtent) {
  EXPECT_THROW(TetraMesh({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 1)}), ConfigError);
  EXPECT_THROW(TetraMesh({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, NAN, 1)}), ConfigError);
}

TEST(RefinementQueues, ServesTheWorstLeafAndTheLeastDiamondOfThoseThatHold) {
  RefinementQueues queues;
  EXPECT_FALSE(queues.worst().has_value());
  queues.want_split(CellId{4}, 2);
  queues.want_split(CellId{5}, 3);
  queues.want_split(CellId{6}, 3);
  EXPECT_EQ(queues.worst()->cell, CellId{5});
  queues.want_split(CellId{5}, 1);
  EXPECT_EQ(queues.worst()->cell, CellId{6});
  queues.forget(CellId{6});
  EXPECT_EQ(queues.worst()->cell, CellId{4});
  queues.allow_merge(NodeId{1}, 5);
  queues.allow_merge(NodeId{2}, 4);
  EXPECT_EQ(queues.least()->middle, NodeId{2});
  queues.forget(NodeId{2});
  EXPECT_DOUBLE_EQ(queues.least()->worth, 5);
}

}  // namespace
}  // namespace terrane::hierarchy::volume
