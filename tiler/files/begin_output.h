#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace terrane::tiler {

/// Keeps what an unfinished run with the same key left in an output folder; else removes the files
/// of any earlier output of terrane, of whatever format, and of nobody else.
/// \throws OutputError if the folder cannot be written.
void begin_output(const std::filesystem::path& out, const std::string& key);

/// The bytes of all files below a folder; 0 if there is none.
std::int64_t bytes_below(const std::filesystem::path& folder);

}  // namespace terrane::tiler
