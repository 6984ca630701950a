#pragma once

#include <filesystem>
#include <string>

namespace terrane::cli {

/// What to take from a file of levels.
struct ExportOptions {
  std::string extract;  ///< "i" or "i:t"; empty: nothing
  int every = 0;        ///< 0: nothing
  std::string format = "glb";
};

bool is_given(const ExportOptions& options);

/// Has the file's name the extension of what `terrane levels` writes?
bool is_levels_file(const std::filesystem::path& file);

/// Writes one level or blend as the file \p out, or every k-th level into the folder \p out.
/// \throws ConfigError if the options do not say what, or something that is not there.
void export_levels(const std::filesystem::path& levels, const ExportOptions& options,
                   const std::filesystem::path& out);

}  // namespace terrane::cli
