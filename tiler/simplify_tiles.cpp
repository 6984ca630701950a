#include "tiler/simplify_tiles.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "tiler/build_tile.h"
#include "tiler/seams/build_seam.h"

namespace terrane::tiler {
namespace {

using hierarchy::GridPoint;
using hierarchy::kUnitsPerCell;
using hierarchy::TerrainMesh;

/// The flat map of a DEM: metres along the columns and against the rows.
class FlatPlace final : public Georeference {
 public:
  explicit FlatPlace(const GridFeatures& features)
      : column_m_(features.column_m), row_m_(features.row_m) {}

  const std::string& crs_wkt() const override { return none_; }
  PlanPosition to_plan(GridPosition p) const override {
    return {p.column * column_m_, -p.row * row_m_};
  }
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition>) const override {
    return {};  // asked only where there is a CRS
  }

 private:
  std::string none_;
  double column_m_, row_m_;
};

/// Steps that are the units of GridPoint, and those that heights are written in.
std::vector<Eigen::Vector3d> steps_m(const SimplifyOptions& options, int levels) {
  const GridFeatures& features = options.features;
  const Eigen::Vector3d step_m(features.column_m / kUnitsPerCell, features.row_m / kUnitsPerCell,
                               1 / options.height_steps_per_m);
  return std::vector<Eigen::Vector3d>(static_cast<std::size_t>(levels), step_m);
}

/// What is kept of a tile until all are done.
struct Piece {
  std::vector<LatticePoint> points;
  std::vector<hierarchy::Corners> triangles;
  std::vector<hierarchy::LineEdge> lines;
};

struct PlanHash {
  std::size_t operator()(const std::pair<std::int64_t, std::int64_t>& plan) const {
    const auto x = static_cast<std::uint64_t>(plan.first);
    return std::hash<std::uint64_t>()(x * 0x9E3779B97F4A7C15U ^
                                      static_cast<std::uint64_t>(plan.second));
  }
};

/// Joins tiles whose borders are equal as integers.
class Weld {
 public:
  Weld(GridShape shape, double height_steps_per_m)
      : first_{-(shape.columns - 1) * kUnitsPerCell / 2, (shape.rows - 1) * kUnitsPerCell / 2},
        steps_per_m_(height_steps_per_m) {}

  void add(const Piece& piece) {
    std::vector<std::uint32_t> here;
    here.reserve(piece.points.size());
    for (const LatticePoint& point : piece.points) here.push_back(vertex_at(point));
    for (const auto& [a, b, c] : piece.triangles) {
      mesh_.triangles.push_back({here[a], here[b], here[c]});
    }
    for (const auto& [a, b] : piece.lines) {
      mesh_.lines.push_back({std::min(here[a], here[b]), std::max(here[a], here[b])});
    }
  }

  TerrainMesh take() {
    // a line along a seam is in both tiles
    std::ranges::sort(mesh_.lines);
    mesh_.lines.erase(std::unique(mesh_.lines.begin(), mesh_.lines.end()), mesh_.lines.end());
    return std::move(mesh_);
  }

 private:
  std::uint32_t vertex_at(const LatticePoint& point) {
    // the world's origin is the middle of the grid
    const std::pair plan{point.i - first_.first, point.j - first_.second};
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [found, is_new] = vertices_.emplace(plan, next);
    if (is_new) {
      const GridPoint at{static_cast<std::int32_t>(plan.first),
                         static_cast<std::int32_t>(plan.second)};
      const LatticePoint written{at.x, at.y, point.k};
      mesh_.vertices.push_back(
          {.place = {at, static_cast<double>(point.k) / steps_per_m_, written}});
    }
    return found->second;
  }

  std::pair<std::int64_t, std::int64_t> first_;
  double steps_per_m_;
  std::unordered_map<std::pair<std::int64_t, std::int64_t>, std::uint32_t, PlanHash> vertices_;
  TerrainMesh mesh_;
};

/// What tiles are built from; as it refers to itself, it stays where it is.
class FlatTiles {
 public:
  FlatTiles(const HeightSource& heights, const SimplifyOptions& options)
      : place_(options.features),
        world_(place_, heights.shape()),
        pyramid_(heights.shape(), kSimplifyTileCells),
        lattice_(steps_m(options, pyramid_.level_count())),
        source_{heights, world_, pyramid_, lattice_, options.effort} {
    if (options.features.lines.empty()) return;
    const std::vector<double> tolerances_m(static_cast<std::size_t>(pyramid_.level_count()),
                                           options.tolerance_m);
    source_.features = &features_.emplace(options.features, pyramid_, lattice_, tolerances_m);
  }
  FlatTiles(const FlatTiles&) = delete;
  FlatTiles& operator=(const FlatTiles&) = delete;

  const Pyramid& pyramid() const { return pyramid_; }
  const TileSource& source() const { return source_; }

 private:
  FlatPlace place_;
  WorldFrame world_;
  Pyramid pyramid_;
  Lattice lattice_;
  std::optional<TileFeatures> features_;
  TileSource source_;
};

using Chains = std::map<SeamId, SeamChain>;

Chains build_chains(const FlatTiles& tiles, double tolerance_m, Progress& progress) {
  Chains chains;
  for (const SeamId& seam : seams(tiles.pyramid(), 0)) chains[seam];
  tbb::parallel_for_each(chains, [&](Chains::value_type& chain) {
    chain.second = build_leaf_seam(tiles.source(), chain.first, tolerance_m);
    progress.advance(1);
  });
  return chains;
}

std::vector<Piece> build_pieces(const FlatTiles& tiles, const Chains& chains, double tolerance_m,
                                Progress& progress) {
  const std::vector<TileId> ids = tiles.pyramid().tiles(0);
  std::vector<Piece> pieces(ids.size());
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t n) {
    std::vector<SeamChain> of_tile;
    for (const SeamId& seam : seams_of(tiles.pyramid(), ids[n])) {
      of_tile.push_back(chains.at(seam));
    }
    TileMesh mesh = build_leaf(tiles.source(), ids[n], of_tile, tolerance_m).mesh;
    pieces[n] = {std::move(mesh.points), std::move(mesh.triangles), std::move(mesh.lines)};
    progress.advance(1);
  });
  return pieces;
}

}  // namespace

TerrainMesh simplify_in_tiles(const HeightSource& heights, const SimplifyOptions& options,
                              double tolerance_m, Progress& progress) {
  const FlatTiles tiles(heights, options);
  const auto seam_count = std::ssize(seams(tiles.pyramid(), 0));
  progress.begin("simplify in tiles", seam_count + std::ssize(tiles.pyramid().tiles(0)));
  const Chains chains = build_chains(tiles, tolerance_m, progress);
  Weld weld(heights.shape(), options.height_steps_per_m);
  for (const Piece& piece : build_pieces(tiles, chains, tolerance_m, progress)) weld.add(piece);
  return weld.take();
}

}  // namespace terrane::tiler
