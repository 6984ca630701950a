#include "tiler/verify/terrain_examination.h"

#include <fmt/format.h>

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "tiler/verify/json_file.h"
#include "tiler/verify/terrain_claims.h"
#include "tiler/verify/terrain_glb.h"
#include "tiler/verify/terrain_glb_examination.h"

namespace terrane::verify {
namespace {

constexpr std::int32_t kLast = 32767;

const std::vector<double>& across(const TerrainFile& tile, TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kEast ? tile.u : tile.v;
}
const std::vector<double>& along(const TerrainFile& tile, TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kEast ? tile.v : tile.u;
}
std::int32_t place_of(TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kSouth ? 0 : kLast;
}

class Examination {
 public:
  Examination(const TerrainFile& tile, const TerrainKey& key, const TerrainLayer& layer)
      : tile_(tile), key_(key), layer_(layer) {}

  std::vector<FaultFound> run() {
    if (!check_numbers()) return std::move(found_);
    check_triangles();
    check_border_lists();
    check_heights();
    check_water();
    check_metadata();
    return std::move(found_);
  }

 private:
  void note(TerrainFault fault, std::int64_t count, std::string what) {
    found_.push_back({fault, count, std::move(what)});
  }

  std::size_t vertices() const { return tile_.u.size(); }

  /// Nothing else can be judged if this fails.
  bool check_numbers() {
    const auto check = [&](const auto& values) {
      const auto outside =
          std::ranges::count_if(values, [](auto value) { return value < 0 || value > kLast; });
      if (outside == 0) return;
      note(TerrainFault::kIndices, outside,
           fmt::format("{} coordinates are not from 0 to 32767", outside));
    };
    check(tile_.u);
    check(tile_.v);
    check(tile_.height_steps);
    return found_.empty();
  }

  std::int64_t area(const std::array<std::uint32_t, 3>& t) const {
    const auto x = [&](int k) { return static_cast<std::int64_t>(tile_.u[t[k]]); };
    const auto y = [&](int k) { return static_cast<std::int64_t>(tile_.v[t[k]]); };
    return (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0));
  }

  bool are_on_a_side(std::uint32_t a, std::uint32_t b) const {
    return std::ranges::any_of(kTerrainSides, [&](TerrainFile::Side side) {
      const auto& at = across(tile_, side);
      return at[a] == place_of(side) && at[b] == place_of(side);
    });
  }

  /// Upward triangles whose open edges all lie on the tile's sides wind round every place inside
  /// as often as the areas say: once, if their sum is the tile's.
  void check_triangles() {
    std::int64_t sum = 0, folded = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> open;
    for (const auto& corners : tile_.triangles) {
      const std::int64_t twice = area(corners);
      sum += twice;
      folded += twice <= 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
        const auto other = open.find({to, from});
        if (other == open.end()) {
          ++open[{from, to}];
        } else if (--other->second == 0) {
          open.erase(other);
        }
      }
    }
    if (folded > 0) {
      note(TerrainFault::kFolded, folded,
           fmt::format("{} triangles face down or have no area", folded));
    }
    const auto gaping = std::ranges::count_if(open, [&](const auto& edge) {
      return edge.second != 1 || !are_on_a_side(edge.first.first, edge.first.second);
    });
    if (gaping > 0) {
      note(TerrainFault::kCover, 1, fmt::format("{} edges inside have one side only", gaping));
    } else if (sum != 2 * std::int64_t{kLast} * kLast) {
      note(TerrainFault::kCover, 1,
           fmt::format("its triangles cover {:.6f} of it",
                       static_cast<double>(sum) / 2 / kLast / kLast));
    }
  }

  void check_border_lists() {
    for (const TerrainFile::Side side : kTerrainSides) {
      std::vector<std::uint32_t> wanted;
      for (std::uint32_t v = 0; v < vertices(); ++v) {
        if (across(tile_, side)[v] == place_of(side)) wanted.push_back(v);
      }
      std::vector<std::uint32_t> listed = tile_.border[side];
      std::ranges::sort(listed);
      if (listed == wanted) continue;
      note(TerrainFault::kEdgeLists, 1,
           fmt::format("border list {} has {} vertices, on the border are {}",
                       static_cast<int>(side), listed.size(), wanted.size()));
    }
  }

  void check_heights() {
    if (vertices() == 0) return;
    const auto [low, high] = std::ranges::minmax(tile_.height_steps);
    const double range_m = tile_.max_height_m - tile_.min_height_m;
    if (!(range_m >= 0) || low != 0) {
      note(TerrainFault::kHeights, 1,
           fmt::format("states heights of {} to {} m, and no vertex has the lowest",
                       tile_.min_height_m, tile_.max_height_m));
      return;
    }
    // coarser steps than need be: floats high up leave less choice
    const double farthest_m = std::max(std::abs(tile_.min_height_m), std::abs(tile_.max_height_m));
    const double used_m = range_m * high / kLast;
    if (range_m <= std::max(2.01 * used_m, 0.01 * farthest_m)) return;
    note(TerrainFault::kHeights, 1,
         fmt::format("states a highest of {} m, its vertices reach {:.3f} m", tile_.max_height_m,
                     tile_.min_height_m + used_m));
  }

  void check_water() {
    constexpr std::size_t kMask = 256 * 256;
    const bool is_wanted =
        std::ranges::find(layer_.extensions, "watermask") != layer_.extensions.end();
    if (tile_.water.has_value() != is_wanted) {
      note(TerrainFault::kWater, 1,
           is_wanted ? "has no water mask" : "has a water mask that layer.json does not list");
      return;
    }
    if (!tile_.water) return;
    if (tile_.water->size() != 1 && tile_.water->size() != kMask) {
      note(TerrainFault::kWater, 1,
           fmt::format("its water mask has {} bytes", tile_.water->size()));
      return;
    }
    const auto odd = std::ranges::count_if(
        *tile_.water, [](char c) { return c != 0 && static_cast<unsigned char>(c) != 255; });
    if (odd > 0) {
      note(TerrainFault::kWater, 1,
           fmt::format("{} cells of its mask are neither land nor water", odd));
    }
  }

  /// The metadata list ranges of the zooms below, cut to the tile.
  void check_metadata() {
    constexpr int kEvery = 10;  // where CesiumJS asks
    if (!tile_.metadata) {
      if (key_.zoom % kEvery == 0 && key_.zoom < layer_.finest()) {
        note(TerrainFault::kMetadata, 1, "does not say which tiles are below it");
      }
      return;
    }
    try {
      const auto below = nlohmann::json::parse(*tile_.metadata).at("available");
      for (std::size_t k = 0; k < below.size(); ++k) {
        const int zoom = key_.zoom + 1 + static_cast<int>(k);
        if (!is_as_listed(ranges_of(below[k]), zoom)) {
          note(TerrainFault::kMetadata, 1,
               fmt::format("names other tiles of zoom {} than layer.json", zoom));
        }
      }
    } catch (const nlohmann::json::exception& error) {
      note(TerrainFault::kMetadata, 1, fmt::format("its metadata are damaged ({})", error.what()));
    }
  }

  bool is_as_listed(const ZoomRanges& ranges, int zoom) const {
    if (zoom > layer_.finest()) return ranges.empty();
    const int shift = zoom - key_.zoom;
    const TerrainRange square{key_.x << shift, key_.y << shift, ((key_.x + 1) << shift) - 1,
                              ((key_.y + 1) << shift) - 1};
    // rectangles that name the same tiles have the same corners and the same number of them
    std::int64_t named = 0, listed = 0;
    for (const TerrainRange& r : ranges) {
      named += (r.end_x - r.start_x + 1) * (r.end_y - r.start_y + 1);
      if (!layer_.has({zoom, r.start_x, r.start_y}) || !layer_.has({zoom, r.end_x, r.end_y}) ||
          !square.contains(r.start_x, r.start_y) || !square.contains(r.end_x, r.end_y)) {
        return false;
      }
    }
    for (const TerrainRange& r : layer_.available[static_cast<std::size_t>(zoom)]) {
      const std::int64_t columns =
          std::min(r.end_x, square.end_x) - std::max(r.start_x, square.start_x) + 1;
      const std::int64_t rows =
          std::min(r.end_y, square.end_y) - std::max(r.start_y, square.start_y) + 1;
      if (columns > 0 && rows > 0) listed += columns * rows;
    }
    return named == listed;
  }

  const TerrainFile& tile_;
  const TerrainKey& key_;
  const TerrainLayer& layer_;
  std::vector<FaultFound> found_;
};

}  // namespace

std::vector<Eigen::Vector3d> ecef_of(const TerrainFile& tile, const TerrainKey& key) {
  if (!tile.glb_ecef_m.empty()) return tile.glb_ecef_m;
  std::vector<Eigen::Vector3d> ecef(tile.u.size());
  for (std::uint32_t v = 0; v < tile.u.size(); ++v) {
    GeographicLib::Geocentric::WGS84().Forward(
        std::clamp(key.south_deg() + tile.v[v] / kLast * key.side_deg(), -90.0, 90.0),
        key.west_deg() + tile.u[v] / kLast * key.side_deg(), tile.height_m[v], ecef[v].x(),
        ecef[v].y(), ecef[v].z());
  }
  return ecef;
}

TerrainFile read_tile(const TerrainLayer& layer, const TerrainKey& key) {
  if (layer.kind == TerrainKind::kQuantizedMesh) return read_terrain_file(layer.file_of(key));
  return read_terrain_glb(layer.file_of(key), key, layer.facts.at(key));
}

std::vector<FaultFound> examine_terrain(const TerrainFile& tile, const TerrainKey& key,
                                        const TerrainLayer& layer) {
  std::vector<FaultFound> found = examine_indices(tile);
  if (!found.empty()) return found;
  found = layer.kind == TerrainKind::kQuantizedMesh ? Examination(tile, key, layer).run()
                                                    : examine_terrain_glb(tile, key, layer);
  const auto claims = examine_claims(tile, ecef_of(tile, key));
  found.insert(found.end(), claims.begin(), claims.end());
  return found;
}

std::vector<BorderVertex> border_of(const TerrainFile& tile, TerrainFile::Side side) {
  std::vector<BorderVertex> border;
  if (!tile.glb_ecef_m.empty()) {
    for (const std::uint32_t v : tile.border[side]) {
      if (v >= tile.glb_ecef_m.size()) continue;
      const Eigen::Vector3d& at = tile.glb_ecef_m[v];
      border.push_back({std::bit_cast<std::int64_t>(at.x()), std::bit_cast<std::int64_t>(at.y()),
                        std::bit_cast<std::int64_t>(at.z())});
    }
  } else {
    for (std::uint32_t v = 0; v < tile.u.size(); ++v) {
      if (across(tile, side)[v] != place_of(side)) continue;
      border.push_back({std::llround(along(tile, side)[v]), std::llround(tile.height_m[v] * 1e6)});
    }
  }
  std::ranges::sort(border);
  return border;
}

}  // namespace terrane::verify
