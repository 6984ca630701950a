// Tetrahedra without interfaces: the mesh and its queues alone. "items" are bisected tetrahedra,
// each of which makes one cell more.
#include <benchmark/benchmark.h>

#include <cmath>

#include "hierarchy/volume/refinement_queues.h"
#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::hierarchy::volume {
namespace {

// refined around a sphere, as around an interface: cells of many levels side by side
double nearness(const TetraMesh& mesh, CellId leaf) {
  const auto [a, b] = mesh.split_edge(leaf);
  const Eigen::Vector3d middle = (mesh.position(a) + mesh.position(b)) / 2;
  const double distance = std::abs((middle - Eigen::Vector3d(0.5, 0.5, 0.5)).norm() - 0.37);
  return std::ldexp(1.0, -mesh.level(leaf) / 3) / (distance + 1e-3);
}

void queue_children(const TetraMesh& mesh, const Diamond& diamond, RefinementQueues& queues) {
  for (const CellId parent : diamond.parents) {
    queues.forget(parent);
    for (const CellId child : mesh.children(parent)) {
      queues.want_split(child, nearness(mesh, child));
    }
  }
}

std::size_t refine(TetraMesh& mesh, RefinementQueues& queues, std::size_t leaves) {
  const std::size_t before = mesh.leaf_count();
  while (mesh.leaf_count() < leaves) {
    queue_children(mesh, mesh.split_towards(queues.worst()->cell), queues);
  }
  return mesh.leaf_count() - before;
}

void start(const TetraMesh& mesh, RefinementQueues& queues) {
  mesh.for_each_leaf([&](CellId leaf) { queues.want_split(leaf, nearness(mesh, leaf)); });
}

void BM_SplitWorstFirst(benchmark::State& state) {
  std::size_t splits = 0;
  double bytes = 0;
  for (auto _ : state) {
    TetraMesh mesh{Box{}};
    RefinementQueues queues;
    start(mesh, queues);
    splits += refine(mesh, queues, static_cast<std::size_t>(state.range(0)));
    bytes = static_cast<double>(mesh.bytes()) / static_cast<double>(mesh.leaf_count());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(splits));
  state.counters["bytes_per_cell"] = bytes;
}
BENCHMARK(BM_SplitWorstFirst)
    ->Arg(10'000)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Unit(benchmark::kMillisecond);

// without queues: what the mesh itself costs
void BM_SplitUniformly(benchmark::State& state) {
  std::size_t splits = 0;
  for (auto _ : state) {
    TetraMesh mesh{Box{}};
    std::vector<CellId> leaves;
    while (mesh.leaf_count() < static_cast<std::size_t>(state.range(0))) {
      leaves.clear();
      mesh.for_each_leaf([&](CellId leaf) { leaves.push_back(leaf); });
      for (const CellId leaf : leaves) {
        while (mesh.is_leaf(leaf)) mesh.split_towards(leaf);
      }
    }
    splits += mesh.leaf_count() - 6;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(splits));
}
BENCHMARK(BM_SplitUniformly)->Arg(1'000'000)->Arg(10'000'000)->Unit(benchmark::kMillisecond);

// every diamond that can go, again and again, down to the six roots
void BM_MergeEverything(benchmark::State& state) {
  std::size_t merges = 0;
  for (auto _ : state) {
    state.PauseTiming();
    TetraMesh mesh{Box{}};
    RefinementQueues queues;
    start(mesh, queues);
    refine(mesh, queues, static_cast<std::size_t>(state.range(0)));
    merges += mesh.leaf_count() - 6;
    state.ResumeTiming();
    for (bool is_done = false; !is_done;) {
      is_done = true;
      for (std::uint32_t n = 0; n < mesh.node_capacity(); ++n) {
        if (!mesh.can_merge(NodeId{n})) continue;
        mesh.merge(NodeId{n});
        is_done = false;
      }
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(merges));
}
BENCHMARK(BM_MergeEverything)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace terrane::hierarchy::volume
