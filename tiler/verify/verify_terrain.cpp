#include "tiler/verify/verify_terrain.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "core/errors.h"
#include "tiler/verify/terrain_errors.h"
#include "tiler/verify/terrain_examination.h"

namespace terrane::verify {
namespace {

constexpr std::size_t kMostLines = 100;

/// What is left of a tile once it was examined.
struct Examined {
  TerrainKey key;
  std::optional<std::array<std::vector<BorderVertex>, 4>> borders;  ///< none: unreadable
  std::int64_t triangles = 0, bytes = 0;
  std::vector<FaultFound> faults;
};

class Verification {
 public:
  explicit Verification(TerrainLayer layer) : layer_(std::move(layer)) {
    for (std::size_t zoom = 0; zoom < layer_.zooms.size(); ++zoom) {
      report_.zooms.push_back({.zoom = static_cast<int>(zoom),
                               .tolerance_m = layer_.zooms[zoom].tolerance_m,
                               .is_held_to_dem = layer_.zooms[zoom].is_held_to_dem});
    }
  }

  void check_files(Progress& progress) {
    check_layer();
    find_unexpected();
    for (int zoom = 0; zoom <= layer_.finest(); ++zoom) {
      const std::vector<std::vector<TerrainKey>> rows = rows_of(zoom);
      progress.begin(fmt::format("verifying zoom {}", zoom),
                     static_cast<std::int64_t>(rows.size()));
      std::vector<Examined> below;
      for (const std::vector<TerrainKey>& row : rows) {
        std::vector<Examined> tiles = examine(row);
        for (const Examined& tile : tiles) count(tile);
        compare_along(tiles);
        compare_across(below, tiles);
        below = std::move(tiles);
        progress.advance(1);
      }
    }
  }

  void check_errors(const std::vector<TerrainErrors>& errors) {
    for (std::size_t zoom = 0; zoom < errors.size(); ++zoom) {
      TerrainZoomReport& found = report_.zooms[zoom];
      const TerrainErrors& measured = errors[zoom];
      found.max_error_m = measured.max_m;
      found.samples = measured.samples;
      found.uncovered_samples = measured.uncovered;
      found.samples_over_tolerance = measured.over_tolerance;
      const auto covered = static_cast<double>(measured.samples - measured.uncovered);
      found.rms_error_m = covered > 0 ? std::sqrt(measured.square_sum_m2 / covered) : 0;
      if (measured.over_tolerance > 0) {
        say(fmt::format(
            "zoom {}: {} samples are farther than {} m off, the worst {:.3f} m at {:.6f} "
            "E, {:.6f} N",
            zoom, measured.over_tolerance, found.tolerance_m, measured.max_m,
            measured.worst.longitude_deg, measured.worst.latitude_deg));
      }
      if (measured.uncovered > 0) {
        say(fmt::format("zoom {}: {} samples have no triangle", zoom, measured.uncovered));
      }
      check_stated(zoom, measured);
    }
  }

  TerrainReport take() { return std::move(report_); }

 private:
  void say(std::string line) {
    if (report_.problems.size() < kMostLines) {
      report_.problems.push_back(std::move(line));
    } else {
      ++report_.problems_left_out;
    }
  }

  void note(const TerrainKey& key, TerrainFault fault, std::int64_t count,
            const std::string& what) {
    report_.zooms[static_cast<std::size_t>(key.zoom)].faults[static_cast<std::size_t>(fault)] +=
        count;
    say(fmt::format("{}: {}", to_string(key), what));
  }

  void misstate(int zoom, const std::string& what) {
    ++report_.zooms[static_cast<std::size_t>(zoom)]
          .faults[static_cast<std::size_t>(TerrainFault::kMisstated)];
    say(what);
  }

  void check_layer() {
    for (const std::string& fault : layer_.faults_of_the_listing) misstate(0, fault);
    if (layer_.kind == TerrainKind::kQuantizedMesh) check_layer_json();
    for (const std::int64_t x : {0, 1}) {
      if (layer_.has({0, x, 0})) continue;
      note({0, x, 0}, TerrainFault::kMissing, 1, "is a root and not listed as available");
    }
  }

  void check_layer_json() {
    if (layer_.format != "quantized-mesh-1.0" || layer_.scheme != "tms" ||
        layer_.projection != "EPSG:4326") {
      misstate(0, fmt::format("layer.json: is '{}', '{}', '{}'. Expected quantized-mesh-1.0, tms, "
                              "EPSG:4326",
                              layer_.format, layer_.scheme, layer_.projection));
    }
    for (int zoom = 0; zoom <= layer_.finest(); ++zoom) {
      for (const TerrainRange& r : layer_.available[static_cast<std::size_t>(zoom)]) {
        if (r.start_x >= 0 && r.start_y >= 0 && r.start_x <= r.end_x && r.start_y <= r.end_y &&
            r.end_x < std::int64_t{2} << zoom && r.end_y < std::int64_t{1} << zoom) {
          continue;
        }
        throw InputError(fmt::format("{}: zoom {} has a range outside the quadtree. Build again",
                                     (layer_.folder / "layer.json").string(), zoom));
      }
    }
  }

  /// Files that no one asks for.
  void find_unexpected() {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(layer_.folder)) {
      if (!entry.is_regular_file() || entry.path().extension() != layer_.extension()) continue;
      const auto path = entry.path().lexically_relative(layer_.folder).generic_string();
      const std::optional<TerrainKey> key = layer_.key_of(path);
      if (key && layer_.has(*key)) continue;
      say(fmt::format("{}: is not listed", path));
      ++report_.zooms[static_cast<std::size_t>(key ? key->zoom : 0)]
            .faults[static_cast<std::size_t>(TerrainFault::kUnexpected)];
    }
  }

  /// The tiles of a zoom, row by row from the south; each row from the west.
  std::vector<std::vector<TerrainKey>> rows_of(int zoom) const {
    std::map<std::int64_t, std::set<std::int64_t>> by_row;
    for (const TerrainRange& r : layer_.available[static_cast<std::size_t>(zoom)]) {
      for (std::int64_t y = r.start_y; y <= r.end_y; ++y) {
        for (std::int64_t x = r.start_x; x <= r.end_x; ++x) by_row[y].insert(x);
      }
    }
    std::vector<std::vector<TerrainKey>> rows;
    for (const auto& [y, columns] : by_row) {
      auto& row = rows.emplace_back();
      for (const std::int64_t x : columns) row.push_back({zoom, x, y});
    }
    return rows;
  }

  std::vector<Examined> examine(const std::vector<TerrainKey>& row) const {
    std::vector<Examined> tiles(row.size());
    tbb::parallel_for(std::size_t{0}, row.size(),
                      [&](std::size_t k) { tiles[k] = examine(row[k]); });
    return tiles;
  }

  Examined examine(const TerrainKey& key) const {
    Examined examined{.key = key};
    if (key.zoom > 0 && !layer_.has({key.zoom - 1, key.x / 2, key.y / 2})) {
      examined.faults.push_back({TerrainFault::kMissing, 1, "has no parent"});
    }
    if (!std::filesystem::exists(layer_.file_of(key))) {
      examined.faults.push_back({TerrainFault::kMissing, 1, "is listed, but there is no file"});
      return examined;
    }
    try {
      const TerrainFile tile = read_tile(layer_, key);
      examined.triangles = static_cast<std::int64_t>(tile.triangles.size());
      examined.bytes = tile.bytes;
      for (FaultFound& found : examine_terrain(tile, key, layer_)) {
        examined.faults.push_back(std::move(found));
      }
      auto& borders = examined.borders.emplace();
      for (const TerrainFile::Side side : kTerrainSides) {
        borders[side] = border_of(tile, side);
      }
    } catch (const InputError& error) {
      examined.faults.push_back({TerrainFault::kUnreadable, 1, error.what()});
    }
    return examined;
  }

  void count(const Examined& tile) {
    TerrainZoomReport& zoom = report_.zooms[static_cast<std::size_t>(tile.key.zoom)];
    ++zoom.tiles;
    zoom.triangles += tile.triangles;
    zoom.bytes += tile.bytes;
    for (const FaultFound& found : tile.faults)
      note(tile.key, found.fault, found.count, found.what);
  }

  /// Neighbours of a row, the last and the first across the meridian of 180 degrees too.
  void compare_along(const std::vector<Examined>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const Examined& east = row[(k + 1) % row.size()];
      const std::int64_t around = std::int64_t{2} << row[k].key.zoom;
      if ((row[k].key.x + 1) % around != east.key.x) continue;
      compare(row[k], TerrainFile::kEast, east, TerrainFile::kWest);
    }
  }

  void compare_across(const std::vector<Examined>& south, const std::vector<Examined>& north) {
    for (const Examined& tile : north) {
      const auto below = std::ranges::lower_bound(south, tile.key.x, {},
                                                  [](const Examined& t) { return t.key.x; });
      if (below == south.end() || below->key.x != tile.key.x) continue;
      if (below->key.y + 1 == tile.key.y) {
        compare(*below, TerrainFile::kNorth, tile, TerrainFile::kSouth);
      }
    }
  }

  void compare(const Examined& a, TerrainFile::Side side_a, const Examined& b,
               TerrainFile::Side side_b) {
    if (!a.borders || !b.borders) return;
    const std::vector<BorderVertex>& mine = (*a.borders)[side_a];
    const std::vector<BorderVertex>& theirs = (*b.borders)[side_b];
    std::vector<BorderVertex> differing;
    std::ranges::set_symmetric_difference(mine, theirs, std::back_inserter(differing));
    report_.zooms[static_cast<std::size_t>(a.key.zoom)].border_vertices +=
        static_cast<std::int64_t>(mine.size());
    if (differing.empty()) return;
    note(a.key, TerrainFault::kBorders, static_cast<std::int64_t>(differing.size()),
         fmt::format("and {}: {} border vertices differ", to_string(b.key), differing.size()));
  }

  void check_stated(std::size_t zoom, const TerrainErrors& measured) {
    const auto& stated = layer_.zooms[zoom];
    const TerrainZoomReport& found = report_.zooms[zoom];
    const auto number = static_cast<int>(zoom);
    const auto check = [&](const char* what, std::int64_t says, std::int64_t are) {
      if (says == are) return;
      misstate(number, fmt::format("terrane.json: zoom {} states {} {}, the tiles have {}", zoom,
                                   says, what, are));
    };
    check("tiles", stated.tiles, found.tiles);
    check("triangles", stated.triangles, found.triangles);
    check("bytes", stated.bytes, found.bytes);
    if (!stated.is_held_to_dem ||
        measured.max_m <= stated.max_error_m + layer_.rounding_m(number)) {
      return;
    }
    misstate(number, fmt::format("terrane.json: zoom {} states an error of {} m, measured are {} m",
                                 zoom, stated.max_error_m, measured.max_m));
  }

  TerrainLayer layer_;
  TerrainReport report_;
};

}  // namespace

TerrainReport verify_terrain(const std::filesystem::path& folder, const HeightSource& heights,
                             const Georeference& place, const Undulation& undulation,
                             const VerifyOptions& options, Progress& progress) {
  tbb::task_arena arena(options.jobs > 0 ? options.jobs : tbb::task_arena::automatic);
  return arena.execute([&] {
    const TerrainLayer layer = read_terrain_layer(folder);
    Verification verification(layer);
    verification.check_files(progress);
    verification.check_errors(measure_terrain(layer, heights, place, undulation, progress));
    return verification.take();
  });
}

}  // namespace terrane::verify
