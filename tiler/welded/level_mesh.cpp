#include "tiler/welded/level_mesh.h"

#include <fmt/format.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>

#include "core/errors.h"
#include "tiler/verify/output.h"
#include "tiler/verify/tile_mesh.h"
#include "tiler/welded/clip_mesh.h"

namespace terrane::welded {
namespace {

using verify::Lattice;
using Inside = std::function<double(const Position&)>;

struct LatticeHash {
  std::size_t operator()(const Lattice& place) const {
    std::uint64_t hash = 0;
    for (const std::int64_t number : place) {
      hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Borders of an area as functions that are at least 0 inside.
std::array<Inside, 4> borders_of(const Area& area, const verify::Frame& frame) {
  if (frame.is_local) {
    return {[=](const Position& p) { return frame.x + p[0] - area.west; },
            [=](const Position& p) { return area.east - (frame.x + p[0]); },
            [=](const Position& p) { return frame.y + p[1] - area.south; },
            [=](const Position& p) { return area.north - (frame.y + p[1]); }};
  }
  const GeographicLib::LocalCartesian earth(frame.latitude_deg, frame.longitude_deg, 0);
  const double half_width_deg = (area.east - area.west + (area.west > area.east ? 360 : 0)) / 2;
  const double middle_deg = area.west + half_width_deg;
  const auto latitude = [=](const Position& p) {
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
    earth.Reverse(p[0], p[1], p[2], latitude_deg, longitude_deg, height_m);
    return latitude_deg;
  };
  const auto east_of_middle = [=](const Position& p) {
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
    earth.Reverse(p[0], p[1], p[2], latitude_deg, longitude_deg, height_m);
    return std::remainder(longitude_deg - middle_deg, 360.0);
  };
  return {[=](const Position& p) { return half_width_deg + east_of_middle(p); },
          [=](const Position& p) { return half_width_deg - east_of_middle(p); },
          [=](const Position& p) { return latitude(p) - area.south; },
          [=](const Position& p) { return area.north - latitude(p); }};
}

void check(const Area& area, const verify::Frame& frame) {
  const bool is_wide = frame.is_local ? area.west < area.east : area.west != area.east;
  if (is_wide && area.south < area.north) return;
  throw ConfigError(fmt::format("--area {},{},{},{}: is empty. Give west,south,east,north in {}",
                                area.west, area.south, area.east, area.north,
                                frame.is_local ? "metres of the DEM" : "degrees"));
}

class Welding {
 public:
  explicit Welding(const Eigen::Vector3d& step_m) : step_m_(step_m) {}

  void add(const verify::TileMesh& tile) {
    std::vector<std::uint32_t> here;
    here.reserve(tile.position.size());
    for (const Lattice& place : tile.position) here.push_back(vertex_at(place));
    for (const auto& [a, b, c] : tile.triangles) {
      surface_.triangles.push_back({here[a], here[b], here[c]});
    }
  }

  SurfaceMesh take() { return std::move(surface_); }

 private:
  std::uint32_t vertex_at(const Lattice& place) {
    const auto next = static_cast<std::uint32_t>(surface_.positions.size());
    const auto [found, is_new] = vertices_.emplace(place, next);
    if (is_new) {
      Position position;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        position[axis] =
            static_cast<double>(place[axis]) * step_m_[static_cast<Eigen::Index>(axis)];
      }
      surface_.positions.push_back(position);
    }
    return found->second;
  }

  Eigen::Vector3d step_m_;
  std::unordered_map<Lattice, std::uint32_t, LatticeHash> vertices_;
  SurfaceMesh surface_;
};

/// True if all of the tile's vertices lie beyond one of the borders.
bool is_beyond(const verify::TileMesh& tile, const Eigen::Vector3d& step_m,
               const std::array<Inside, 4>& borders) {
  return std::ranges::any_of(borders, [&](const Inside& inside) {
    return std::ranges::all_of(tile.position, [&](const Lattice& place) {
      return inside({static_cast<double>(place[0]) * step_m[0],
                     static_cast<double>(place[1]) * step_m[1],
                     static_cast<double>(place[2]) * step_m[2]}) < 0;
    });
  });
}

SurfaceMesh weld(const verify::Output& output, int level, const std::optional<Area>& area) {
  const Eigen::Vector3d step_m = output.levels[static_cast<std::size_t>(level)].step_m;
  std::array<Inside, 4> borders;
  if (area) borders = borders_of(*area, output.frame);
  Welding welding(step_m);
  for (const auto& [key, entry] : output.tiles) {
    if (key.level != level) continue;
    const verify::TileMesh tile = verify::read_tile_mesh(output, key);
    if (!area || !is_beyond(tile, step_m, borders)) welding.add(tile);
  }
  SurfaceMesh surface = welding.take();
  if (area) {
    for (const Inside& inside : borders) surface = clip(surface, inside);
  }
  return surface;
}

}  // namespace

int level_count(const std::filesystem::path& folder) {
  return static_cast<int>(verify::read_output(folder).levels.size());
}

LevelMesh weld_level(const std::filesystem::path& folder, int level,
                     const std::optional<Area>& area) {
  const verify::Output output = verify::read_output(folder);
  if (level < 0 || level >= static_cast<int>(output.levels.size())) {
    throw ConfigError(fmt::format("--level {}: there is none. {} has levels 0 (finest) to {}",
                                  level, folder.string(), output.levels.size() - 1));
  }
  if (area) check(*area, output.frame);
  const verify::LevelEntry& entry = output.levels[static_cast<std::size_t>(level)];
  LevelMesh mesh{.level = level,
                 .tolerance_m = entry.tolerance_m,
                 .max_error_m = entry.max_error_m,
                 .origin = {.is_local = output.frame.is_local,
                            .longitude_deg = output.frame.longitude_deg,
                            .latitude_deg = output.frame.latitude_deg,
                            .x_m = output.frame.x,
                            .y_m = output.frame.y},
                 .surface = weld(output, level, area)};
  if (!mesh.surface.triangles.empty()) return mesh;
  throw InputError(
      fmt::format("{}: nothing of it lies in the --area. Give west,south,east,north in {}",
                  folder.string(), output.frame.is_local ? "metres of the DEM" : "degrees"));
}

}  // namespace terrane::welded
