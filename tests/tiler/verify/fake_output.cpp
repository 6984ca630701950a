#include "tests/tiler/verify/fake_output.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>

namespace terrane::verify::testing {
namespace {

using nlohmann::json;
using Short3 = std::array<std::int16_t, 3>;

constexpr double kCell_m = 8;

// --- the fake builder

struct Grid {
  const FakeDem& dem;
  const ToWorld& to_world;
  std::array<double, 3> step_m;
  std::int64_t stride;  // samples between vertices

  Triple lattice(std::int64_t column, std::int64_t row) const {
    const auto world =
        to_world(static_cast<double>(column), static_cast<double>(row), dem.at(column, row));
    Triple triple;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      triple[axis] = std::llround(world[axis] / step_m[axis]);
    }
    return triple;
  }
};

std::uint32_t add_vertex(FakeTile& tile, const Grid& grid, std::int64_t column, std::int64_t row) {
  const std::array<std::int64_t, 2> sample = {column, row};
  const auto found = std::find(tile.sample.begin(), tile.sample.end(), sample);
  if (found == tile.sample.end()) {
    tile.sample.push_back(sample);
    tile.position.push_back(grid.lattice(column, row));
    tile.morph.push_back({0, 0, 0});
    return static_cast<std::uint32_t>(tile.sample.size() - 1);
  }
  return static_cast<std::uint32_t>(found - tile.sample.begin());
}

/// One or two triangles of a cell, counter-clockwise from its north-west corner.
void add_cell(FakeTile& tile, const Grid& grid, std::int64_t column, std::int64_t row) {
  const std::int64_t s = grid.stride;
  const std::array<std::array<std::int64_t, 2>, 4> corners = {
      {{column, row}, {column, row + s}, {column + s, row + s}, {column + s, row}}};
  std::vector<std::array<std::int64_t, 2>> there;
  for (const auto& [x, y] : corners) {
    if (!std::isnan(grid.dem.at(x, y))) there.push_back({x, y});
  }
  for (std::size_t n = 2; n < there.size(); ++n) {
    tile.triangles.push_back({add_vertex(tile, grid, there[0][0], there[0][1]),
                              add_vertex(tile, grid, there[n - 1][0], there[n - 1][1]),
                              add_vertex(tile, grid, there[n][0], there[n][1])});
  }
}

FakeTile make_tile(const Grid& grid, int level, std::int64_t x, std::int64_t y, int tile_cells) {
  FakeTile tile{.level = level, .x = x, .y = y};
  const std::int64_t cells = std::int64_t{tile_cells} << level;
  const GridShape shape = grid.dem.shape();
  for (std::int64_t row = y * cells; row < std::min((y + 1) * cells, shape.rows - 1);
       row += grid.stride) {
    for (std::int64_t column = x * cells; column < std::min((x + 1) * cells, shape.columns - 1);
         column += grid.stride) {
      add_cell(tile, grid, column, row);
    }
  }
  return tile;
}

void add_morph(FakeTile& tile, const Grid& fine, const Grid& coarse) {
  for (std::size_t v = 0; v < tile.sample.size(); ++v) {
    const auto [column, row] = tile.sample[v];
    const Triple target =
        coarse.lattice(column - column % coarse.stride, row - row % coarse.stride);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t ratio = std::llround(coarse.step_m[axis] / fine.step_m[axis]);
      tile.morph[v][axis] = target[axis] * ratio - tile.position[v][axis];
    }
  }
}

int level_count(const GridShape& shape, int tile_cells) {
  int levels = 1;
  while ((std::int64_t{tile_cells} << (levels - 1)) < std::max(shape.columns, shape.rows) - 1) {
    ++levels;
  }
  return levels;
}

FakeOutput make_output(const FakeDem& dem, const ToWorld& to_world, int tile_cells,
                       double tolerance_m, const std::array<double, 3>& finest_step_m, bool halve) {
  FakeOutput output;
  output.frame = {{"kind", "local"}, {"x", 0.0}, {"y", 0.0}};
  output.shape = dem.shape();
  output.tile_cells = tile_cells;
  const int levels = level_count(dem.shape(), tile_cells);
  std::vector<Grid> grids;
  for (int level = 0; level < levels; ++level) {
    const std::int64_t stride = halve ? std::int64_t{1} << level : 1;
    std::array<double, 3> step_m = finest_step_m;
    for (double& step : step_m) step *= static_cast<double>(stride);
    grids.push_back({dem, to_world, step_m, stride});
    output.levels.push_back({tolerance_m * std::pow(2, level), grids.back().step_m});
  }
  for (int level = 0; level < levels; ++level) {
    const std::int64_t cells = std::int64_t{tile_cells} << level;
    const auto n = static_cast<std::size_t>(level);
    for (std::int64_t y = 0; y * cells < dem.shape().rows - 1; ++y) {
      for (std::int64_t x = 0; x * cells < dem.shape().columns - 1; ++x) {
        FakeTile tile = make_tile(grids[n], level, x, y, tile_cells);
        if (tile.triangles.empty()) continue;
        if (level + 1 < levels) add_morph(tile, grids[n], grids[n + 1]);
        tile.max_error_m = output.levels[n].tolerance_m;
        output.tiles.push_back(std::move(tile));
      }
    }
  }
  return output;
}

// --- the fake writer

/// The binary chunk and the JSON that describes it.
struct GlbParts {
  json views = json::array();
  json accessors = json::array();
  std::vector<unsigned char> binary;

  std::size_t add_view(const std::vector<unsigned char>& encoded, std::size_t count,
                       std::size_t stride, const char* mode) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    views.push_back({{"buffer", 1},
                     {"byteLength", count * stride},
                     {"extensions",
                      {{"EXT_meshopt_compression",
                        {{"buffer", 0},
                         {"byteOffset", binary.size()},
                         {"byteLength", encoded.size()},
                         {"byteStride", stride},
                         {"count", count},
                         {"mode", mode}}}}}});
    binary.insert(binary.end(), encoded.begin(), encoded.end());
    return views.size() - 1;
  }
};

std::vector<unsigned char> encode_vertices(const void* data, std::size_t count,
                                           std::size_t stride) {
  std::vector<unsigned char> encoded(meshopt_encodeVertexBufferBound(count, stride));
  encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), data, count, stride));
  return encoded;
}

std::size_t add_shorts(GlbParts& parts, const std::vector<Short3>& vectors) {
  std::vector<std::array<std::int16_t, 4>> padded;
  Short3 least = vectors.front();
  Short3 most = vectors.front();
  for (const Short3& vector : vectors) {
    padded.push_back({vector[0], vector[1], vector[2], 0});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], vector[axis]);
      most[axis] = std::max(most[axis], vector[axis]);
    }
  }
  const auto view = parts.add_view(encode_vertices(padded.data(), padded.size(), 8), padded.size(),
                                   8, "ATTRIBUTES");
  parts.accessors.push_back({{"bufferView", view},
                             {"componentType", 5122},
                             {"count", vectors.size()},
                             {"type", "VEC3"},
                             {"min", least},
                             {"max", most}});
  return parts.accessors.size() - 1;
}

std::size_t add_normals(GlbParts& parts, std::size_t count) {
  const std::vector<std::array<std::int8_t, 4>> up(count, {0, 127, 0, 0});
  const auto view = parts.add_view(encode_vertices(up.data(), count, 4), count, 4, "ATTRIBUTES");
  parts.accessors.push_back({{"bufferView", view},
                             {"componentType", 5120},
                             {"normalized", true},
                             {"count", count},
                             {"type", "VEC3"}});
  return parts.accessors.size() - 1;
}

std::size_t add_indices(GlbParts& parts, const FakeTile& tile, bool is_water) {
  std::vector<unsigned int> indices;
  for (std::size_t n = 0; n < tile.triangles.size(); ++n) {
    if (tile.in_water.contains(n) != is_water) continue;
    indices.insert(indices.end(), tile.triangles[n].begin(), tile.triangles[n].end());
  }
  std::vector<unsigned char> encoded(
      meshopt_encodeIndexBufferBound(indices.size(), tile.position.size()));
  encoded.resize(
      meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), indices.data(), indices.size()));
  const auto view = parts.add_view(encoded, indices.size(), 2, "TRIANGLES");
  parts.accessors.push_back({{"bufferView", view},
                             {"componentType", 5123},
                             {"count", indices.size()},
                             {"type", "SCALAR"}});
  return parts.accessors.size() - 1;
}

/// glTF is y up.
Short3 y_up(const Triple& triple, const Triple& origin) {
  return {static_cast<std::int16_t>(triple[0] - origin[0]),
          static_cast<std::int16_t>(triple[2] - origin[2]),
          static_cast<std::int16_t>(-(triple[1] - origin[1]))};
}

json glb_document(const FakeTile& tile, const FakeLevel& level, GlbParts& parts) {
  const Triple origin = tile.position.front();
  std::vector<Short3> positions;
  std::vector<Short3> morphs;
  for (std::size_t v = 0; v < tile.position.size(); ++v) {
    positions.push_back(y_up(tile.position[v], origin));
    morphs.push_back(y_up(tile.morph[v], {0, 0, 0}));
  }
  const auto position = add_shorts(parts, positions);
  const auto morph = add_shorts(parts, morphs);
  const auto normal = add_normals(parts, positions.size());
  const auto& step = level.step_m;
  json primitives = json::array();
  for (const bool is_water : {false, true}) {
    const std::size_t wet = tile.in_water.size();
    if ((is_water ? wet : tile.triangles.size() - wet) == 0) continue;
    primitives.push_back(
        {{"attributes", {{"POSITION", position}, {"_MORPH", morph}, {"NORMAL", normal}}},
         {"targets", json::array({{{"POSITION", morph}}})},
         {"indices", add_indices(parts, tile, is_water)},
         {"material", is_water ? 1 : 0}});
  }
  const json extras = {{"level", tile.level}, {"x", tile.x}, {"y", tile.y}, {"origin", origin}};
  return {
      {"asset", {{"version", "2.0"}}},
      {"nodes", json::array({{{"mesh", 0},
                              {"scale", {step[0], step[2], step[1]}},
                              {"translation",
                               {static_cast<double>(origin[0]) * step[0],
                                static_cast<double>(origin[2]) * step[2],
                                static_cast<double>(-origin[1]) * step[1]}}}})},
      {"materials", json::array({json::object(), {{"name", "water"}}})},
      {"meshes", json::array({{{"primitives", primitives}, {"extras", {{"terrane", extras}}}}})},
      {"accessors", parts.accessors},
      {"bufferViews", parts.views},
      {"buffers", json::array({{{"byteLength", parts.binary.size()}}, {{"byteLength", 1 << 20}}})}};
}

void append_word(std::string& bytes, std::size_t word) {
  const auto word32 = static_cast<std::uint32_t>(word);
  bytes.append(reinterpret_cast<const char*>(&word32), sizeof word32);
}

std::string glb_bytes(const FakeTile& tile, const FakeOutput& output) {
  GlbParts parts;
  json document = glb_document(tile, output.levels[static_cast<std::size_t>(tile.level)], parts);
  if (tile.level == 0 && tile.x == 0 && tile.y == 0) output.edit_glb(document);
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  parts.binary.resize((parts.binary.size() + 3) / 4 * 4, 0);
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, 12 + 8 + text.size() + 8 + parts.binary.size());
  append_word(bytes, text.size());
  bytes += "JSON" + text;
  append_word(bytes, parts.binary.size());
  bytes.append("BIN\0", 4);
  bytes.append(reinterpret_cast<const char*>(parts.binary.data()), parts.binary.size());
  return bytes;
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A box of the tile's vertices in plan, and of the output's heights.
std::array<double, 12> box_of(const FakeTile& tile, const FakeOutput& output) {
  const auto& step = output.levels[static_cast<std::size_t>(tile.level)].step_m;
  std::array<double, 2> low = {1e30, 1e30};
  std::array<double, 2> high = {-1e30, -1e30};
  for (std::size_t v = 0; v < tile.position.size(); ++v) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      // a parent's box has room for the rounding of the tiles below
      const double reach = output.levels.back().step_m[axis] * tile.level;
      const double at = static_cast<double>(tile.position[v][axis]) * step[axis];
      const double to = at + static_cast<double>(tile.morph[v][axis]) * step[axis];
      low[axis] = std::min({low[axis], at - reach, to - reach});
      high[axis] = std::max({high[axis], at + reach, to + reach});
    }
  }
  return {(low[0] + high[0]) / 2,
          (low[1] + high[1]) / 2,
          (output.lowest_m + output.highest_m) / 2,
          (high[0] - low[0]) / 2,
          0,
          0,
          0,
          (high[1] - low[1]) / 2,
          0,
          0,
          0,
          (output.highest_m - output.lowest_m) / 2};
}

double diagonal_of(const std::array<double, 12>& box) {
  return 2 * std::hypot(box[3], box[7], box[11]);
}

using TileIndex = std::map<std::array<std::int64_t, 3>, const FakeTile*>;

json tileset_entry(const FakeTile& tile, const FakeOutput& output, const TileIndex& index,
                   const std::map<const FakeTile*, std::size_t>& bytes) {
  json entry = {
      {"boundingVolume", {{"box", box_of(tile, output)}}},
      {"geometricError", output.levels[static_cast<std::size_t>(tile.level)].tolerance_m},
      {"content", {{"uri", fmt::format("tiles/{}/{}/{}.glb", tile.level, tile.x, tile.y)}}},
      {"extras",
       {{"terrane",
         {{"level", tile.level},
          {"x", tile.x},
          {"y", tile.y},
          {"triangles", tile.triangles.size()},
          {"bytes", bytes.at(&tile)},
          {"max_error_m", tile.max_error_m}}}}}};
  for (int child = 0; child < 4; ++child) {
    const auto found = index.find({tile.level - 1, 2 * tile.x + child % 2, 2 * tile.y + child / 2});
    if (found == index.end()) continue;
    entry["children"].push_back(tileset_entry(*found->second, output, index, bytes));
  }
  output.edit_tile(entry, tile);
  return entry;
}

json terrane_document(const FakeOutput& output,
                      const std::map<const FakeTile*, std::size_t>& bytes) {
  json document = {{"format", "terrane/1"},
                   {"dem", {{"columns", output.shape.columns}, {"rows", output.shape.rows}}},
                   {"frame", output.frame},
                   {"tile_cells", output.tile_cells},
                   {"levels_per_octave", 1},
                   {"levels", json::array()}};
  for (std::size_t level = 0; level < output.levels.size(); ++level) {
    std::size_t tiles = 0, triangles = 0, level_bytes = 0;
    double diagonal_m = 0;
    for (const FakeTile& tile : output.tiles) {
      if (tile.level != static_cast<int>(level)) continue;
      ++tiles;
      triangles += tile.triangles.size();
      level_bytes += bytes.at(&tile);
      diagonal_m = std::max(diagonal_m, diagonal_of(box_of(tile, output)));
    }
    document["levels"].push_back({{"level", level},
                                  {"tolerance_m", output.levels[level].tolerance_m},
                                  {"step_m", output.levels[level].step_m},
                                  {"tiles", tiles},
                                  {"triangles", triangles},
                                  {"bytes", level_bytes},
                                  {"max_error_m", output.levels[level].tolerance_m},
                                  {"rms_error_m", 0},
                                  {"largest_diagonal_m", diagonal_m}});
  }
  return document;
}

void write(const FakeOutput& output, const std::filesystem::path& folder) {
  std::map<const FakeTile*, std::size_t> bytes;
  TileIndex index;
  for (const FakeTile& tile : output.tiles) {
    const std::string glb = glb_bytes(tile, output);
    write_file(folder / fmt::format("tiles/{}/{}/{}.glb", tile.level, tile.x, tile.y), glb);
    bytes[&tile] = glb.size();
    index[{tile.level, tile.x, tile.y}] = &tile;
  }
  const auto root_level = static_cast<int>(output.levels.size()) - 1;
  json root = tileset_entry(*index.at({root_level, 0, 0}), output, index, bytes);
  root["refine"] = "REPLACE";
  if (!output.root_transform.empty()) root["transform"] = output.root_transform;
  write_file(folder / "tileset.json", json{{"root", root}}.dump());
  json terrane = terrane_document(output, bytes);
  output.edit_terrane(terrane);
  write_file(folder / "terrane.json", terrane.dump());
}

}  // namespace

HeightGrid FakeDem::read(const Window& window) const {
  HeightGrid grid{.window = window, .heights_m = {}};
  for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
      grid.heights_m.push_back(height_(column, row));
    }
  }
  return grid;
}

PlanPosition FlatPlace::to_plan(GridPosition position) const {
  const double right_m = kCell_m * position.column;
  const double down_m = kCell_m * position.row;
  const double c = std::cos(rotation_rad_);
  const double s = std::sin(rotation_rad_);
  return {c * right_m + s * down_m, s * right_m - c * down_m};
}

PlanPosition GeographicPlace::to_plan(GridPosition position) const {
  return {first_.longitude_deg + spacing_deg_ * position.column,
          first_.latitude_deg - spacing_deg_ * position.row};
}

std::vector<LonLat> GeographicPlace::to_lon_lat(std::span<const GridPosition> positions) const {
  std::vector<LonLat> places;
  for (const GridPosition& position : positions) {
    const PlanPosition plan = to_plan(position);
    places.push_back({plan.x, plan.y});
  }
  return places;
}

std::size_t FakeTile::vertex_at(std::int64_t column, std::int64_t row) const {
  const std::array<std::int64_t, 2> wanted = {column, row};
  const auto found = std::find(sample.begin(), sample.end(), wanted);
  if (found == sample.end()) throw std::logic_error("no vertex stands on this sample");
  return static_cast<std::size_t>(found - sample.begin());
}

std::size_t FakeTile::triangle_at(std::array<std::array<std::int64_t, 2>, 3> samples) const {
  std::sort(samples.begin(), samples.end());
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    std::array corners = {sample[triangles[n][0]], sample[triangles[n][1]],
                          sample[triangles[n][2]]};
    std::sort(corners.begin(), corners.end());
    if (corners == samples) return n;
  }
  throw std::logic_error("no triangle has these corners");
}

FakeTile& FakeOutput::tile(int level, std::int64_t x, std::int64_t y) {
  const auto found = std::find_if(tiles.begin(), tiles.end(), [&](const FakeTile& tile) {
    return tile.level == level && tile.x == x && tile.y == y;
  });
  if (found == tiles.end()) throw std::logic_error("no such tile");
  return *found;
}

void FakeOutput::drop_tile(int level, std::int64_t x, std::int64_t y) {
  tiles.erase(tiles.begin() + (&tile(level, x, y) - tiles.data()));
}

FakeOutput halved_grids(const FakeDem& dem, const ToWorld& to_world, int tile_cells,
                        double tolerance_m) {
  return make_output(dem, to_world, tile_cells, tolerance_m, {0.25, 0.25, 0.25}, true);
}

FakeOutput repeated_grids(const FakeDem& dem, const ToWorld& to_world, int tile_cells,
                          double tolerance_m, const std::array<double, 3>& step_m) {
  return make_output(dem, to_world, tile_cells, tolerance_m, step_m, false);
}

ToWorld flat_world(const FlatPlace& place) {
  return [place](double column, double row, double height_m) {
    const PlanPosition plan = place.to_plan({column, row});
    return std::array<double, 3>{plan.x, plan.y, height_m};
  };
}

WrittenOutput::WrittenOutput(const FakeOutput& output) {
  std::string pattern = (std::filesystem::temp_directory_path() / "terrane_verify_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
  write(output, folder_);
}

WrittenOutput::~WrittenOutput() { std::filesystem::remove_all(folder_); }

VerifyReport verdict_on(const FakeOutput& output, const FakeDem& dem, const Georeference& place,
                        std::vector<WaterArea> water) {
  const WrittenOutput written(output);
  NoProgress progress;
  return verify::verify(written.folder(), dem, place, {.jobs = 1, .water = std::move(water)},
                        progress);
}

}  // namespace terrane::verify::testing
