// The stages of `terrane build` on St. Helens, 30 m (327 x 468 samples), or on a synthetic caldera
// of about the same size where that file is not at hand: the label says which.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "core/freed_memory.h"
#include "ingest/scan.h"
#include "tiler/build.h"
#include "tiler/build_tile.h"
#include "tiler/gltf/write_glb.h"
#include "tiler/seams/build_seam.h"
#include "tiler/simplify.h"

namespace terrane {
namespace {

constexpr double kTolerance_m = 1;
const char* const kStHelens = TERRANE_TEST_DATA "/st_helens/SainteHelens_post1980_30m.dem";

std::string source() {
  return std::filesystem::exists(kStHelens) ? kStHelens : "synthetic:caldera?size=391&seed=1";
}

struct Dem {
  NoProgress progress;
  std::unique_ptr<ingest::Dem> opened = ingest::open_dem({source()}, {}, progress);
  HeightStatistics statistics = ingest::scan_heights(*opened, progress);
  GridShape shape = opened->heights().shape();
  tiler::Pyramid pyramid{shape, 64};
  tiler::WorldFrame world{opened->place(), shape};
  tiler::Lattice lattice{pyramid, world, statistics, kTolerance_m};
  tiler::TileSource tiles{opened->heights(), world, pyramid, lattice};

  std::int64_t samples() const { return shape.columns * shape.rows; }
};

// a tile in the middle, all of whose cells hold data
const tiler::TileId kLeaf{0, 2, 3};

void BM_OpenAndScan(benchmark::State& state) {
  NoProgress progress;
  std::int64_t samples = 0;
  for (auto _ : state) {
    const auto dem = ingest::open_dem({source()}, {}, progress);
    benchmark::DoNotOptimize(ingest::scan_heights(*dem, progress));
    samples = dem->heights().shape().columns * dem->heights().shape().rows;
  }
  state.SetItemsProcessed(state.iterations() * samples);
  state.SetLabel(source() + ", samples");
}
BENCHMARK(BM_OpenAndScan)->Unit(benchmark::kMillisecond);

/// The seams of a leaf tile, thinned out.
std::vector<tiler::SeamChain> leaf_seams(const Dem& dem, const tiler::TileId& tile) {
  std::vector<tiler::SeamChain> chains;
  for (const tiler::SeamId& seam : tiler::seams_of(dem.pyramid, tile)) {
    chains.push_back(tiler::build_leaf_seam(dem.tiles, seam, kTolerance_m));
  }
  return chains;
}

// a column of 65 samples at level 0
void BM_BuildLeafSeam(benchmark::State& state) {
  const Dem dem;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        tiler::build_leaf_seam(dem.tiles, {kLeaf, true}, static_cast<double>(state.range(0))));
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel("seams");
}
BENCHMARK(BM_BuildLeafSeam)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMillisecond);

// level 0 of one tile: 8,192 triangles in
void BM_BuildLeaf(benchmark::State& state) {
  const Dem dem;
  const auto seams = leaf_seams(dem, kLeaf);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        tiler::build_leaf(dem.tiles, kLeaf, seams, static_cast<double>(state.range(0))));
  }
  state.SetItemsProcessed(state.iterations() * 8192);
  state.SetLabel("input triangles");
}
BENCHMARK(BM_BuildLeaf)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMillisecond);

// level 1 of one tile from its four children, the blend checked; its seams as they come
void BM_BuildParent(benchmark::State& state) {
  const Dem dem;
  std::vector<tiler::TileMesh> children;
  std::int64_t triangles = 0;
  for (const tiler::TileId& child : dem.pyramid.children(dem.pyramid.parent(kLeaf))) {
    children.push_back(
        tiler::build_leaf(dem.tiles, child, leaf_seams(dem, child), kTolerance_m).mesh);
    triangles += static_cast<std::int64_t>(children.back().triangles.size());
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        tiler::build_parent(dem.tiles, dem.pyramid.parent(kLeaf), children, {}, 2 * kTolerance_m));
  }
  state.SetItemsProcessed(state.iterations() * triangles);
  state.SetLabel("input triangles");
}
BENCHMARK(BM_BuildParent)->Unit(benchmark::kMillisecond);

void BM_EncodeTile(benchmark::State& state) {
  const Dem dem;
  const tiler::TileMesh mesh =
      tiler::build_leaf(dem.tiles, kLeaf, leaf_seams(dem, kLeaf), kTolerance_m).mesh;
  std::size_t bytes = 0;
  for (auto _ : state) {
    bytes = tiler::encode_glb({.id = kLeaf,
                               .mesh = mesh,
                               .targets = mesh.points,
                               .step_m = dem.lattice.step_m(0),
                               .tolerance_m = kTolerance_m,
                               .heights = dem.statistics},
                              {})
                .size();
    benchmark::DoNotOptimize(bytes);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
  state.counters["bytes"] = static_cast<double>(bytes);
  state.SetLabel("triangles");
}
BENCHMARK(BM_EncodeTile)->Unit(benchmark::kMillisecond);

/// Samples in memory.
class GridSource final : public HeightSource {
 public:
  explicit GridSource(HeightGrid grid) : grid_(std::move(grid)) {
    grid_.window = {0, 0, grid_.window.columns, grid_.window.rows};
  }
  GridShape shape() const override { return {grid_.window.columns, grid_.window.rows}; }
  HeightGrid read(const Window&) const override { return grid_; }

 private:
  HeightGrid grid_;
};

/// St. Helens without its rim: 290,088 triangles, the grid of docs/benchmarks.md's tables.
Window without_rim(const GridShape& shape) {
  return {5, 4, std::min<std::int64_t>(317, shape.columns - 5),
          std::min<std::int64_t>(460, shape.rows - 4)};
}

// level 0 as one mesh, default effort: from samples in memory to a measured mesh in memory
void BM_Simplify(benchmark::State& state) {
  NoProgress progress;
  const Dem dem;
  const GridSource source(dem.opened->heights().read(without_rim(dem.shape)));
  std::int64_t triangles = 0;
  for (auto _ : state) {
    const auto result = tiler::simplify(
        source, {.tolerance_m = static_cast<double>(state.range(0)), .features = {}}, progress);
    triangles = result.input_triangles;
  }
  state.SetItemsProcessed(state.iterations() * triangles);
  state.SetLabel("input triangles");
}
BENCHMARK(BM_Simplify)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMillisecond);

// everything, to files, on one core
void BM_BuildAllLevels(benchmark::State& state) {
  NoProgress progress;
  const Dem dem;
  const auto out = std::filesystem::temp_directory_path() / "terrane_bench";
  for (auto _ : state) {
    state.PauseTiming();
    std::filesystem::remove_all(out);
    state.ResumeTiming();
    benchmark::DoNotOptimize(tiler::build(
        dem.opened->heights(), dem.opened->place(), dem.statistics,
        {.tolerance_m = static_cast<double>(state.range(0)), .jobs = 1}, out, progress));
  }
  std::filesystem::remove_all(out);
  state.SetItemsProcessed(state.iterations() * dem.samples());
  state.SetLabel("samples");
}
BENCHMARK(BM_BuildAllLevels)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace terrane

int main(int argc, char** argv) {
  terrane::keep_freed_memory();  // as the program does
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
