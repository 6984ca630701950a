#include "tiler/verify/terrain_errors.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "core/errors.h"
#include "tiler/verify/terrain_examination.h"
#include "tiler/verify/terrain_surface.h"

namespace terrane::verify {
namespace {

constexpr std::int64_t kStripRows = 64;
constexpr std::int64_t kBlockColumns = 64;

/// A sample of the DEM and its height over the ellipsoid.
struct PlacedHeight {
  LonLat place;
  double height_m = 0;
};

TerrainKey tile_at(const LonLat& place, int zoom) {
  const TerrainKey key{zoom, 0, 0};
  const auto index = [&](double deg) {
    return static_cast<std::int64_t>(std::floor(deg / key.side_deg()));
  };
  const std::int64_t around = std::int64_t{2} << zoom, up = std::int64_t{1} << zoom;
  return {zoom, (index(place.longitude_deg + 180) % around + around) % around,
          std::clamp<std::int64_t>(index(place.latitude_deg + 90), 0, up - 1)};
}

class Measurement {
 public:
  Measurement(const TerrainLayer& layer, const HeightSource& heights, const Georeference& place,
              const Undulation& undulation)
      : layer_(layer),
        heights_(heights),
        place_(place),
        undulation_(undulation),
        errors_(layer.available.size()) {}

  void add_strip(std::int64_t row) {
    const GridShape shape = heights_.shape();
    const std::int64_t rows = std::min(kStripRows, shape.rows - row);
    std::vector<Window> windows;
    for (std::int64_t column = 0; column < shape.columns; column += kBlockColumns) {
      windows.push_back({column, row, std::min(kBlockColumns, shape.columns - column), rows});
    }
    std::vector<std::vector<PlacedHeight>> blocks(windows.size());
    tbb::parallel_for(std::size_t{0}, windows.size(),
                      [&](std::size_t k) { blocks[k] = read_block(windows[k]); });
    load_tiles(blocks);
    std::vector<std::vector<TerrainErrors>> found(windows.size());
    tbb::parallel_for(std::size_t{0}, windows.size(),
                      [&](std::size_t k) { found[k] = judge(blocks[k]); });
    for (const auto& block : found) add(block);
  }

  std::vector<TerrainErrors> take() { return std::move(errors_); }

 private:
  std::vector<PlacedHeight> read_block(const Window& window) const {
    const HeightGrid grid = heights_.read(window);
    std::vector<GridPosition> positions;
    std::vector<PlacedHeight> samples;
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        if (!grid.has_data(column, row)) continue;
        positions.push_back({static_cast<double>(column), static_cast<double>(row)});
        samples.push_back({{}, double{grid.at(column, row)}});
      }
    }
    if (positions.empty()) return samples;
    const std::vector<LonLat> places = place_.to_lon_lat(positions);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].place = places[i];
      samples[i].height_m += undulation_(places[i]);
    }
    return samples;
  }

  /// Keeps the tiles that the strip before needed as well, and reads the others.
  void load_tiles(const std::vector<std::vector<PlacedHeight>>& blocks) {
    std::map<TerrainKey, std::unique_ptr<TerrainSurface>> needed;
    for (const auto& block : blocks) {
      for (const PlacedHeight& sample : block) {
        for (int zoom = 0; zoom <= layer_.finest(); ++zoom) {
          needed.try_emplace(tile_at(sample.place, zoom));
        }
      }
    }
    std::vector<std::pair<const TerrainKey, std::unique_ptr<TerrainSurface>>*> missing;
    for (auto& entry : needed) {
      const auto found = surfaces_.find(entry.first);
      if (found != surfaces_.end()) {
        entry.second = std::move(found->second);
      } else {
        missing.push_back(&entry);
      }
    }
    tbb::parallel_for(std::size_t{0}, missing.size(),
                      [&](std::size_t k) { missing[k]->second = load(missing[k]->first); });
    surfaces_ = std::move(needed);
  }

  /// Null for a tile that is not there or damaged; whoever examines the tiles says so.
  std::unique_ptr<TerrainSurface> load(const TerrainKey& key) const {
    if (!layer_.has(key)) return nullptr;
    try {
      const TerrainFile tile = read_tile(layer_, key);
      for (const auto& corners : tile.triangles) {
        for (const std::uint32_t v : corners) {
          if (v >= tile.u.size()) return nullptr;
        }
      }
      return std::make_unique<TerrainSurface>(tile, key);
    } catch (const InputError&) {
      return nullptr;
    }
  }

  std::vector<TerrainErrors> judge(const std::vector<PlacedHeight>& samples) const {
    std::vector<TerrainErrors> found(errors_.size());
    for (const PlacedHeight& sample : samples) {
      for (int zoom = 0; zoom <= layer_.finest(); ++zoom) {
        TerrainErrors& errors = found[static_cast<std::size_t>(zoom)];
        ++errors.samples;
        const auto& surface = surfaces_.at(tile_at(sample.place, zoom));
        const auto height_m = surface ? surface->height_m(sample.place) : std::nullopt;
        if (!height_m) {
          ++errors.uncovered;
          continue;
        }
        const double error_m = std::abs(*height_m - sample.height_m);
        errors.square_sum_m2 += error_m * error_m;
        const auto& stated = layer_.zooms[static_cast<std::size_t>(zoom)];
        errors.over_tolerance +=
            stated.is_held_to_dem && error_m > stated.tolerance_m + layer_.rounding_m(zoom);
        if (error_m <= errors.max_m) continue;
        errors.max_m = error_m;
        errors.worst = sample.place;
      }
    }
    return found;
  }

  void add(const std::vector<TerrainErrors>& found) {
    for (std::size_t zoom = 0; zoom < found.size(); ++zoom) {
      TerrainErrors& sum = errors_[zoom];
      const TerrainErrors& more = found[zoom];
      sum.square_sum_m2 += more.square_sum_m2;
      sum.samples += more.samples;
      sum.uncovered += more.uncovered;
      sum.over_tolerance += more.over_tolerance;
      if (more.max_m <= sum.max_m) continue;
      sum.max_m = more.max_m;
      sum.worst = more.worst;
    }
  }

  const TerrainLayer& layer_;
  const HeightSource& heights_;
  const Georeference& place_;
  const Undulation& undulation_;
  std::map<TerrainKey, std::unique_ptr<TerrainSurface>> surfaces_;
  std::vector<TerrainErrors> errors_;
};

}  // namespace

std::vector<TerrainErrors> measure_terrain(const TerrainLayer& layer, const HeightSource& heights,
                                           const Georeference& place, const Undulation& undulation,
                                           Progress& progress) {
  Measurement measurement(layer, heights, place, undulation);
  const std::int64_t rows = heights.shape().rows;
  progress.begin("comparing with the DEM", (rows + kStripRows - 1) / kStripRows);
  for (std::int64_t row = 0; row < rows; row += kStripRows) {
    measurement.add_strip(row);
    progress.advance(1);
  }
  return measurement.take();
}

}  // namespace terrane::verify
