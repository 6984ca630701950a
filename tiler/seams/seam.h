#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/mesh/border_place.h"
#include "tiler/pyramid.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// The border between two tiles of a level: between columns, or between rows.
struct SeamId {
  TileId first;            ///< the tile to the left, or above
  bool is_column = false;  ///< a column of samples, with the second tile to the right

  auto operator<=>(const SeamId&) const = default;

  TileId second() const {
    return {first.level, first.x + (is_column ? 1 : 0), first.y + (is_column ? 0 : 1)};
  }
};

/// "level/x/y/right" or "level/x/y/below", the place of a seam in folders.
std::string path_of(const SeamId& seam);

/// All seams of a level, row by row.
std::vector<SeamId> seams(const Pyramid& pyramid, int level);

/// The seams of a tile: up to four.
std::vector<SeamId> seams_of(const Pyramid& pyramid, const TileId& tile);

/// The samples of a seam, both ends included: one column or one row.
Window samples_of(const Pyramid& pyramid, const SeamId& seam);

/// The samples of both tiles.
Window both_sides(const Pyramid& pyramid, const SeamId& seam);

/// What became of a vertex on a border.
struct SeamVertex {
  hierarchy::BorderPlace from;  ///< where it was at the finer level
  hierarchy::BorderPlace onto;  ///< where the vertex was that it became; the same if it stays
  hierarchy::BorderPlace at;    ///< where that vertex is now
  /// Height at which it is written there, over the ellipsoid; NaN: that of its sample.
  double height_m = std::numeric_limits<double>::quiet_NaN();
};

/// What became of a seam at its level, in order along it. Both tiles do the same.
using SeamChain = std::vector<SeamVertex>;

/// \throws OutputError if the file cannot be written.
void write_finished_seam(const SeamChain& chain, const std::filesystem::path& file);

/// \throws InputError if the file is not there or cut short.
SeamChain read_finished_seam(const std::filesystem::path& file);

}  // namespace terrane::tiler
