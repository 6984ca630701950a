#include "tiler/verify/tileset.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tiler/verify/json_file.h"
#include "tiler/verify/subtree.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

// fewer than any file system's longest path allows, and more than any data set has
constexpr int kMostNestedFiles = 40;

Box box_of(const std::array<double, 12>& values) {
  Box box;
  box.centre = Eigen::Map<const Eigen::Vector3d>(values.data());
  box.half_axes = Eigen::Map<const Eigen::Matrix3d>(values.data() + 3);
  return box;
}

/// What a tile and the root of its external tileset must agree on.
json shared_facts(const json& tile) {
  return {tile.at("boundingVolume"), tile.at("geometricError"), tile.at("extras")};
}

class TilesetReader {
 public:
  explicit TilesetReader(Output& output) : output_(output) {}

  void read() {
    const auto file = output_.folder / "tileset.json";
    read_json(file, [&](const json& document) {
      const json& root = document.at("root");
      output_.refine = root.value("refine", "");
      if (root.contains("transform")) {
        const auto values = root.at("transform").get<std::array<double, 16>>();
        output_.root_transform = Eigen::Map<const Eigen::Matrix4d>(values.data());
      }
      if (root.contains("implicitTiling")) {
        read_implicit(document, file);
      } else {
        read_tile(root, std::nullopt, "tileset.json", 0);
      }
    });
    for (auto& [key, entry] : output_.tiles) take_implicit_parent(entry);
  }

 private:
  void add(TileEntry entry) {
    const TileKey key = entry.key;
    if (!output_.tiles.emplace(key, std::move(entry)).second) output_.listed_twice.push_back(key);
  }

  /// \param file  that the tile is in, from the output's folder.
  void read_tile(const json& tile, const std::optional<TileKey>& parent,
                 const std::filesystem::path& file, int nesting) {
    const json& extras = tile.at("extras").at("terrane");
    const TileKey key{extras.at("level"), extras.at("x"), extras.at("y")};
    const auto address = tile.at("content").at("uri").get<std::string>();
    const auto content = (file.parent_path() / address).lexically_normal();
    if (content.extension() == ".json") {
      if (tile.contains("children")) contradict(key, "has children beside its external tileset");
      read_external(tile, key, parent, content, nesting + 1);
      return;
    }
    add({.key = key,
         .parent = parent,
         .uri = content.generic_string(),
         .geometric_error_m = tile.at("geometricError"),
         .max_error_m = extras.at("max_error_m"),
         .triangles = extras.at("triangles"),
         .bytes = extras.at("bytes"),
         .box = box_of(tile.at("boundingVolume").at("box"))});
    if (!tile.contains("children")) return;
    for (const json& child : tile.at("children")) read_tile(child, key, file, nesting);
  }

  void read_external(const json& stub, const TileKey& key, const std::optional<TileKey>& parent,
                     const std::filesystem::path& file, int nesting) {
    const auto path = output_.folder / file;
    if (*file.begin() == ".." || nesting > kMostNestedFiles) {
      throw damaged(output_.folder / "tileset.json",
                    fmt::format("'{}' is no tileset of this output", file.generic_string()));
    }
    output_.tilesets.push_back(path);
    if (file != fmt::format("tilesets/{}/{}/{}.json", key.level, key.x, key.y)) {
      contradict(key, fmt::format("its tileset is '{}'", file.generic_string()));
    }
    read_json(path, [&](const json& document) {
      const json& root = document.at("root");
      if (root.contains("transform")) contradict(key, "its tileset has a transform of its own");
      if (shared_facts(root) != shared_facts(stub)) {
        contradict(key, "its box, error or extras are not those of its tileset's root");
      }
      read_tile(root, parent, file, nesting);
    });
  }

  void read_implicit(const json& document, const std::filesystem::path& file) {
    const json& root = document.at("root");
    const json& tiling = root.at("implicitTiling");
    output_.is_implicit = true;
    root_level_ = output_.tiling.level_count() - 1;
    root_error_m_ = root.at("geometricError");
    const TileKey root_key{root_level_, 0, 0};
    if (tiling.at("subdivisionScheme") != "QUADTREE" ||
        tiling.at("availableLevels") != output_.tiling.level_count() ||
        tiling.at("subtrees").at("uri") != "subtrees/{level}/{x}/{y}.subtree" ||
        root.at("content").at("uri") != "content/{level}/{x}/{y}.glb") {
      throw damaged(file, "its implicit tiling is not that of terrane.json");
    }
    read_subtrees(tiling.at("subtreeLevels"), box_property(document, file), {});
    const auto own = output_.tiles.find(root_key);
    if (own == output_.tiles.end()) return;
    const Box implied = box_of(root.at("boundingVolume").at("box"));
    for (const Eigen::Vector3d& corner : own->second.box.corners()) {
      if (implied.contains(corner)) continue;
      contradict(root_key, "the implied box does not contain it");
      break;
    }
  }

  static std::string box_property(const json& document, const std::filesystem::path& file) {
    for (const auto& [name, about] :
         document.at("schema").at("classes").at("tile").at("properties").items()) {
      if (about.value("semantic", "") == "TILE_BOUNDING_BOX") return name;
    }
    throw damaged(file, "no property is a TILE_BOUNDING_BOX");
  }

  /// A tile counted from the root downward.
  struct Place {
    int depth = 0;
    std::int64_t x = 0;
    std::int64_t y = 0;
  };

  void read_subtrees(int levels, const std::string& box_property, const Place& at) {
    const auto path =
        output_.folder / fmt::format("subtrees/{}/{}/{}.subtree", at.depth, at.x, at.y);
    output_.tilesets.push_back(path);
    const Subtree subtree = read_subtree(path, levels, box_property);
    for (const SubtreeTile& tile : subtree.tiles) add_implicit(tile, at);
    for (const auto& [x, y] : subtree.children) {
      const Place below{at.depth + levels, (at.x << levels) + x, (at.y << levels) + y};
      if (below.depth > root_level_) throw damaged(path, "has subtrees below the last level");
      read_subtrees(levels, box_property, below);
    }
  }

  void add_implicit(const SubtreeTile& tile, const Place& at) {
    const Place place{at.depth + tile.depth, (at.x << tile.depth) + tile.x,
                      (at.y << tile.depth) + tile.y};
    const TileKey key{root_level_ - place.depth, place.x, place.y};
    if (!tile.has_content) contradict(key, "is there, but has no content");
    add({.key = key,
         .parent = std::nullopt,
         .uri = fmt::format("content/{}/{}/{}.glb", place.depth, place.x, place.y),
         .geometric_error_m = std::ldexp(root_error_m_, -place.depth),
         .max_error_m = tile.max_error_m,
         .triangles = tile.triangles,
         .bytes = tile.bytes,
         .box = box_of(tile.box)});
  }

  /// Where tiles are implied, so are their parents - if they are there.
  void take_implicit_parent(TileEntry& entry) const {
    if (!output_.is_implicit || entry.key.level == root_level_) return;
    if (output_.find(output_.tiling.parent(entry.key)) != nullptr) {
      entry.parent = output_.tiling.parent(entry.key);
    }
  }

  void contradict(const TileKey& key, const std::string& what) {
    output_.contradictions.emplace_back(key, what);
  }

  Output& output_;
  int root_level_ = 0;
  double root_error_m_ = 0;
};

}  // namespace

void read_tileset(Output& output) { TilesetReader(output).read(); }

}  // namespace terrane::verify
