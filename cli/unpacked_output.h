#pragma once

#include <filesystem>
#include <functional>

#include "core/progress.h"

namespace terrane::cli {

/// Calls \p use with an output folder: with \p out itself, or, where that is an archive, with a
/// temporary folder that holds what is in it. Errors name the archive.
///
/// \throws InputError if the archive is damaged; OutputError if there is no space to unpack it.
void with_output_folder(const std::filesystem::path& out, Progress& progress,
                        const std::function<void(const std::filesystem::path&)>& use);

}  // namespace terrane::cli
