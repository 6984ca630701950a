#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace terrane::tiler {

/// Writes a file so that it is there whole or not at all: under a temporary name, then renamed.
/// Folders are made as needed.
/// \throws OutputError that names the file and the system's reason; the temporary file is removed.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

/// \throws InputError if the file cannot be read.
std::string read_whole_file(const std::filesystem::path& file);

}  // namespace terrane::tiler
