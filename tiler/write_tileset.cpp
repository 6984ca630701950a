#include "tiler/write_tileset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

class TileTree {
 public:
  TileTree(const DataSet& data_set, const Pyramid& pyramid, const std::vector<TileRecord>& records)
      : data_set_(data_set), pyramid_(pyramid) {
    for (const TileRecord& record : records) by_id_.emplace(record.tile, &record);
  }

  ordered_json node(const TileId& tile) const {
    const TileRecord& record = *by_id_.at(tile);
    ordered_json json;
    json["boundingVolume"]["box"] = box(record);
    json["geometricError"] = data_set_.tolerance_m[tile.level];
    json["content"]["uri"] = "tiles/" + path_of(tile) + ".glb";
    json["extras"]["terrane"] = {{"level", tile.level},   {"x", tile.x},
                                 {"y", tile.y},           {"triangles", record.triangles},
                                 {"bytes", record.bytes}, {"max_error_m", record.error.max_m}};
    for (const TileId& child : pyramid_.children(tile)) {
      if (by_id_.contains(child)) json["children"].push_back(node(child));
    }
    return json;
  }

 private:
  static ordered_json box(const TileRecord& record) {
    const Eigen::Vector3d centre = (record.low + record.high) / 2;
    const Eigen::Vector3d half = (record.high - record.low) / 2;
    return {centre.x(), centre.y(), centre.z(), half.x(), 0, 0, 0, half.y(), 0, 0, 0, half.z()};
  }

  const DataSet& data_set_;
  const Pyramid& pyramid_;
  std::map<TileId, const TileRecord*> by_id_;
};

double diagonal_m(const TileRecord& record) { return (record.high - record.low).norm(); }

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
    longest_m = std::max(longest_m, diagonal_m(record));
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

}  // namespace

std::string tileset_json(const DataSet& data_set, const Pyramid& pyramid, const WorldFrame& world,
                         const std::vector<TileRecord>& records) {
  const TileId root{pyramid.root_level(), 0, 0};
  const auto record = std::ranges::find(records, root, &TileRecord::tile);
  ordered_json json;
  json["asset"] = {{"version", "1.1"}, {"generator", TERRANE_GENERATOR}};
  // more than the root's own: a client that sees the whole data set as a point still starts
  json["geometricError"] = std::max(2 * data_set.tolerance_m.back(), diagonal_m(*record));
  json["root"] = {{"refine", "REPLACE"}};
  if (!world.is_local()) json["root"]["transform"] = world.to_ecef();
  json["root"].update(TileTree(data_set, pyramid, records).node(root));
  return json.dump() + "\n";
}

std::string terrane_json(const DataSet& data_set, const Lattice& lattice, const WorldFrame& world,
                         const std::vector<TileRecord>& records) {
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
  json["tile_cells"] = data_set.tile_cells;
  json["levels_per_octave"] = data_set.levels_per_octave;
  for (int level = 0; level < static_cast<int>(data_set.tolerance_m.size()); ++level) {
    json["levels"].push_back(
        level_json(level, data_set.tolerance_m[level], lattice.step_m(level), records));
  }
  return json.dump(2) + "\n";
}

}  // namespace terrane::tiler
