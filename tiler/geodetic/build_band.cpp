#include "tiler/geodetic/build_band.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "core/errors.h"
#include "tiler/build_tile.h"
#include "tiler/files/output_folder.h"
#include "tiler/geodetic/grid_lattice.h"
#include "tiler/level_rounds.h"
#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {
namespace {

class BandBuild {
 public:
  BandBuild(const GeodeticHeights& heights, const BandOptions& options, const WriteTerrain& write,
            Progress& progress)
      : options_(options),
        write_(write),
        band_(heights, options.tiles),
        // where the last tile meets the first there is no seam: both keep every post there
        pyramid_(band_.shape(), kGeodeticTileCells, /*levels_per_octave=*/1,
                 options.tiles.columns == GeodeticZoom{options.tiles.zoom}.tiles_around()),
        world_(band_, band_.shape()),
        lattice_(options.tiles, world_, heights.min_height_m(), heights.max_height_m(),
                 options.tolerance_m),
        source_{band_,
                world_,
                pyramid_,
                lattice_,
                hierarchy::kDefaultEffort,
                nullptr,
                options.holds_dem_samples ? &band_ : nullptr},
        folder_(options.work),
        rounds_(source_, folder_, options.tolerance_m, options.jobs, progress) {
    const std::array<double, 16> transform = world_.to_ecef();
    to_ecef_ = Eigen::Map<const Eigen::Matrix4d>(transform.data()).topLeftCorner<3, 3>();
  }

  std::vector<TileRecord> run() {
    check_frames();
    for (int level = 0; level < level_count(); ++level) {
      rounds_.build(level, fmt::format("zoom {}", options_.tiles.zoom - level),
                    [this](const TileId& tile) { build_tile(tile); });
    }
    std::vector<TileRecord> records;
    for (const TileId& tile : pyramid_.tiles(level_count() - 1)) {
      const FinishedTile finished = read_finished_tile(folder_.finished_tile(tile));
      records.insert(records.end(), finished.descendants.begin(), finished.descendants.end());
    }
    return records;
  }

 private:
  /// What curves farther round the Earth than a polynomial follows is refused before a tile is
  /// built.
  void check_frames() const {
    const int top = level_count() - 1;
    std::vector<Window> windows;
    for (const TileId& tile : pyramid_.tiles(top)) windows.push_back(pyramid_.window(tile));
    // seams of posts take a strip of them alone
    for (const SeamId& seam : top > 0 ? seams(pyramid_, top) : std::vector<SeamId>{}) {
      windows.push_back(both_sides(pyramid_, seam));
    }
    for (const Window& window : windows) {
      try {
        const TileFrame frame(world_, lattice_, window, top);
      } catch (const InputError&) {
        throw ConfigError(fmt::format(
            "--tolerance {}: is too small for tiles of zoom {}, which reach far round the Earth. "
            "Use a larger one, or a larger --max-zoom",
            options_.tolerance_m.front(), options_.tiles.zoom - top));
      }
    }
  }

  int level_count() const { return static_cast<int>(options_.tolerance_m.size()); }

  void build_tile(const TileId& tile) const {
    const double tolerance_m = options_.tolerance_m[tile.level];
    const std::vector<SeamChain> seams = rounds_.seams_of_tile(tile);
    const FinishedChildren children = rounds_.children_of(tile);
    FinishedTile finished;
    for (const auto& of_child : children.descendants) {
      finished.descendants.insert(finished.descendants.end(), of_child.begin(), of_child.end());
    }
    finished.mesh = tile.level == 0
                        ? build_leaf(source_, tile, seams, tolerance_m).mesh
                        : build_parent(source_, tile, children.meshes, seams, tolerance_m).mesh;
    if (is_wanted(tile)) finished.descendants.push_back(write(tile, finished.mesh));
    rounds_.keep(tile, finished, children.tiles);
  }

  bool is_wanted(const TileId& tile) const {
    const GeodeticTiles wanted = options_.wanted.at(options_.tiles.zoom - tile.level);
    const std::int64_t x = (options_.tiles.x >> tile.level) + tile.x - wanted.x;
    const std::int64_t y = (options_.tiles.y >> tile.level) + tile.y - wanted.y;
    return x >= 0 && y >= 0 && x < wanted.columns && y < wanted.rows;
  }

  TileRecord write(const TileId& tile, const TileMesh& mesh) const {
    TerrainTile terrain{.tile = tms_of(tile, options_.tiles),
                        .triangles = mesh.triangles,
                        .height_step_m = lattice_.step_m(tile.level).z()};
    for (const LatticePoint& point : mesh.points) {
      terrain.vertices.push_back(
          {.u = static_cast<std::int32_t>(point.i - tile.x * kTileSteps),
           .v = static_cast<std::int32_t>(point.j + (tile.y + 1) * kTileSteps),
           .height = point.k});
    }
    const TmsBounds bounds = bounds_of(terrain.tile);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
      const std::int32_t row = terrain.vertices[v].v;
      // all longitudes meet in a pole, so there is no slope along them
      const bool is_north = bounds.north_deg == 90 && row == kTileSteps;
      const bool is_south = bounds.south_deg == -90 && row == 0;
      const Eigen::Vector3d at_pole(0, 0, is_north ? 1 : -1);
      const Eigen::Vector3d inside = to_ecef_ * mesh.normals[v].cast<double>();
      terrain.normals.emplace_back((is_north || is_south ? at_pole : inside).cast<float>());
    }
    return {.tile = tile,
            .triangles = static_cast<std::int64_t>(mesh.triangles.size()),
            .bytes = write_(terrain),
            .error = mesh.error};
  }

  const BandOptions& options_;
  const WriteTerrain& write_;
  TileBand band_;
  Pyramid pyramid_;
  WorldFrame world_;
  GridLattice lattice_;
  TileSource source_;
  OutputFolder folder_;
  LevelRounds rounds_;
  Eigen::Matrix3d to_ecef_;  // rotation alone
};

}  // namespace

std::vector<TileRecord> build_band(const GeodeticHeights& heights, const BandOptions& options,
                                   const WriteTerrain& write, Progress& progress) {
  return BandBuild(heights, options, write, progress).run();
}

}  // namespace terrane::tiler
