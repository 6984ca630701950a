#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tiler/verify/tiling.h"

namespace terrane::verify {

/// The frame of terrane.json.
struct Frame {
  bool is_local = false;
  double longitude_deg = 0;  ///< of an "enu" frame
  double latitude_deg = 0;
  double x = 0;  ///< of a "local" frame, metres
  double y = 0;
};

/// One level as terrane.json states it.
struct LevelEntry {
  double tolerance_m = 0;
  Eigen::Vector3d step_m = Eigen::Vector3d::Zero();
  std::int64_t tiles = 0;
  std::int64_t triangles = 0;
  std::int64_t bytes = 0;
  double max_error_m = 0;
  double largest_diagonal_m = 0;

  /// The larger of the two steps in plan.
  double plan_step_m() const { return step_m.head<2>().maxCoeff(); }
};

/// boundingVolume.box: a centre and three half axes, in the frame of the tileset's root.
struct Box {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d half_axes = Eigen::Matrix3d::Zero();  ///< one per column

  /// True if the point is inside, or outside by no more than a millionth of the box.
  bool contains(const Eigen::Vector3d& point) const;
  std::array<Eigen::Vector3d, 8> corners() const;
  double diagonal_m() const { return 2 * half_axes.norm(); }
};

/// One tile as tileset.json states it.
struct TileEntry {
  TileKey key;
  std::optional<TileKey> parent;
  std::string uri;
  double geometric_error_m = 0;
  double max_error_m = 0;
  std::int64_t triangles = 0;
  std::int64_t bytes = 0;
  Box box;
};

/// What the two JSON files of an output say.
struct Output {
  std::filesystem::path folder;
  Tiling tiling;
  Frame frame;
  std::vector<LevelEntry> levels;
  std::map<TileKey, TileEntry> tiles;
  std::vector<TileKey> listed_twice;
  std::string refine;
  std::optional<Eigen::Matrix4d> root_transform;
  bool is_implicit = false;
  std::vector<std::filesystem::path> tilesets;  ///< external tilesets or subtrees
  /// Tiles of which the files say two things, and what.
  std::vector<std::pair<TileKey, std::string>> contradictions;

  /// Step in plan of the next level: a morphing vertex is rounded to either lattice.
  double reach_m(int level) const;
  const TileEntry* find(const TileKey& key) const;
  std::filesystem::path file_of(const TileKey& key) const;
};

/// Reads terrane.json, tileset.json and what that refers to.
///
/// \throws InputError if one is missing, cut off, of another format, or states what cannot be
///         (steps that are no multiples of each other, too few levels).
Output read_output(const std::filesystem::path& folder);

}  // namespace terrane::verify
