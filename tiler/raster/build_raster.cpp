#include "tiler/raster/build_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/errors.h"
#include "tiler/files/begin_output.h"
#include "tiler/files/whole_file.h"
#include "tiler/raster/half_size.h"

namespace terrane::tiler {
namespace {

namespace fs = std::filesystem;

fs::path summary_of(const fs::path& out) { return out / "terrane.json"; }
fs::path tile_json_of(const fs::path& out) { return out / "tiles.json"; }
fs::path zoom_of(const fs::path& out, int zoom) { return out / fmt::format("{}", zoom); }

struct ZoomSummary {
  std::int64_t tiles = 0, bytes = 0;
};

/// The tiles that hold something at each zoom, round the Earth as often as they go.
class MercatorPyramid {
 public:
  explicit MercatorPyramid(const MercatorTiles& finest) : finest_(finest) {}

  int finest_zoom() const { return finest_.zoom; }

  /// The tile as it is counted among the finest tiles; -1: not one of them.
  std::int64_t counted(int zoom, std::int64_t x, std::int64_t y) const {
    const MercatorTiles tiles = finest_.at(zoom);
    if (y < tiles.y || y >= tiles.y + tiles.rows) return -1;
    const std::int64_t across = std::int64_t{1} << zoom;
    for (const std::int64_t turned : {x, x + across}) {
      if (turned >= tiles.x && turned < tiles.x + tiles.columns) return turned;
    }
    return -1;
  }

  std::int64_t count() const {
    std::int64_t count = 0;
    for (int zoom = 0; zoom <= finest_.zoom; ++zoom) {
      const MercatorTiles tiles = finest_.at(zoom);
      count += std::min(tiles.columns, std::int64_t{1} << zoom) * tiles.rows;
    }
    return count;
  }

 private:
  MercatorTiles finest_;
};

class RasterBuild {
 public:
  RasterBuild(const MercatorHeights& heights, const HeightStatistics& statistics,
              const RasterOptions& options, const fs::path& out, Progress& progress)
      : heights_(heights),
        statistics_(statistics),
        options_(options),
        out_(out),
        progress_(progress),
        key_(raster_key(statistics, options)),
        pyramid_(heights.tiles()),
        zooms_(static_cast<std::size_t>(pyramid_.finest_zoom()) + 1) {}

  BuildResult run() {
    begin_output(out_, key_);
    progress_.begin("writing tiles", pyramid_.count());
    add_tile(0, 0, 0);
    write_whole_file(tile_json_of(out_), tile_json());
    write_whole_file(summary_of(out_), summary_json());
    std::error_code error;
    fs::remove_all(out_ / ".work", error);
    BuildResult result{.levels = static_cast<int>(zooms_.size())};
    for (const ZoomSummary& zoom : zooms_) {
      result.tiles += zoom.tiles;
      result.bytes += zoom.bytes;
    }
    return result;
  }

 private:
  /// Writes a tile and all below it.
  /// \return its heights.
  std::vector<float> add_tile(int zoom, std::int64_t x, std::int64_t y) {
    const int px = heights_.tile_px();
    std::vector<float> heights;
    if (zoom == pyramid_.finest_zoom()) {
      heights = heights_.read(pyramid_.counted(zoom, x, y), y);
    } else {
      heights.assign(static_cast<std::size_t>(px) * static_cast<std::size_t>(px),
                     std::numeric_limits<float>::quiet_NaN());
      for (const int k : {0, 1, 2, 3}) {
        const std::int64_t child_x = 2 * x + k % 2, child_y = 2 * y + k / 2;
        if (pyramid_.counted(zoom + 1, child_x, child_y) < 0) continue;
        add_half_size(add_tile(zoom + 1, child_x, child_y), px, k % 2 == 1, k / 2 == 1, heights);
      }
    }
    write_tile(zoom, x, y, heights);
    progress_.advance(1);
    return heights;
  }

  void write_tile(int zoom, std::int64_t x, std::int64_t y, const std::vector<float>& heights) {
    const fs::path file = zoom_of(out_, zoom) / fmt::format("{}/{}.{}", x, y, options_.extension);
    std::error_code error;
    if (!fs::exists(file, error)) {
      const auto rgb = colours_of(heights, options_.encoding, options_.fill_m);
      write_whole_file(file, options_.encode(rgb, heights_.tile_px()));
    }
    ZoomSummary& of = zooms_[static_cast<std::size_t>(zoom)];
    ++of.tiles;
    of.bytes += static_cast<std::int64_t>(fs::file_size(file));
  }

  std::string tile_json() const {
    nlohmann::ordered_json json;
    json["tilejson"] = "3.0.0";
    json["name"] = options_.name;
    json["version"] = "1.0.0";
    json["scheme"] = "xyz";
    json["tiles"] = {"{z}/{x}/{y}." + options_.extension};
    json["minzoom"] = 0;
    json["maxzoom"] = pyramid_.finest_zoom();
    json["bounds"] = options_.bounds_deg;
    json["tileSize"] = heights_.tile_px();
    json["encoding"] = maplibre_name(options_.encoding);
    if (!options_.attribution.empty()) json["attribution"] = options_.attribution;
    return json.dump(2) + "\n";
  }

  std::string summary_json() const {
    nlohmann::ordered_json json;
    json["format"] = "terrane-raster/1";
    json["generator"] = TERRANE_GENERATOR;
    json["key"] = key_;
    json["source"] = options_.source;
    json["encoding"] = maplibre_name(options_.encoding);
    json["tile_px"] = heights_.tile_px();
    json["dem"] = {{"samples_with_data", statistics_.samples_with_data},
                   {"min_height_m", statistics_.min_height_m},
                   {"max_height_m", statistics_.max_height_m},
                   {"fingerprint", statistics_.fingerprint}};
    for (std::size_t zoom = 0; zoom < zooms_.size(); ++zoom) {
      json["zooms"].push_back(
          {{"zoom", zoom}, {"tiles", zooms_[zoom].tiles}, {"bytes", zooms_[zoom].bytes}});
    }
    return json.dump(2) + "\n";
  }

  const MercatorHeights& heights_;
  const HeightStatistics& statistics_;
  const RasterOptions& options_;
  const fs::path& out_;
  Progress& progress_;
  std::string key_;
  MercatorPyramid pyramid_;
  std::vector<ZoomSummary> zooms_;
};

}  // namespace

std::string raster_key(const HeightStatistics& statistics, const RasterOptions& options) {
  return fmt::format("raster {} {} {} {} {} {} {}", TERRANE_GENERATOR, statistics.fingerprint,
                     maplibre_name(options.encoding), options.fill_m, options.extension,
                     options.source, options.attribution);
}

bool is_finished_raster(const fs::path& out, const std::string& key) {
  try {
    const auto summary = nlohmann::json::parse(read_whole_file(summary_of(out)));
    if (summary.at("key") != key || !fs::exists(tile_json_of(out))) return false;
    for (const auto& zoom : summary.at("zooms")) {
      const std::int64_t bytes = bytes_below(zoom_of(out, zoom.at("zoom").get<int>()));
      if (bytes != zoom.at("bytes").get<std::int64_t>()) return false;
    }
    return true;
  } catch (const std::exception&) {
    return false;  // nothing there, or not whole: the same to whoever asks
  }
}

void check_range(const HeightStatistics& statistics, const RasterOptions& options) {
  const HeightRange range = range_of(options.encoding);
  const double low_m = std::min(statistics.min_height_m, options.fill_m);
  const double high_m = std::max(statistics.max_height_m, options.fill_m);
  if (low_m >= range.low_m && high_m <= range.high_m) return;
  throw ConfigError(fmt::format(
      "--format: heights from {} to {} m are not in the {} to {:.1f} m that it holds. Use "
      "{}, or check --nodata and --vertical-unit",
      low_m, high_m, range.low_m, range.high_m,
      options.encoding == HeightEncoding::kTerrarium ? "terrain-rgb" : "terrarium"));
}

BuildResult build_raster(const MercatorHeights& heights, const HeightStatistics& statistics,
                         const RasterOptions& options, const fs::path& out, Progress& progress) {
  check_range(statistics, options);
  return RasterBuild(heights, statistics, options, out, progress).run();
}

}  // namespace terrane::tiler
