#include "tiler/geodetic/build_geodetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/deflate/deflate.h"
#include "core/errors.h"
#include "tiler/files/begin_output.h"
#include "tiler/files/whole_file.h"
#include "tiler/geodetic/build_band.h"
#include "tiler/geodetic/layer_json.h"
#include "tiler/geodetic/quantized_mesh.h"
#include "tiler/geodetic/terrain_glb.h"
#include "tiler/geodetic/terrain_tileset.h"

namespace terrane::tiler {
namespace {

namespace fs = std::filesystem;

// share of it that a tile with posts of its own may be off: a globe must look like one where
// nothing finer is
constexpr double kLargestSeenShare = 1.0 / 16;
// what nobody sees; and no polynomial follows the whole globe much more closely (TileFrame)
constexpr double kSmallestSeenShare = 1.0 / 64;

std::string hash_hex(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

fs::path summary_of(const fs::path& out) { return out / "terrane.json"; }
fs::path work_of(const fs::path& out) { return out / ".work"; }

/// What clients open.
fs::path entrance_of(const fs::path& out, TerrainFormat format) {
  return out / (format == TerrainFormat::k3dTiles ? "tileset.json" : "layer.json");
}

/// Where the tiles of a zoom are, in any format.
std::array<fs::path, 3> folders_of(const fs::path& out, int zoom) {
  const std::string name = fmt::format("{}", zoom);
  return {out / name, out / "west" / name, out / "east" / name};
}

/// One zoom of what is written.
struct ZoomSummary {
  int zoom = 0;
  double tolerance_m = 0;
  bool is_held_to_finest = false;  ///< measured against every post of the finest zoom
  std::int64_t tiles = 0, triangles = 0, bytes = 0;
  double max_error_m = 0;
};

class GeodeticBuild {
 public:
  GeodeticBuild(const GeodeticHeights& heights, const HeightStatistics& statistics,
                const GeodeticOptions& options, const fs::path& out, Progress& progress)
      : heights_(heights),
        statistics_(statistics),
        options_(options),
        out_(out),
        progress_(progress),
        key_(geodetic_key(statistics, options)),
        tiles_(heights.tiles()) {
    for (int zoom = 0; zoom <= tiles_.zoom; ++zoom) available_.push_back(available(zoom));
  }

  BuildResult run() {
    begin_output(out_, key_);
    const int top = coarsest_from_finest();
    add_band({.tiles = tiles_.at(tiles_.zoom - top).refined(tiles_.zoom), .wanted = tiles_}, top);
    for (int zoom = tiles_.zoom - top - 1; zoom >= 0; --zoom) {
      const GeodeticTiles tiles = available(zoom);
      add_band({.tiles = tiles, .wanted = tiles}, 0);
    }
    std::ranges::reverse(zooms_);
    return finish();
  }

 private:
  double tolerance_m(int zoom) const {
    return std::ldexp(options_.tolerance_m, tiles_.zoom - zoom);
  }

  /// Of a zoom with posts of its own.
  double own_tolerance_m(int zoom) const {
    const double counted_m = std::ldexp(kLevelZeroError_m, -zoom);
    const double seen_m = std::clamp(tolerance_m(zoom), kSmallestSeenShare * counted_m,
                                     kLargestSeenShare * counted_m);
    return std::max(seen_m, zooms_.back().tolerance_m);
  }

  /// Levels above the finest one that are built from it: up to where four tiles hold the DEM, and
  /// not the roots, as no polynomial follows both of them round the Earth (TileFrame).
  int coarsest_from_finest() const {
    int level = 0;
    for (; level < tiles_.zoom - 1; ++level) {
      const GeodeticTiles tiles = tiles_.at(tiles_.zoom - level);
      if (tiles.columns <= 2 && tiles.rows <= 2) break;
    }
    return level;
  }

  GeodeticTiles available(int zoom) const {
    const GeodeticTiles tiles = tiles_.at(zoom);
    // both roots, whether the DEM reaches them or not
    if (zoom == 0 && tiles.columns < 2) return {.zoom = 0, .x = 0, .y = 0, .columns = 2, .rows = 1};
    return tiles;
  }

  /// Builds the levels 0 to \p top of a band.
  void add_band(BandOptions band, int top) {
    const int zoom = band.tiles.zoom;
    const bool is_finest = zoom == tiles_.zoom;
    for (int level = 0; level <= top; ++level) {
      band.tolerance_m.push_back(is_finest ? tolerance_m(zoom - level) : own_tolerance_m(zoom));
    }
    band.holds_dem_samples = is_finest && options_.holds_dem_samples;
    band.work = work_of(out_) / fmt::format("{}", zoom);
    band.jobs = options_.jobs > 0
                    ? options_.jobs
                    : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const std::vector<TileRecord> records = build_band(
        heights_, band, [this](const TerrainTile& tile) { return write(tile); }, progress_);
    std::vector<ZoomSummary> zooms;
    for (int level = 0; level <= top; ++level) {
      zooms.push_back({zoom - level, band.tolerance_m[level], is_finest});
    }
    for (const TileRecord& record : records) {
      ZoomSummary& of = zooms[record.tile.level];
      ++of.tiles;
      of.triangles += record.triangles;
      of.bytes += record.bytes;
      of.max_error_m = std::max(of.max_error_m, record.error.max_m);
    }
    zooms_.insert(zooms_.end(), zooms.begin(), zooms.end());
  }

  std::int64_t write(const TerrainTile& tile) const {
    return options_.format == TerrainFormat::k3dTiles ? write_glb(tile)
                                                      : write_quantized_mesh(tile);
  }

  fs::path facts_of_tile(const TmsTile& tile) const {
    return work_of(out_) / "facts" / path_of(tile);
  }

  std::int64_t write_glb(const TerrainTile& tile) const {
    const double step_m =
        place_step_m(tile.tile.zoom, heights_.max_height_m() - heights_.min_height_m());
    const std::string glb = encode_terrain_glb(tile, step_m, options_.attribution);
    write_whole_file(out_ / glb_path_of(tile.tile), glb);
    write_facts(facts_of(tile, glb_places_of(tile, step_m)), facts_of_tile(tile.tile));
    return static_cast<std::int64_t>(glb.size());
  }

  std::int64_t write_quantized_mesh(TerrainTile tile) const {
    tile.metadata = tile_metadata(tile.tile, available_);
    if (options_.water) {
      const TmsBounds b = bounds_of(tile.tile);
      tile.water = options_.water(b.west_deg, b.south_deg, b.east_deg, b.north_deg);
    }
    const std::string bytes = gzip(encode_quantized_mesh(tile));
    write_whole_file(out_ / (path_of(tile.tile) + ".terrain"), bytes);
    return static_cast<std::int64_t>(bytes.size());
  }

  BuildResult finish() const {
    if (options_.format == TerrainFormat::k3dTiles) {
      for (const OutputFile& file : terrain_tileset(
               available_, options_.attribution,
               [this](const TmsTile& tile) { return read_facts(facts_of_tile(tile)); })) {
        write_whole_file(out_ / file.path, file.content);
      }
    } else {
      const TerrainLayer layer{.version = key_,
                               .attribution = options_.attribution,
                               .available = available_,
                               .has_water = options_.water != nullptr};
      write_whole_file(entrance_of(out_, options_.format), layer_json(layer));
    }
    write_whole_file(summary_of(out_), summary_json());
    std::error_code error;
    fs::remove_all(work_of(out_), error);

    BuildResult result{.levels = static_cast<int>(zooms_.size())};
    for (const ZoomSummary& zoom : zooms_) {
      result.tiles += zoom.tiles;
      result.bytes += zoom.bytes;
    }
    result.triangles = zooms_.back().triangles;
    result.max_error_m = zooms_.back().max_error_m;
    return result;
  }

  const char* held_to(const ZoomSummary& zoom) const {
    if (!zoom.is_held_to_finest) return "own posts";
    return options_.holds_dem_samples ? "DEM samples" : "finest posts";
  }

  std::string summary_json() const {
    nlohmann::ordered_json json;
    json["format"] = "terrane-geodetic/1";
    json["generator"] = TERRANE_GENERATOR;
    json["key"] = key_;
    json["tiles"] =
        options_.format == TerrainFormat::k3dTiles ? "3dtiles-terrain" : "quantized-mesh";
    json["bounds"] = bounds_deg(tiles_);
    json["source"] = options_.source;
    json["dem"] = {{"samples_with_data", statistics_.samples_with_data},
                   {"fingerprint", statistics_.fingerprint}};
    json["resampling"] = {{"method", options_.resampling.method},
                          {"max_error_m", options_.resampling.max_error_m},
                          {"rms_error_m", options_.resampling.rms_error_m}};
    for (const ZoomSummary& zoom : zooms_) {
      json["zooms"].push_back({{"zoom", zoom.zoom},
                               {"tolerance_m", zoom.tolerance_m},
                               {"held_to", held_to(zoom)},
                               {"max_error_m", zoom.max_error_m},
                               {"tiles", zoom.tiles},
                               {"triangles", zoom.triangles},
                               {"bytes", zoom.bytes}});
    }
    return json.dump(2) + "\n";
  }

  const GeodeticHeights& heights_;
  const HeightStatistics& statistics_;
  const GeodeticOptions& options_;
  const fs::path& out_;
  Progress& progress_;
  std::string key_;
  GeodeticTiles tiles_;
  std::vector<GeodeticTiles> available_;  // of each zoom
  std::vector<ZoomSummary> zooms_;
};

}  // namespace

std::string geodetic_key(const HeightStatistics& statistics, const GeodeticOptions& options) {
  return hash_hex(fmt::format("geodetic 3 {} {} {} {} {} {} {}", TERRANE_GENERATOR,
                              static_cast<int>(options.format), options.tolerance_m,
                              statistics.fingerprint, options.source, options.attribution,
                              options.water_fingerprint));
}

bool is_finished(const fs::path& out, const std::string& key) {
  try {
    const auto summary = nlohmann::json::parse(read_whole_file(summary_of(out)));
    const auto format = summary.at("tiles") == "3dtiles-terrain" ? TerrainFormat::k3dTiles
                                                                 : TerrainFormat::kQuantizedMesh;
    if (summary.at("key") != key || !fs::exists(entrance_of(out, format))) return false;
    for (const auto& zoom : summary.at("zooms")) {
      std::int64_t bytes = 0;
      for (const fs::path& folder : folders_of(out, zoom.at("zoom").get<int>())) {
        bytes += bytes_below(folder);
      }
      if (bytes != zoom.at("bytes").get<std::int64_t>()) return false;
    }
    return true;
  } catch (const std::exception&) {
    return false;  // nothing there, or not whole: the same to whoever asks
  }
}

BuildResult build_geodetic(const GeodeticHeights& heights, const HeightStatistics& statistics,
                           const GeodeticOptions& options, const fs::path& out,
                           Progress& progress) {
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m)) {
    throw ConfigError(
        fmt::format("--tolerance {}: must be a number of metres above 0", options.tolerance_m));
  }
  return GeodeticBuild(heights, statistics, options, out, progress).run();
}

}  // namespace terrane::tiler
