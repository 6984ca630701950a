#include "tiler/build.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <thread>

#include "core/errors.h"
#include "hierarchy/collapse/within_task.h"
#include "tiler/build_tile.h"
#include "tiler/files/output_folder.h"
#include "tiler/files/whole_file.h"
#include "tiler/gltf/cut_texture.h"
#include "tiler/gltf/tile_skirt.h"
#include "tiler/gltf/write_glb.h"
#include "tiler/level_rounds.h"
#include "tiler/tile/height_cache.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tileset/write_tileset.h"

namespace terrane::tiler {
namespace {

/// Heights that are kept for the next level: 440 MB.
constexpr std::int64_t kMostCachedSamples = 110'000'000;

/// Between a shore and a sample beside it the ground may be a wall, where what plan is rounded by
/// becomes so much more in height; and lines are 1/128 cell apart at least (ingest/features.h),
/// twice what a step may be.
double steps_per_tolerance(const BuildOptions& options) {
  constexpr double kSteps = 16, kStepsWithLines = 128, kStepsPerCell = 256;
  const GridFeatures& features = options.features;
  if (features.lines.empty()) return kSteps;
  const double cell_m = std::min(features.column_m, features.row_m);
  return std::max(kStepsWithLines, kStepsPerCell * options.tolerance_m / cell_m);
}

std::string hash_hex(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

std::string build_key(const BuildOptions& options, const HeightStatistics& statistics) {
  return hash_hex(fmt::format(
      "{} {} {} {} {} {} {} {} {}", TERRANE_GENERATOR, options.tolerance_m, options.tile_cells,
      options.levels_per_octave, options.effort, statistics.fingerprint, key_of(options.format),
      options.texture ? options.texture->fingerprint() : "", options.features.fingerprint));
}

/// Doubles exactly with each octave.
double tolerance_of_level_m(const BuildOptions& options, int level) {
  const int k = options.levels_per_octave;
  return std::ldexp(options.tolerance_m * std::exp2(static_cast<double>(level % k) / k), level / k);
}

/// Does the grid run clockwise in the world (rows to the north, or columns to the west)?
bool is_mirrored(const WorldFrame& world, GridShape shape) {
  const double c = static_cast<double>(shape.columns - 1) / 2;
  const double r = static_cast<double>(shape.rows - 1) / 2;
  const GridPosition probes[] = {{c, r}, {c + 0.5, r}, {c, r + 0.5}};
  const auto at = world.plumbs(probes);
  return (at[1].base - at[0].base).cross(at[2].base - at[0].base).dot(at[0].up) > 0;
}

/// Along the columns, along the rows, and upright, in the middle of some samples.
Axes axes_of(const WorldFrame& world, const Window& window) {
  const double c = static_cast<double>(window.column) + static_cast<double>(window.columns - 1) / 2;
  const double r = static_cast<double>(window.row) + static_cast<double>(window.rows - 1) / 2;
  const GridPosition probes[] = {{c, r}, {c - 0.5, r}, {c + 0.5, r}, {c, r - 0.5}, {c, r + 0.5}};
  const auto at = world.plumbs(probes);
  const Eigen::Vector3d columns = at[2].base - at[1].base, rows = at[4].base - at[3].base;
  const Eigen::Vector3d up = at[0].up;
  Axes axes;
  axes.col(2) = columns.cross(rows).dot(up) > 0 ? up : Eigen::Vector3d(-up);
  axes.col(0) = (columns - columns.dot(up) * up).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

std::optional<PlanMap> plan_of(const Georeference& place, GridShape shape) {
  if (place.crs_wkt().empty()) return std::nullopt;
  return fit_plan_map(place, shape);
}

int jobs_of(const BuildOptions& options) {
  return options.jobs > 0 ? options.jobs
                          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// Of the two ways along a vertical, that which leads up.
Eigen::Vector3d upright(const Eigen::Vector3d& vertical) {
  return vertical.z() > 0 ? vertical : Eigen::Vector3d(-vertical);
}

class Build {
 public:
  Build(const HeightSource& heights, const Georeference& place, const HeightStatistics& statistics,
        const BuildOptions& options, const std::filesystem::path& out, Progress& progress)
      : heights_(heights, kMostCachedSamples),
        pyramid_(heights.shape(), options.tile_cells, options.levels_per_octave),
        world_(place, heights.shape()),
        lattice_(pyramid_, world_, statistics, options.tolerance_m, steps_per_tolerance(options)),
        source_{heights_, world_, pyramid_, lattice_, options.effort},
        is_mirrored_(is_mirrored(world_, heights.shape())),
        folder_(out),
        texture_(options.texture),
        data_set_{.shape = heights.shape(),
                  .heights = statistics,
                  .crs_wkt = place.crs_wkt(),
                  .plan = plan_of(place, heights.shape()),
                  .tile_cells = options.tile_cells,
                  .levels_per_octave = options.levels_per_octave,
                  .tolerance_m = {},
                  .format = options.format,
                  .key = build_key(options, statistics)},
        rounds_(source_, folder_, data_set_.tolerance_m, jobs_of(options), progress) {
    for (int level = 0; level < pyramid_.level_count(); ++level) {
      data_set_.tolerance_m.push_back(tolerance_of_level_m(options, level));
    }
    source_.steepest = steepest(lattice_, data_set_.tolerance_m);
    if (options.features.lines.empty()) return;
    features_.emplace(options.features, pyramid_, lattice_, data_set_.tolerance_m);
    source_.features = &*features_;
  }

  BuildResult run() {
    if (folder_.finished_key() == data_set_.key) {
      folder_.end();  // again: the build that finished may have been killed while it tidied up
      return {.was_up_to_date = true};
    }
    folder_.begin(data_set_.key);
    for (int level = 0; level < pyramid_.level_count(); ++level) {
      rounds_.build(level, fmt::format("level {} of {}", level, pyramid_.root_level()),
                    [this](const TileId& tile) { build_tile(tile); });
    }
    return finish();
  }

 private:
  void build_tile(const TileId& tile) const {
    const double tolerance_m = data_set_.tolerance_m[tile.level];
    const std::vector<SeamChain> seams = rounds_.seams_of_tile(tile);
    FinishedTile finished;
    if (tile.level == 0) {
      finished.mesh = build_leaf(source_, tile, seams, tolerance_m).mesh;
      rounds_.keep(tile, finished, {});
      return;
    }
    FinishedChildren children = rounds_.children_of(tile);
    BuiltTile built = build_parent(source_, tile, children.meshes, seams, tolerance_m);
    hierarchy::for_each_within_task(children.tiles.size(), [&](std::size_t c) {
      write_tile(children.tiles[c], children.meshes[c], built.child_targets[c],
                 children.descendants[c]);
    });
    for (const auto& of_child : children.descendants) {
      finished.descendants.insert(finished.descendants.end(), of_child.begin(), of_child.end());
    }
    finished.mesh = std::move(built.mesh);
    rounds_.keep(tile, finished, children.tiles);
  }

  /// Writes a tile's glb and puts its record before those of its descendants.
  void write_tile(const TileId& tile, const TileMesh& mesh, std::span<const LatticePoint> targets,
                  std::vector<TileRecord>& records) const {
    if (mesh.triangles.empty()) return;
    TileRecord record{.tile = tile,
                      .triangles = static_cast<std::int64_t>(mesh.triangles.size()),
                      .error = mesh.error,
                      .box = {.axes = axes_of(world_, pyramid_.window(tile))}};
    for (const TileRecord& below : records) {
      record.error.max_m = std::max(record.error.max_m, below.error.max_m);
      if (below.tile.level == tile.level - 1) record.box.add(below.box);
    }
    const TileSkirt skirt = make_skirt(tile, mesh, targets, record.box.axes.col(2));
    for (const auto points : {std::span<const LatticePoint>(mesh.points), targets,
                              std::span<const LatticePoint>(skirt.points),
                              std::span<const LatticePoint>(skirt.targets)}) {
      for (const LatticePoint& point : points) {
        record.box.add(lattice_.world(point, tile.level));
      }
    }
    const std::string glb =
        encode_glb({.id = tile,
                    .mesh = mesh,
                    .targets = targets,
                    .skirt = skirt,
                    .step_m = lattice_.step_m(tile.level),
                    .up = upright(record.box.axes.col(2)),
                    .is_mirrored = is_mirrored_,
                    .tolerance_m = data_set_.tolerance_m[tile.level],
                    .max_error_m = record.error.max_m,
                    .heights = data_set_.heights,
                    .texture = cut_texture(texture_, pyramid_.window(tile), cells_per_texel(tile))},
                   data_set_.format);
    write_whole_file(folder_.root() / glb_path(data_set_.format, tile, pyramid_.root_level()), glb);
    record.skirt_triangles = static_cast<std::int64_t>(skirt.triangles.size());
    record.bytes = static_cast<std::int64_t>(glb.size());
    records.insert(records.begin(), record);
  }

  TileSkirt make_skirt(const TileId& tile, const TileMesh& mesh,
                       std::span<const LatticePoint> targets,
                       const Eigen::Vector3d& vertical) const {
    if (!data_set_.format.skirt_m) return {};
    // neighbours two levels apart are at most five tolerances of the finer one apart
    const double auto_m = 5 * data_set_.tolerance_m[tile.level];
    const double depth_m = *data_set_.format.skirt_m > 0 ? *data_set_.format.skirt_m : auto_m;
    const Eigen::Vector3d down = -depth_m * upright(vertical);
    return hang_skirt(pyramid_, tile, mesh, targets,
                      down.cwiseQuotient(lattice_.step_m(tile.level)));
  }

  /// Cells that a texel of a tile is wide.
  double cells_per_texel(const TileId& tile) const {
    return static_cast<double>(data_set_.tile_cells << pyramid_.octave(tile.level)) /
           (data_set_.format.texture_px - 1);
  }

  BuildResult finish() {
    const TileId root{pyramid_.root_level(), 0, 0};
    FinishedTile finished = read_finished_tile(folder_.finished_tile(root));
    std::vector<TileRecord>& records = finished.descendants;
    write_tile(root, finished.mesh, finished.mesh.points, records);
    if (records.empty()) {
      throw InputError(
          "the DEM has no three neighbouring samples with heights, so there is nothing to show. "
          "Check --nodata and --band");
    }
    const auto tilesets = tileset_files(data_set_, pyramid_, world_, records);
    for (const OutputFile& file : tilesets) {
      write_whole_file(folder_.root() / file.path, file.content);
    }
    write_whole_file(folder_.summary(),
                     terrane_json(data_set_, lattice_, world_, records, tilesets));
    folder_.end();

    BuildResult result{.levels = pyramid_.level_count(),
                       .tiles = static_cast<std::int64_t>(records.size())};
    for (const TileRecord& record : records) {
      result.bytes += record.bytes;
      if (record.tile.level != 0) continue;
      result.triangles += record.triangles;
      result.max_error_m = std::max(result.max_error_m, record.error.max_m);
    }
    return result;
  }

  HeightCache heights_;
  Pyramid pyramid_;
  WorldFrame world_;
  Lattice lattice_;
  TileSource source_;
  bool is_mirrored_;
  OutputFolder folder_;
  const TextureSource* texture_;
  DataSet data_set_;
  LevelRounds rounds_;
  std::optional<TileFeatures> features_;
};

}  // namespace

void check(const BuildOptions& options) {
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m)) {
    throw ConfigError(
        fmt::format("--tolerance {}: must be a number of metres above 0", options.tolerance_m));
  }
  if (options.tile_cells < 4 || options.tile_cells > 1024) {
    throw ConfigError(fmt::format("--tile-cells {}: must be from 4 to 1024", options.tile_cells));
  }
  if (options.levels_per_octave < 1 || options.levels_per_octave > 4) {
    throw ConfigError(
        fmt::format("--levels-per-octave {}: must be from 1 to 4", options.levels_per_octave));
  }
  if (options.effort < 0 || options.effort > hierarchy::kTopEffort) {
    throw ConfigError(
        fmt::format("--effort {}: must be from 0 to {}", options.effort, hierarchy::kTopEffort));
  }
  check(options.format);
  if (options.format.is_implicit && options.levels_per_octave > 1) {
    throw ConfigError(
        "--implicit: has one level in each octave, as an implicit quadtree has. Leave "
        "--levels-per-octave at 1");
  }
  if (options.jobs < 0) {
    throw ConfigError(fmt::format("--jobs {}: must be 0 (all cores) or more", options.jobs));
  }
}

void check_place(GridShape shape, const Georeference& place, const HeightStatistics& statistics,
                 const BuildOptions& options) {
  const Pyramid pyramid(shape, options.tile_cells, options.levels_per_octave);
  const WorldFrame world(place, shape);
  const Lattice lattice(pyramid, world, statistics, options.tolerance_m,
                        steps_per_tolerance(options));
  const TileId root{pyramid.root_level(), 0, 0};
  const TileFrame frame(world, lattice, pyramid.window(root), root.level);
}

BuildResult build(const HeightSource& heights, const Georeference& place,
                  const HeightStatistics& statistics, const BuildOptions& options,
                  const std::filesystem::path& out, Progress& progress) {
  check(options);
  return Build(heights, place, statistics, options, out, progress).run();
}

}  // namespace terrane::tiler
