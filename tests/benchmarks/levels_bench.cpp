// The published hierarchy, levels 0 to 30: grids of about 100,000, 300,000 and 1.2 million
// triangles of synthetic terrain, and St. Helens, 30 m, where that file is at hand.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "hierarchy/levels/build_levels.h"
#include "hierarchy/levels/grid_surface.h"
#include "ingest/dem.h"

namespace terrane::hierarchy {
namespace {

const char* const kStHelens = TERRANE_TEST_DATA "/st_helens/SainteHelens_post1980_30m.dem";

SurfaceMesh mesh_of(const std::string& source) {
  NoProgress progress;
  const auto dem = ingest::open_dem({source}, {}, progress);
  const GridShape shape = dem->heights().shape();
  return surface_of(dem->heights().read({0, 0, shape.columns, shape.rows}), 30, 30);
}

void build(benchmark::State& state, const SurfaceMesh& finest, const LevelOptions& options) {
  std::size_t left = 0;
  for (auto _ : state) {
    const LevelSequence sequence = build_levels(finest, options);
    left = sequence.coarsest_triangles.size();
    benchmark::DoNotOptimize(left);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(finest.triangles.size()));
  state.counters["left_%"] =
      100 * static_cast<double>(left) / static_cast<double>(finest.triangles.size());
}

// by thousands of triangles; the rate is to stay the same
void BM_LevelsOfTerrain(benchmark::State& state) {
  const auto size =
      static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)) * 500))) + 1;
  build(state, mesh_of(fmt::format("synthetic:caldera?size={}&seed=1", size)),
        {.jobs = static_cast<int>(state.range(1))});
}
BENCHMARK(BM_LevelsOfTerrain)
    ->ArgsProduct({{100, 300, 1200, 4800}, {1, 2}})
    ->ArgNames({"thousand", "jobs"})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void BM_LevelsOfStHelens(benchmark::State& state) {
  if (!std::filesystem::exists(kStHelens)) {
    state.SkipWithError("St. Helens is not at hand");
    return;
  }
  build(state, mesh_of(kStHelens),
        {.weights = state.range(0) == 0 ? kStHelensWeights : kCraterLakeWeights,
         .rules = state.range(1) == 0 ? Rules::kTightened : Rules::kPublished,
         .jobs = static_cast<int>(state.range(2))});
}
BENCHMARK(BM_LevelsOfStHelens)
    ->ArgNames({"with_error", "published", "jobs"})
    ->Args({0, 0, 1})
    ->Args({0, 0, 2})
    ->Args({0, 1, 1})
    ->Args({1, 0, 1})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace terrane::hierarchy
