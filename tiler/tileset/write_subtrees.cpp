#include "tiler/tileset/write_subtrees.h"

#include <fmt/format.h>

#include "tiler/tileset/subtree_bytes.h"

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

/// One row for each tile, in their order.
ordered_json property_table(const std::vector<const TileRecord*>& records, SubtreeBuffers& binary) {
  std::vector<double> boxes, errors_m;
  std::vector<std::uint32_t> triangles, skirts, bytes;
  for (const TileRecord* record : records) {
    for (const double number : record->box.numbers()) boxes.push_back(number);
    errors_m.push_back(record->error.max_m);
    triangles.push_back(static_cast<std::uint32_t>(record->triangles));
    skirts.push_back(static_cast<std::uint32_t>(record->skirt_triangles));
    bytes.push_back(static_cast<std::uint32_t>(record->bytes));
  }
  ordered_json table{{"class", "tile"}, {"count", records.size()}};
  table["properties"] = {{"box", {{"values", binary.add(boxes)}}},
                         {"max_error_m", {{"values", binary.add(errors_m)}}},
                         {"triangles", {{"values", binary.add(triangles)}}},
                         {"skirt_triangles", {{"values", binary.add(skirts)}}},
                         {"bytes", {{"values", binary.add(bytes)}}}};
  return table;
}

}  // namespace

Subtrees::Subtrees(const Pyramid& pyramid, const std::vector<TileRecord>& records,
                   std::int64_t tile_cells, GridShape shape)
    : pyramid_(pyramid),
      tile_cells_(tile_cells),
      shape_(shape),
      levels_per_subtree_(best_levels_per_subtree(pyramid.level_count())) {
  for (const TileRecord& record : records) by_id_.emplace(record.tile, &record);
}

ordered_json Subtrees::schema() const {
  const ordered_json count = {{"type", "SCALAR"}, {"componentType", "UINT32"}};
  ordered_json box = {{"type", "SCALAR"}, {"componentType", "FLOAT64"},
                      {"array", true},    {"count", 12},
                      {"required", true}, {"semantic", "TILE_BOUNDING_BOX"}};
  ordered_json tile{{"name", "Tile"}};
  tile["properties"] = {{"box", box},
                        {"max_error_m", {{"type", "SCALAR"}, {"componentType", "FLOAT64"}}},
                        {"triangles", count},
                        {"skirt_triangles", count},
                        {"bytes", count}};
  return {{"id", "terrane"}, {"classes", {{"tile", tile}}}};
}

/// A box over the whole quadtree, of which the DEM fills the part at the first columns and rows.
OrientedBox Subtrees::implied_box() const {
  OrientedBox box = by_id_.at({pyramid_.root_level(), 0, 0})->box;
  const auto side = static_cast<double>(tile_cells_ << pyramid_.root_level());
  box.high.x() =
      box.low.x() + (box.high.x() - box.low.x()) * side / static_cast<double>(shape_.columns - 1);
  box.high.y() =
      box.low.y() + (box.high.y() - box.low.y()) * side / static_cast<double>(shape_.rows - 1);
  return box;
}

ordered_json Subtrees::root(double geometric_error_m) const {
  ordered_json root;
  root["boundingVolume"]["box"] = implied_box().numbers();
  root["geometricError"] = geometric_error_m;
  root["content"]["uri"] = "content/{level}/{x}/{y}.glb";
  root["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                            {"availableLevels", pyramid_.level_count()},
                            {"subtreeLevels", levels_per_subtree_}};
  root["implicitTiling"]["subtrees"]["uri"] = "subtrees/{level}/{x}/{y}.subtree";
  return root;
}

std::vector<OutputFile> Subtrees::files() const {
  std::vector<OutputFile> files;
  for (const auto& [tile, record] : by_id_) {
    const int depth = pyramid_.root_level() - tile.level;
    if (depth % levels_per_subtree_ != 0) continue;
    files.push_back(
        {fmt::format("subtrees/{}/{}/{}.subtree", depth, tile.x, tile.y), encode(tile)});
  }
  return files;
}

/// All tiles of a full quadtree \p depth levels below its root, in Morton order.
std::vector<TileId> Subtrees::tiles_in_order(const TileId& subtree, int depth) const {
  std::vector<TileId> tiles(static_cast<std::size_t>(std::int64_t{1} << (2 * depth)));
  for (std::int64_t y = 0; y < std::int64_t{1} << depth; ++y) {
    for (std::int64_t x = 0; x < std::int64_t{1} << depth; ++x) {
      tiles[static_cast<std::size_t>(morton(x, y))] = {
          subtree.level - depth, (subtree.x << depth) + x, (subtree.y << depth) + y};
    }
  }
  return tiles;
}

std::string Subtrees::encode(const TileId& subtree) const {
  SubtreeAvailability tiles(tiles_above(levels_per_subtree_));
  std::vector<const TileRecord*> there;
  for (int depth = 0; depth < levels_per_subtree_; ++depth) {
    std::int64_t index = tiles_above(depth);
    for (const TileId& tile : tiles_in_order(subtree, depth)) {
      const auto found = by_id_.find(tile);
      if (found != by_id_.end()) {
        tiles.set(index);
        there.push_back(found->second);
      }
      ++index;
    }
  }
  SubtreeAvailability below(std::int64_t{1} << (2 * levels_per_subtree_));
  std::int64_t index = 0;
  for (const TileId& tile : tiles_in_order(subtree, levels_per_subtree_)) {
    if (by_id_.contains(tile)) below.set(index);
    ++index;
  }

  SubtreeBuffers binary;
  ordered_json json;
  json["propertyTables"] = ordered_json::array({property_table(there, binary)});
  json["tileMetadata"] = 0;
  json["tileAvailability"] = tiles.json(binary);
  // every tile has content
  json["contentAvailability"] = ordered_json::array({json["tileAvailability"]});
  json["childSubtreeAvailability"] = below.json(binary);
  const std::string bytes = binary.padded();
  json["buffers"] = ordered_json::array({{{"byteLength", bytes.size()}}});
  json["bufferViews"] = binary.views();
  return pack_subtree(json.dump(), bytes);
}

}  // namespace terrane::tiler
