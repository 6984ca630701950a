#include "tiler/verify/terrain_tileset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "tiler/verify/json_file.h"

namespace terrane::verify {
namespace {

using nlohmann::json;
using Rows = std::map<std::int64_t, std::set<std::int64_t>>;

constexpr const char* kRootNames[] = {"western", "eastern"};
constexpr int kFinestZoom = 30;  // a damaged number must not eat memory

/// Rectangles that tiles of a zoom make up: runs along rows, those above each other joined.
ZoomRanges ranges_over(const Rows& rows) {
  ZoomRanges ranges;
  for (const auto& [y, columns] : rows) {
    for (auto x = columns.begin(); x != columns.end();) {
      TerrainRange run{*x, y, *x, y};
      for (++x; x != columns.end() && *x == run.end_x + 1; ++x) ++run.end_x;
      const auto below = std::ranges::find_if(ranges, [&](const TerrainRange& range) {
        return range.end_y + 1 == y && range.start_x == run.start_x && range.end_x == run.end_x;
      });
      if (below == ranges.end()) {
        ranges.push_back(run);
      } else {
        below->end_y = y;
      }
    }
  }
  return ranges;
}

std::string replaced(std::string text, const std::string& word, std::int64_t number) {
  const auto at = text.find(word);
  return at == std::string::npos ? text : text.replace(at, word.size(), std::to_string(number));
}

/// Which property of the class has a semantic.
std::string property_with(const json& properties, const std::string& semantic) {
  for (const auto& [name, property] : properties.items()) {
    if (property.value("semantic", "") == semantic) return name;
  }
  throw json::other_error::create(501, "no property is a " + semantic, nullptr);
}

TerrainProperties properties_of(const json& schema) {
  const json& classes = schema.at("classes");
  if (classes.empty()) throw json::other_error::create(501, "the schema has no class", nullptr);
  const json& properties = classes.begin()->at("properties");
  return {.min_height = property_with(properties, "TILE_MINIMUM_HEIGHT"),
          .max_height = property_with(properties, "TILE_MAXIMUM_HEIGHT"),
          .bounding_sphere = property_with(properties, "TILE_BOUNDING_SPHERE"),
          .horizon_occlusion_point = property_with(properties, "TILE_HORIZON_OCCLUSION_POINT")};
}

class Reading {
 public:
  explicit Reading(const std::filesystem::path& folder) : folder_(folder) {}

  TerrainTileset run() {
    read_json(folder_ / "tileset.json", [&](const json& document) {
      names_ = properties_of(document.at("schema"));
      const json& roots = document.at("root").at("children");
      if (roots.size() != 2) {
        throw damaged(folder_ / "tileset.json", fmt::format("{} roots, not two", roots.size()));
      }
      for (std::size_t root = 0; root < 2; ++root) follow(root, roots[root]);
    });
    for (const Rows& rows : rows_) result_.available.push_back(ranges_over(rows));
    return std::move(result_);
  }

 private:
  void follow(std::size_t root, const json& tile) {
    const json& tiling = tile.at("implicitTiling");
    const int levels = tiling.at("availableLevels");
    if (tiling.at("subdivisionScheme") != "QUADTREE" || levels < 1 || levels > kFinestZoom + 1) {
      throw damaged(folder_ / "tileset.json", "has no implicit quadtree");
    }
    rows_.resize(std::max(rows_.size(), static_cast<std::size_t>(levels)));
    subtree_levels_ = tiling.at("subtreeLevels");
    subtrees_ = tiling.at("subtrees").at("uri");
    result_.content_template[root] = tile.at("content").at("uri");
    add_subtree(root, {0, static_cast<std::int64_t>(root), 0}, levels);
    check_region(root, tile.at("boundingVolume").at("region").get<std::array<double, 6>>());
  }

  void add_subtree(std::size_t root, const TerrainKey& top, int levels) {
    const auto file = folder_ / address_of(subtrees_, top);
    const TerrainSubtree subtree = read_terrain_subtree(file, subtree_levels_, names_);
    for (std::size_t k = 0; k < subtree.listing.tiles.size(); ++k) {
      const SubtreeTile& tile = subtree.listing.tiles[k];
      const TerrainKey key = below(top, tile.depth, tile.x, tile.y);
      if (key.zoom >= levels) throw damaged(file, "has tiles below the last level");
      if (!tile.has_content) {
        result_.faults.push_back(fmt::format("{}: is listed without content", to_string(key)));
      }
      rows_[static_cast<std::size_t>(key.zoom)][key.y].insert(key.x);
      result_.facts.emplace(key, subtree.facts[k]);
      widen(root, subtree.facts[k]);
    }
    for (const auto& [x, y] : subtree.listing.children) {
      const TerrainKey key = below(top, subtree_levels_, x, y);
      if (key.zoom >= levels) throw damaged(file, "has subtrees below the last level");
      add_subtree(root, key, levels);
    }
  }

  static TerrainKey below(const TerrainKey& top, int depth, std::int64_t x, std::int64_t y) {
    return {top.zoom + depth, (top.x << depth) + x, (top.y << depth) + y};
  }

  void widen(std::size_t root, const TerrainFacts& facts) {
    auto& [low_m, high_m] = heights_m_[root];
    low_m = std::min(low_m, facts.min_height_m);
    high_m = std::max(high_m, facts.max_height_m);
  }

  void check_region(std::size_t root, const std::array<double, 6>& region) {
    constexpr double kSlack_rad = 1e-9, kPi = std::numbers::pi;
    const double west = root == 0 ? -kPi : 0;
    const std::array<double, 4> wanted{west, -kPi / 2, west + kPi, kPi / 2};
    const bool is_half =
        std::ranges::equal(wanted, std::array{region[0], region[1], region[2], region[3]},
                           [](double a, double b) { return std::abs(a - b) <= kSlack_rad; });
    if (!is_half) {
      result_.faults.push_back(
          fmt::format("tileset.json: the region of the {} root is not its half of the Earth",
                      kRootNames[root]));
    }
    const auto [low_m, high_m] = heights_m_[root];
    if (region[4] <= low_m && region[5] >= high_m) return;
    result_.faults.push_back(
        fmt::format("tileset.json: the region of the {} root has heights of {} to {} m, its tiles "
                    "{} to {} m",
                    kRootNames[root], region[4], region[5], low_m, high_m));
  }

  const std::filesystem::path& folder_;
  TerrainTileset result_;
  TerrainProperties names_;
  int subtree_levels_ = 0;
  std::string subtrees_;
  std::vector<Rows> rows_;  // by zoom
  std::array<std::pair<double, double>, 2> heights_m_{
      {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
};

}  // namespace

TerrainTileset read_terrain_tileset(const std::filesystem::path& folder) {
  return Reading(folder).run();
}

std::string address_of(const std::string& address_template, const TerrainKey& key) {
  const std::int64_t side = std::int64_t{1} << key.zoom;
  return replaced(replaced(replaced(address_template, "{level}", key.zoom), "{x}", key.x % side),
                  "{y}", key.y);
}

}  // namespace terrane::verify
