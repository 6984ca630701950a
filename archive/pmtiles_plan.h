#pragma once

#include <optional>
#include <vector>

#include "archive/packed_folder.h"
#include "archive/tile_path.h"

namespace terrane::archive {

/// A file that becomes a tile, and its place.
struct PlacedTile {
  std::uint64_t id = 0;
  const PackedFile* file = nullptr;
};

/// Which files of a folder are tiles, which stand in the metadata, which are stored beside the
/// tiles.
struct PmtilesPlan {
  std::optional<TilePath> path;
  std::vector<PlacedTile> tiles;  ///< by id
  std::vector<const PackedFile*> at_top;
  std::vector<const PackedFile*> beside;
};

/// Sorts files by what they become in a PMTiles (docs/formats.md, "What terrane pack writes").
///
/// \pre \p files outlive the plan.
/// \throws InputError about \p folder if the numbers of its tiles are no quadtree.
PmtilesPlan plan_pmtiles(const std::vector<PackedFile>& files, const std::filesystem::path& folder);

}  // namespace terrane::archive
