#pragma once

#include <memory>

#include "archive/archive.h"

namespace terrane::archive {

/// Opens a PMTiles that terrane packed. All directories are read at once: 24 bytes a tile.
///
/// \throws InputError if it is damaged, or its metadata has no "terrane_archive".
std::unique_ptr<Archive> read_pmtiles(std::unique_ptr<const ArchiveFile> file);

}  // namespace terrane::archive
