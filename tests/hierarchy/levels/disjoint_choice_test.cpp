#include "hierarchy/levels/disjoint_choice.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

/// The triangles of a mesh, weighed, at its first level.
struct Weighed {
  explicit Weighed(const SurfaceMesh& mesh, int jobs = 1)
      : level(mesh),
        judges(level, Rules::kTightened, jobs),
        table(level, kStHelensWeights),
        order(level, table, judges),
        choice(level, table, judges) {
    judges.for_each_index(level.mesh.triangle_count(), [&](CollapseJudge& judge, std::size_t i) {
      const TriangleId t{static_cast<std::uint32_t>(i)};
      if (level.mesh.is_ghost(t)) return;
      table.bound(t);
      table.fit(judge, t);
    });
    table.set_largest_curvature();
    table.begin_level(1);
    count = order.begin_level();
    choice.begin_level();
    order.next_portion(count, choice.taken());
  }

  LevelMesh level;
  JudgePool judges;
  WeightTable table;
  WeightOrder order;
  DisjointChoice choice;
  std::size_t count = 0;
};

std::set<std::uint32_t> triangles_of(const std::vector<Chosen>& chosen) {
  std::set<std::uint32_t> result;
  for (const Chosen& c : chosen) result.insert(c.entry.triangle);
  return result;
}

/// Triangles that share a vertex with t, from the list of all.
std::set<std::uint32_t> stencil_of(std::uint32_t t, const SurfaceMesh& mesh) {
  std::set<std::uint32_t> result;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (std::ranges::find(mesh.triangles[i], v) != mesh.triangles[i].end()) result.insert(i);
    }
  }
  return result;
}

/// The queue as the paper has it: one triangle after the other, by weight.
std::set<std::uint32_t> walked(const SurfaceMesh& mesh, std::vector<Waiting> queue,
                               const Weighed& weighed) {
  std::sort(queue.begin(), queue.end());
  CollapseJudge judge(weighed.level, Rules::kTightened);
  std::set<std::uint32_t> taken, covered;
  for (const Waiting& waiting : queue) {
    const auto stencil = stencil_of(waiting.triangle, mesh);
    if (std::ranges::any_of(stencil, [&](std::uint32_t i) { return covered.contains(i); })) {
      continue;
    }
    const TriangleId t{waiting.triangle};
    const auto frame = judge.frame(t);
    if (!frame || !judge.plan(t, *frame, weighed.table.surface(t))) continue;
    taken.insert(waiting.triangle);
    covered.insert(stencil.begin(), stencil.end());
  }
  return taken;
}

SurfaceMesh rough_mesh(unsigned seed) {
  std::mt19937 random(seed);
  SurfaceMesh mesh = seed % 2 == 0
                         ? testing::sheet(14, 11, [](double x, double y) { return x * y; })
                         : testing::torus(16, 9);
  // the last two as they are: many triangles of one weight
  if (seed < 8) testing::jitter(mesh, 0.05, random);
  return mesh;
}

TEST(DisjointChoice, TakesWhatAWalkThroughTheQueueTakes) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const SurfaceMesh mesh = rough_mesh(seed);
    Weighed weighed(mesh);
    auto& all = weighed.order.lightest_of_portion(weighed.count);
    ASSERT_EQ(all.size(), mesh.triangles.size());
    const auto expected = walked(mesh, all, weighed);
    weighed.choice.choose(all);
    EXPECT_EQ(triangles_of(weighed.choice.chosen()), expected) << "seed " << seed;
    EXPECT_GT(expected.size(), 2U);
  }
}

TEST(DisjointChoice, IsTheSameByPartsAndOnManyThreads) {
  const SurfaceMesh mesh = rough_mesh(1);
  Weighed whole(mesh), parts(mesh, 4);
  whole.choice.choose(whole.order.lightest_of_portion(whole.count));
  for (;;) {
    auto& part = parts.order.lightest_of_portion(20);
    if (part.empty()) break;
    parts.choice.choose(part);
  }
  EXPECT_EQ(triangles_of(parts.choice.chosen()), triangles_of(whole.choice.chosen()));
}

TEST(DisjointChoice, SaysOfEachTriangleWhyItWasNotTaken) {
  const SurfaceMesh mesh = rough_mesh(0);
  Weighed weighed(mesh);
  weighed.choice.choose(weighed.order.lightest_of_portion(weighed.count));
  std::size_t count = weighed.choice.chosen().size();
  for (const std::uint32_t rejected : weighed.choice.rejected()) count += rejected;
  EXPECT_EQ(count, mesh.triangles.size());
}

TEST(DisjointChoice, KeepsTheLightest) {
  Weighed weighed(rough_mesh(1));
  weighed.choice.choose(weighed.order.lightest_of_portion(weighed.count));
  std::vector<Chosen> all = weighed.choice.chosen();
  ASSERT_GT(all.size(), 3U);
  std::ranges::sort(all, [](const Chosen& a, const Chosen& b) { return a.entry < b.entry; });
  all.resize(3);
  weighed.choice.keep_lightest(3);
  EXPECT_EQ(triangles_of(weighed.choice.chosen()), triangles_of(all));
}

}  // namespace
}  // namespace terrane::hierarchy
