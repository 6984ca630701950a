#pragma once

#include <filesystem>
#include <vector>

#include "archive/packed_folder.h"
#include "core/progress.h"

namespace terrane::archive {

/// Writes files as a PMTiles, version 3.
///
/// Guarantees: clustered, equal tiles stored once, the root directory within the first 16,384
/// bytes; the same files give the same bytes. \param folder  where the files are from; its name is
/// the archive's. \throws InputError if a file cannot be read, or the tiles are no quadtree;
/// OutputError.
void write_pmtiles(const std::filesystem::path& folder, const std::vector<PackedFile>& files,
                   const std::filesystem::path& out, Progress& progress);

}  // namespace terrane::archive
