#include "tiler/geodetic/terrain_tileset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tiler/tileset/subtree_bytes.h"

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

constexpr const char* kRoots[] = {"west", "east"};

/// A tile below one of the roots: x from the root's west, y from the south.
struct BelowRoot {
  int zoom = 0;
  std::int64_t x = 0, y = 0;
};

class TerrainSubtrees {
 public:
  TerrainSubtrees(const std::vector<GeodeticTiles>& available,
                  const std::function<TerrainFacts(const TmsTile&)>& facts)
      : available_(available),
        facts_(facts),
        levels_(best_levels_per_subtree(static_cast<int>(available.size()))) {}

  int levels() const { return levels_; }
  const TerrainFacts& extent(std::size_t root) const { return extent_[root]; }

  std::vector<OutputFile> files() {
    std::vector<OutputFile> files;
    for (std::size_t root = 0; root < 2; ++root) {
      for (int zoom = 0; zoom <= finest(); zoom += levels_) {
        const std::int64_t side = std::int64_t{1} << zoom;
        const GeodeticTiles& tiles = available_[static_cast<std::size_t>(zoom)];
        // rows and columns with tiles only: a quadtree of 22 zooms has more than can be walked
        for (std::int64_t y = side - tiles.y - tiles.rows; y < side - tiles.y; ++y) {
          for (std::int64_t k = 0; k < tiles.columns; ++k) {
            const std::int64_t x = (tiles.x + k) % (2 * side);
            if (x / side != static_cast<std::int64_t>(root)) continue;
            const BelowRoot top{zoom, x % side, y};
            files.push_back(
                {fmt::format("subtrees/{}/{}/{}/{}.subtree", kRoots[root], zoom, top.x, top.y),
                 encode(root, top)});
          }
        }
      }
    }
    return files;
  }

 private:
  int finest() const { return static_cast<int>(available_.size()) - 1; }

  static TmsTile tms(std::size_t root, const BelowRoot& tile) {
    return {tile.zoom, tile.x + (root == 0 ? 0 : std::int64_t{1} << tile.zoom), tile.y};
  }

  bool is_there(std::size_t root, const BelowRoot& below) const {
    if (below.zoom > finest()) return false;
    const GeodeticTiles& tiles = available_[static_cast<std::size_t>(below.zoom)];
    const TmsTile tile = tms(root, below);
    const std::int64_t around = std::int64_t{2} << tile.zoom;
    const std::int64_t from_west = ((tile.x - tiles.x) % around + around) % around;
    const std::int64_t from_north = (std::int64_t{1} << tile.zoom) - 1 - tile.y - tiles.y;
    return from_west < tiles.columns && from_north >= 0 && from_north < tiles.rows;
  }

  /// Calls visit(tile, its number) for the tiles of a full quadtree \p depth levels below, in
  /// Morton order.
  template <class Visit>
  static void for_each_below(const BelowRoot& top, int depth, const Visit& visit) {
    const std::int64_t side = std::int64_t{1} << depth;
    std::vector<BelowRoot> in_order(static_cast<std::size_t>(side * side));
    for (std::int64_t y = 0; y < side; ++y) {
      for (std::int64_t x = 0; x < side; ++x) {
        in_order[static_cast<std::size_t>(morton(x, y))] = {top.zoom + depth, (top.x << depth) + x,
                                                            (top.y << depth) + y};
      }
    }
    for (std::size_t k = 0; k < in_order.size(); ++k) {
      visit(in_order[k], static_cast<std::int64_t>(k));
    }
  }

  std::string encode(std::size_t root, const BelowRoot& top) {
    SubtreeAvailability tiles(tiles_above(levels_));
    std::vector<TerrainFacts> rows;
    for (int depth = 0; depth < levels_; ++depth) {
      for_each_below(top, depth, [&](const BelowRoot& tile, std::int64_t number) {
        if (!is_there(root, tile)) return;
        tiles.set(tiles_above(depth) + number);
        rows.push_back(facts_(tms(root, tile)));
        widen(root, rows.back());
      });
    }
    SubtreeAvailability below(std::int64_t{1} << (2 * levels_));
    for_each_below(top, levels_, [&](const BelowRoot& tile, std::int64_t number) {
      if (is_there(root, tile)) below.set(number);
    });

    SubtreeBuffers buffers;
    ordered_json json;
    json["propertyTables"] = ordered_json::array({property_table(rows, buffers)});
    json["tileMetadata"] = 0;
    json["tileAvailability"] = tiles.json(buffers);
    // every tile has content
    json["contentAvailability"] = ordered_json::array({json["tileAvailability"]});
    json["childSubtreeAvailability"] = below.json(buffers);
    const std::string bytes = buffers.padded();
    json["buffers"] = ordered_json::array({{{"byteLength", bytes.size()}}});
    json["bufferViews"] = buffers.views();
    return pack_subtree(json.dump(), bytes);
  }

  static ordered_json property_table(const std::vector<TerrainFacts>& rows,
                                     SubtreeBuffers& buffers) {
    std::vector<double> low, high, spheres, horizons;
    for (const TerrainFacts& facts : rows) {
      low.push_back(facts.min_height_m);
      high.push_back(facts.max_height_m);
      spheres.insert(spheres.end(), facts.sphere.centre.begin(), facts.sphere.centre.end());
      spheres.push_back(facts.sphere.radius_m);
      horizons.insert(horizons.end(), facts.horizon.begin(), facts.horizon.end());
    }
    ordered_json table{{"class", "tile"}, {"count", rows.size()}};
    table["properties"] = {{"min_height", {{"values", buffers.add(low)}}},
                           {"max_height", {{"values", buffers.add(high)}}},
                           {"bounding_sphere", {{"values", buffers.add(spheres)}}},
                           {"horizon_occlusion_point", {{"values", buffers.add(horizons)}}}};
    return table;
  }

  void widen(std::size_t root, const TerrainFacts& facts) {
    TerrainFacts& extent = extent_[root];
    extent.min_height_m = std::min(extent.min_height_m, facts.min_height_m);
    extent.max_height_m = std::max(extent.max_height_m, facts.max_height_m);
  }

  const std::vector<GeodeticTiles>& available_;
  const std::function<TerrainFacts(const TmsTile&)>& facts_;
  int levels_;
  std::array<TerrainFacts, 2> extent_;  // heights of all tiles below each root
};

ordered_json schema() {
  const auto property = [](const char* type, const char* semantic) {
    return ordered_json{
        {"type", type}, {"componentType", "FLOAT64"}, {"required", true}, {"semantic", semantic}};
  };
  ordered_json sphere = property("SCALAR", "TILE_BOUNDING_SPHERE");
  sphere["array"] = true;
  sphere["count"] = 4;
  ordered_json tile{{"name", "Terrain tile"}};
  tile["properties"] = {
      {"min_height", property("SCALAR", "TILE_MINIMUM_HEIGHT")},
      {"max_height", property("SCALAR", "TILE_MAXIMUM_HEIGHT")},
      {"bounding_sphere", sphere},
      {"horizon_occlusion_point", property("VEC3", "TILE_HORIZON_OCCLUSION_POINT")}};
  return {{"id", "terrane_terrain"}, {"classes", {{"tile", tile}}}};
}

ordered_json region(double west_deg, double east_deg, double low_m, double high_m) {
  constexpr double kRad = std::numbers::pi / 180;
  ordered_json volume;
  volume["region"] =
      std::array{west_deg * kRad, -90 * kRad, east_deg * kRad, 90 * kRad, low_m, high_m};
  return volume;
}

}  // namespace

std::string glb_path_of(const TmsTile& tile) {
  const std::int64_t side = std::int64_t{1} << tile.zoom;
  return fmt::format("{}/{}/{}/{}.glb", kRoots[tile.x / side], tile.zoom, tile.x % side, tile.y);
}

std::vector<OutputFile> terrain_tileset(const std::vector<GeodeticTiles>& available,
                                        const std::string& attribution,
                                        const std::function<TerrainFacts(const TmsTile&)>& facts) {
  TerrainSubtrees subtrees(available, facts);
  std::vector<OutputFile> files = subtrees.files();
  ordered_json json;
  json["asset"] = {{"version", "1.1"}, {"generator", TERRANE_GENERATOR}};
  if (!attribution.empty()) json["asset"]["copyright"] = attribution;
  json["schema"] = schema();
  json["geometricError"] = 2 * kLevelZeroError_m;
  ordered_json& root = json["root"];
  root["boundingVolume"] =
      region(-180, 180, std::min(subtrees.extent(0).min_height_m, subtrees.extent(1).min_height_m),
             std::max(subtrees.extent(0).max_height_m, subtrees.extent(1).max_height_m));
  root["geometricError"] = 2 * kLevelZeroError_m;
  root["refine"] = "REPLACE";
  for (std::size_t k = 0; k < 2; ++k) {
    const double west_deg = k == 0 ? -180 : 0;
    ordered_json half;
    half["boundingVolume"] = region(west_deg, west_deg + 180, subtrees.extent(k).min_height_m,
                                    subtrees.extent(k).max_height_m);
    half["geometricError"] = kLevelZeroError_m;
    half["content"]["uri"] = fmt::format("{}/{{level}}/{{x}}/{{y}}.glb", kRoots[k]);
    half["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                              {"availableLevels", available.size()},
                              {"subtreeLevels", subtrees.levels()}};
    half["implicitTiling"]["subtrees"]["uri"] =
        fmt::format("subtrees/{}/{{level}}/{{x}}/{{y}}.subtree", kRoots[k]);
    root["children"].push_back(half);
  }
  files.push_back({"tileset.json", json.dump(2) + "\n"});
  return files;
}

}  // namespace terrane::tiler
