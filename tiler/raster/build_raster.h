#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "core/height_statistics.h"
#include "core/mercator_grid.h"
#include "core/progress.h"
#include "tiler/build.h"
#include "tiler/raster/height_colours.h"

namespace terrane::tiler {

struct RasterOptions {
  HeightEncoding encoding = HeightEncoding::kTerrarium;
  double fill_m = 0;      ///< what stands for no data
  std::string extension;  ///< of the tiles: "png" or "webp"
  /// A square picture of red, green and blue as a file, without loss; the same bytes each time.
  std::function<std::string(std::span<const std::uint8_t> rgb, int side_px)> encode;
  std::array<double, 4> bounds_deg = {};  ///< west, south, east, north of the data
  std::string source;       ///< how the heights were made, for the key and terrane.json
  std::string name;         ///< of the data set, shown by clients
  std::string attribution;  ///< may be empty
};

/// What the data set is built from, as text; two with the same key are the same.
std::string raster_key(const HeightStatistics& statistics, const RasterOptions& options);

/// True if a finished data set of this key lies there, no tile of it missing.
bool is_finished_raster(const std::filesystem::path& out, const std::string& key);

/// Writes heights as a pyramid of pictures, {z}/{x}/{y}.EXT from zoom 0 on, with tiles.json
/// (TileJSON) and terrane.json, which comes last.
///
/// A tile of a coarser zoom is the mean of 2 x 2 pixels of the finer one, of those with data. One
/// that was killed goes on: tiles that are there are not encoded again.
///
/// \pre \p out was claimed.
/// \throws ConfigError if the DEM has heights that the encoding does not; OutputError if a file
///         cannot be written.
BuildResult build_raster(const MercatorHeights& heights, const HeightStatistics& statistics,
                         const RasterOptions& options, const std::filesystem::path& out,
                         Progress& progress);

/// \throws ConfigError that names the encoding, if heights or the fill are outside its range.
void check_range(const HeightStatistics& statistics, const RasterOptions& options);

}  // namespace terrane::tiler
