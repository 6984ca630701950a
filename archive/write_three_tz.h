#pragma once

#include <filesystem>
#include <vector>

#include "archive/packed_folder.h"
#include "core/progress.h"

namespace terrane::archive {

/// Writes files as a 3tz: a ZIP with an index.
///
/// Guarantees: the same files give the same bytes (no time stamps); ZIP64 where sizes need it.
/// \pre \p files are sorted by name.
/// \throws InputError if a file cannot be read; OutputError.
/// \par Source
/// 3D Tiles Archive Format 1.3; PKWARE APPNOTE 6.3.10.
void write_three_tz(const std::vector<PackedFile>& files, const std::filesystem::path& out,
                    Progress& progress);

}  // namespace terrane::archive
