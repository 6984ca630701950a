// One table: terrane and its peers on one grid, with one independent measure of the error.
//
//   terrane_peers DEM [NAME]     a DEM without voids; only peers whose name begins with NAME
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <span>

#include "core/errors.h"
#include "core/progress.h"
#include "count_search.h"
#include "hierarchy/mesh/grid_triangles.h"
#include "ingest/dem.h"
#include "mesh_judge.h"
#include "peer.h"

namespace terrane::peers {
namespace {

constexpr double kTolerances_m[] = {1, 2, 5, 10, 20};

Terrain terrain_of(const ingest::Dem& dem) {
  const GridShape shape = dem.heights().shape();
  Terrain terrain{dem.heights(), dem.heights().read({0, 0, shape.columns, shape.rows}), 1, 1, {}};
  if (std::ranges::any_of(terrain.grid.heights_m, [](float h) { return std::isnan(h); })) {
    throw InputError(
        fmt::format("{}: has voids, which the peers know nothing of. Cut them off with "
                    "gdal_translate -srcwin",
                    dem.name()));
  }
  const auto step_m = [&](GridPosition to) {
    const PlanPosition a = dem.place().to_plan({0, 0}), b = dem.place().to_plan(to);
    return std::hypot(b.x - a.x, b.y - a.y);
  };
  terrain.column_m = step_m({1, 0});
  terrain.row_m = step_m({0, 1});
  hierarchy::GridTriangles full = hierarchy::triangulate(terrain.grid, terrain.grid.window);
  for (const hierarchy::SampleId& s : full.vertices) {
    terrain.full.points.push_back({static_cast<double>(s.column), static_cast<double>(s.row),
                                   terrain.grid.at(s.column, s.row)});
  }
  terrain.full.triangles = std::move(full.triangles);
  return terrain;
}

void print_row(const Peer& peer, double tolerance_m, const std::optional<Run>& run) {
  if (!run) {
    fmt::print("| {} | | {} | not reached | | | | | |\n", peer.name, tolerance_m);
  } else {
    const Verdict& v = run->verdict;
    fmt::print("| {} | {} | {} | {} | {:.3f} | {:.3f} | {} | {} | {:.2f} |\n", peer.name,
               peer.setting, tolerance_m, run->triangles, v.max_m, v.rms_m, v.uncovered, v.folded,
               run->cpu_s);
  }
  std::fflush(stdout);
}

/// One setting of a peer and what is known of it.
struct Contender {
  const Peer& peer;
  CountSearch search;

  std::optional<Run> run(const Terrain& terrain, double tolerance_m) {
    if (peer.by_count) return search.fewest_within(tolerance_m);
    return kept(terrain, tolerance_m);
  }

 private:
  static bool holds(const std::optional<Run>& run, double tolerance_m) {
    return run && run->verdict.max_m <= tolerance_m * (1 + 1e-9);
  }

  /// With the tolerance itself, or the largest smaller one with which the real one is kept.
  std::optional<Run> kept(const Terrain& terrain, double tolerance_m) const {
    std::optional<Run> best = with(terrain, tolerance_m);
    if (!best || holds(best, tolerance_m)) return best;
    best.reset();
    double keeps_m = tolerance_m / 8, breaks_m = tolerance_m;
    for (int halvings = 0; halvings < 8; ++halvings) {
      const double middle_m = (keeps_m + breaks_m) / 2;
      const std::optional<Run> run = with(terrain, middle_m);
      (holds(run, tolerance_m) ? keeps_m : breaks_m) = middle_m;
      if (holds(run, tolerance_m)) best = run;
    }
    return best;
  }

  std::optional<Run> with(const Terrain& terrain, double asked_m) const {
    const auto answer = peer.by_tolerance(terrain, asked_m);
    if (!answer) return std::nullopt;
    return Run{answer->mesh.triangles.size(), judge(answer->mesh, terrain.grid), answer->cpu_s};
  }
};

/// One row for each tolerance: the setting with the fewest triangles.
void compare(std::span<const Peer> settings, const Terrain& terrain) {
  std::vector<Contender> contenders;
  for (const Peer& peer : settings) contenders.push_back({peer, CountSearch(peer, terrain)});
  for (const double tolerance_m : kTolerances_m) {
    const Peer* winner = &settings.front();
    std::optional<Run> best;
    for (Contender& contender : contenders) {
      const std::optional<Run> run = contender.run(terrain, tolerance_m);
      if (!run || (best && best->triangles <= run->triangles)) continue;
      winner = &contender.peer;
      best = run;
    }
    print_row(*winner, tolerance_m, best);
  }
}

std::vector<Peer> all_peers() {
  std::vector<Peer> all;
  for (const auto& some : {terrane_peers(), meshoptimizer_peers(), openmesh_peers(),
#ifdef TERRANE_PEERS_CGAL
                           cgal_peers(),
#endif
                           node_peers()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

void run(const std::string& file, const std::string& wanted) {
  NoProgress progress;
  const auto dem = ingest::open_dem({file}, {}, progress);
  const Terrain terrain = terrain_of(*dem);
  fmt::print("{} samples, {} triangles\n\n", terrain.grid.heights_m.size(),
             terrain.full.triangles.size());
  fmt::print(
      "| | best setting | tolerance m | triangles | max m | rms m | uncovered | folded | CPU s |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  const std::vector<Peer> all = all_peers();
  for (auto first = all.begin(); first != all.end();) {
    const auto last =
        std::find_if(first, all.end(), [&](const Peer& peer) { return peer.name != first->name; });
    if (first->name.starts_with(wanted)) compare({first, last}, terrain);
    first = last;
  }
}

}  // namespace

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace terrane::peers

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: terrane_peers DEM [NAME]\n");
    return 2;
  }
  try {
    terrane::peers::run(argv[1], argc > 2 ? argv[2] : "");
    return 0;
  } catch (const terrane::Error& error) {
    fmt::print(stderr, "terrane_peers: {}\n", error.what());
    return error.exit_status();
  }
}
