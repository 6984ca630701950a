#include "tiler/verify/output.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tiler/verify/json_file.h"
#include "tiler/verify/tileset.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

constexpr double kBoxSlack = 1e-6;  // of the box's size

// beyond any DEM; below, tile arithmetic cannot overflow
constexpr std::int64_t kMostSamples = std::int64_t{1} << 40;
constexpr std::int64_t kMostTileCells = std::int64_t{1} << 20;
constexpr int kMostLevelsPerOctave = 16;

Frame read_frame(const json& frame, const std::filesystem::path& file) {
  const auto kind = frame.at("kind").get<std::string>();
  if (kind == "local") return {.is_local = true, .x = frame.at("x"), .y = frame.at("y")};
  if (kind != "enu") throw damaged(file, fmt::format("frame.kind is '{}'", kind));
  return {.longitude_deg = frame.at("longitude_deg"), .latitude_deg = frame.at("latitude_deg")};
}

LevelEntry read_level(const json& level) {
  const auto step = level.at("step_m").get<std::array<double, 3>>();
  return {.tolerance_m = level.at("tolerance_m"),
          .step_m = {step[0], step[1], step[2]},
          .tiles = level.at("tiles"),
          .triangles = level.at("triangles"),
          .bytes = level.at("bytes"),
          .max_error_m = level.at("max_error_m"),
          .largest_diagonal_m = level.at("largest_diagonal_m")};
}

bool is_power_of_two(double step) {
  int exponent = 0;
  return step > 0 && std::isfinite(step) && std::frexp(step, &exponent) == 0.5;
}

void check_steps(const std::vector<LevelEntry>& levels, const std::filesystem::path& file) {
  for (std::size_t level = 0; level < levels.size(); ++level) {
    for (int axis = 0; axis < 3; ++axis) {
      const double step = levels[level].step_m[axis];
      // powers of two that do not shrink are whole multiples of each other
      const bool shrinks = level > 0 && step < levels[level - 1].step_m[axis];
      if (!is_power_of_two(step) || shrinks) {
        throw damaged(file, fmt::format("step_m[{}] of level {} is {}", axis, level, step));
      }
    }
  }
}

void check_shape(const Output& output, const std::filesystem::path& file) {
  const GridShape& shape = output.tiling.shape;
  const bool fits = shape.columns >= 2 && shape.rows >= 2 && shape.columns <= kMostSamples &&
                    shape.rows <= kMostSamples && output.tiling.tile_cells >= 1 &&
                    output.tiling.tile_cells <= kMostTileCells &&
                    output.tiling.levels_per_octave >= 1 &&
                    output.tiling.levels_per_octave <= kMostLevelsPerOctave;
  if (!fits) {
    throw damaged(file, fmt::format("a DEM of {} x {} samples in tiles of {} cells, {} levels per "
                                    "octave",
                                    shape.columns, shape.rows, output.tiling.tile_cells,
                                    output.tiling.levels_per_octave));
  }
  const int expected = output.tiling.level_count();
  if (expected != static_cast<int>(output.levels.size())) {
    throw damaged(file,
                  fmt::format("{} levels listed, {} expected", output.levels.size(), expected));
  }
}

void read_terrane_json(const json& document, const std::filesystem::path& file, Output& output) {
  const auto format = document.at("format").get<std::string>();
  if (format != "terrane/1") {
    throw InputError(
        fmt::format("{}: format '{}' is not 'terrane/1'. Use the terrane that wrote it",
                    file.string(), format));
  }
  const json& dem = document.at("dem");
  output.tiling.shape = {dem.at("columns"), dem.at("rows")};
  output.tiling.tile_cells = document.at("tile_cells");
  output.tiling.levels_per_octave = document.at("levels_per_octave");
  output.frame = read_frame(document.at("frame"), file);
  for (const json& level : document.at("levels")) {
    if (level.at("level").get<std::size_t>() != output.levels.size()) {
      throw damaged(file, "levels are not listed as 0, 1, 2, ...");
    }
    output.levels.push_back(read_level(level));
  }
  check_shape(output, file);
  check_steps(output.levels, file);
}

/// Half axes as unit vectors; a flat box takes the missing one from the others.
Eigen::Matrix3d unit_axes(const Eigen::Matrix3d& half_axes) {
  Eigen::Matrix3d axes = half_axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (axes.col(axis).squaredNorm() == 0) {
      axes.col(axis) = half_axes.col((axis + 1) % 3).cross(half_axes.col((axis + 2) % 3));
    }
    axes.col(axis).stableNormalize();
  }
  return axes;
}

}  // namespace

bool Box::contains(const Eigen::Vector3d& point) const {
  const double slack = kBoxSlack * diagonal_m();
  const Eigen::Matrix3d axes = unit_axes(half_axes);
  const Eigen::Vector3d distance = (axes.transpose() * (point - centre)).cwiseAbs();
  return (distance.array() <= half_axes.colwise().norm().transpose().array() + slack).all();
}

std::array<Eigen::Vector3d, 8> Box::corners() const {
  std::array<Eigen::Vector3d, 8> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d signs((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1,
                                (corner & 4) ? 1 : -1);
    corners[static_cast<std::size_t>(corner)] = centre + half_axes * signs;
  }
  return corners;
}

double Output::reach_m(int level) const {
  const auto next = std::min(static_cast<std::size_t>(level) + 1, levels.size() - 1);
  return levels[next].plan_step_m();
}

const TileEntry* Output::find(const TileKey& key) const {
  const auto found = tiles.find(key);
  return found == tiles.end() ? nullptr : &found->second;
}

std::filesystem::path Output::file_of(const TileKey& key) const {
  if (!is_implicit) return folder / fmt::format("tiles/{}/{}/{}.glb", key.level, key.x, key.y);
  const int depth = tiling.level_count() - 1 - key.level;
  return folder / fmt::format("content/{}/{}/{}.glb", depth, key.x, key.y);
}

Output read_output(const std::filesystem::path& folder) {
  Output output;
  output.folder = folder;
  const auto terrane_json = folder / "terrane.json";
  if (!std::filesystem::exists(terrane_json)) {
    throw InputError(
        fmt::format("{}: not a finished terrane output, terrane.json is missing. Run 'terrane "
                    "build DEM -o {}' first",
                    folder.string(), folder.string()));
  }
  read_json(terrane_json,
            [&](const json& document) { read_terrane_json(document, terrane_json, output); });
  read_tileset(output);
  return output;
}

}  // namespace terrane::verify
