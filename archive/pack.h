#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "archive/archive.h"
#include "core/progress.h"

namespace terrane::archive {

/// Packs a folder that terrane wrote into one file, .pmtiles or .3tz by its name.
///
/// \param leave_out  names of files that do not go in.
/// \throws ConfigError if the name is neither; InputError, OutputError.
void pack(const std::filesystem::path& folder, const std::filesystem::path& out,
          const std::set<std::string>& leave_out, Progress& progress);

/// Writes every file of an archive below a folder, which is made if it is missing.
///
/// \throws InputError if the archive is damaged; OutputError if the folder is not empty.
void unpack(const Archive& archive, const std::filesystem::path& folder, Progress& progress);

}  // namespace terrane::archive
