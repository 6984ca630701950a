#include "tiler/tileset/write_tileset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tiler/tileset/write_subtrees.h"

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

/// The octaves in one file where a tree is split.
constexpr int kOctavesPerFile = 4;

/// The explicit tree, whole or in several files.
class TileTree {
 public:
  TileTree(const DataSet& data_set, const Pyramid& pyramid, const std::vector<TileRecord>& records)
      : data_set_(data_set),
        pyramid_(pyramid),
        is_split_(static_cast<std::int64_t>(records.size()) > data_set.format.tiles_per_tileset) {
    for (const TileRecord& record : records) by_id_.emplace(record.tile, &record);
  }

  /// The external tilesets.
  std::vector<OutputFile> external_files() const {
    std::vector<OutputFile> files;
    for (const auto& [tile, record] : by_id_) {
      if (!has_own_file(tile)) continue;
      ordered_json json;
      json["asset"] = {{"version", "1.1"}};
      json["geometricError"] = data_set_.tolerance_m[tile.level];
      json["root"] = {{"refine", "REPLACE"}};
      json["root"].update(node(tile, "../../../"));
      files.push_back({file_of(tile), json.dump() + "\n"});
    }
    return files;
  }

  /// The tile with all that is below it in the same file.
  /// \param to_folder  from the file's folder to that of the output.
  ordered_json node(const TileId& tile, const std::string& to_folder) const {
    ordered_json json =
        facts(tile, to_folder + glb_path(data_set_.format, tile, pyramid_.root_level()));
    for (const TileId& child : pyramid_.children(tile)) {
      if (!by_id_.contains(child)) continue;
      json["children"].push_back(has_own_file(child) ? facts(child, to_folder + file_of(child))
                                                     : node(child, to_folder));
    }
    return json;
  }

 private:
  /// The same levels whatever the height of the tree, with two or more in the first file.
  bool has_own_file(const TileId& tile) const {
    const int octave = data_set_.levels_per_octave;
    const int levels = kOctavesPerFile * octave;
    return is_split_ && tile.level % levels == levels - 1 &&
           tile.level + 2 * octave <= pyramid_.root_level();
  }

  static std::string file_of(const TileId& tile) { return "tilesets/" + path_of(tile) + ".json"; }

  ordered_json facts(const TileId& tile, const std::string& uri) const {
    const TileRecord& record = *by_id_.at(tile);
    ordered_json own = {{"level", tile.level},   {"x", tile.x},
                        {"y", tile.y},           {"triangles", record.triangles},
                        {"bytes", record.bytes}, {"max_error_m", record.error.max_m}};
    if (record.skirt_triangles > 0) own["skirt_triangles"] = record.skirt_triangles;
    ordered_json json;
    json["boundingVolume"]["box"] = record.box.numbers();
    json["geometricError"] = data_set_.tolerance_m[tile.level];
    json["content"]["uri"] = uri;
    json["extras"]["terrane"] = own;
    return json;
  }

  const DataSet& data_set_;
  const Pyramid& pyramid_;
  bool is_split_;
  std::map<TileId, const TileRecord*> by_id_;
};

ordered_json asset_json(const std::string& attribution) {
  ordered_json asset = {{"version", "1.1"}, {"generator", TERRANE_GENERATOR}};
  if (attribution.empty()) return asset;
  asset["extras"]["copyright"] = attribution;
  // where CesiumJS looks
  asset["extras"]["cesium"]["credits"] = {{{"html", attribution}, {"showOnScreen", true}}};
  return asset;
}

ordered_json level_json(int level, double tolerance_m, const Eigen::Vector3d& step_m,
                        const std::vector<TileRecord>& records) {
  std::int64_t tiles = 0, triangles = 0, bytes = 0;
  MeasuredError sum;
  double longest_m = 0;
  for (const TileRecord& record : records) {
    if (record.tile.level != level) continue;
    ++tiles;
    triangles += record.triangles;
    bytes += record.bytes;
    sum.max_m = std::max(sum.max_m, record.error.max_m);
    sum.sum_of_squares_m2 += record.error.sum_of_squares_m2;
    sum.samples += record.error.samples;
    longest_m = std::max(longest_m, record.box.diagonal_m());
  }
  const double samples = static_cast<double>(std::max<std::int64_t>(1, sum.samples));
  return {{"level", level},
          {"tolerance_m", tolerance_m},
          {"step_m", {step_m.x(), step_m.y(), step_m.z()}},
          {"tiles", tiles},
          {"triangles", triangles},
          {"bytes", bytes},
          {"max_error_m", sum.max_m},
          {"rms_error_m", std::sqrt(sum.sum_of_squares_m2 / samples)},
          {"largest_diagonal_m", longest_m}};
}

ordered_json frame_json(const WorldFrame& world) {
  if (world.is_local()) {
    return {{"kind", "local"}, {"x", world.local_origin().x}, {"y", world.local_origin().y}};
  }
  return {{"kind", "enu"},
          {"longitude_deg", world.origin().longitude_deg},
          {"latitude_deg", world.origin().latitude_deg}};
}

ordered_json plan_json(const PlanMap& plan) {
  return {{"degree", plan.degree},
          {"middle_deg", {plan.middle.longitude_deg, plan.middle.latitude_deg}},
          {"half_deg", {plan.half.longitude_deg, plan.half.latitude_deg}},
          {"x", plan.x},
          {"y", plan.y},
          {"max_error", plan.max_error}};
}

}  // namespace

std::vector<OutputFile> tileset_files(const DataSet& data_set, const Pyramid& pyramid,
                                      const WorldFrame& world,
                                      const std::vector<TileRecord>& records) {
  const TileId root{pyramid.root_level(), 0, 0};
  const auto record = std::ranges::find(records, root, &TileRecord::tile);
  ordered_json json;
  json["asset"] = asset_json(data_set.format.attribution);
  // more than the root's own: a client that sees the whole data set as a point still starts
  json["geometricError"] = std::max(2 * data_set.tolerance_m.back(), record->box.diagonal_m());
  json["root"] = {{"refine", "REPLACE"}};
  if (!world.is_local()) json["root"]["transform"] = world.to_ecef();
  std::vector<OutputFile> files;
  if (data_set.format.is_implicit) {
    const Subtrees subtrees(pyramid, records, data_set.tile_cells, data_set.shape);
    json["schema"] = subtrees.schema();
    json["root"].update(subtrees.root(data_set.tolerance_m.back()));
    files = subtrees.files();
  } else {
    const TileTree tree(data_set, pyramid, records);
    json["root"].update(tree.node(root, ""));
    files = tree.external_files();
  }
  files.push_back({"tileset.json", json.dump() + "\n"});
  return files;
}

std::string terrane_json(const DataSet& data_set, const Lattice& lattice, const WorldFrame& world,
                         const std::vector<TileRecord>& records,
                         const std::vector<OutputFile>& tilesets) {
  std::size_t tileset_bytes = 0;
  for (const OutputFile& file : tilesets) tileset_bytes += file.content.size();
  ordered_json json;
  json["format"] = "terrane/1";
  json["generator"] = TERRANE_GENERATOR;
  json["key"] = data_set.key;
  json["dem"] = {{"columns", data_set.shape.columns},
                 {"rows", data_set.shape.rows},
                 {"samples_with_data", data_set.heights.samples_with_data},
                 {"min_height_m", data_set.heights.min_height_m},
                 {"max_height_m", data_set.heights.max_height_m},
                 {"fingerprint", data_set.heights.fingerprint},
                 {"crs_wkt", data_set.crs_wkt}};
  json["frame"] = frame_json(world);
  if (data_set.plan) json["plan"] = plan_json(*data_set.plan);
  json["tile_cells"] = data_set.tile_cells;
  json["levels_per_octave"] = data_set.levels_per_octave;
  json["tilesets"] = {{"kind", data_set.format.is_implicit ? "implicit" : "explicit"},
                      {"files", tilesets.size()},
                      {"bytes", tileset_bytes}};
  for (int level = 0; level < static_cast<int>(data_set.tolerance_m.size()); ++level) {
    json["levels"].push_back(
        level_json(level, data_set.tolerance_m[level], lattice.step_m(level), records));
  }
  return json.dump(2) + "\n";
}

}  // namespace terrane::tiler
