#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace terrane::archive {

/// A file of a folder that goes into an archive.
struct PackedFile {
  std::string name;  ///< relative to the folder, with '/'
  std::filesystem::path path;
  std::uint64_t bytes = 0;

  /// \throws InputError if it cannot be read, or has not the length that it had when it was listed.
  std::string read() const;
};

/// The files to pack, sorted by name: all but hidden ones, those in \p leave_out, other archives,
/// and `x.gz`, `x.br` beside an `x`.
///
/// \throws InputError if the folder is not there, holds no tile set, or a build there is
/// unfinished.
std::vector<PackedFile> list_folder(const std::filesystem::path& folder,
                                    const std::set<std::string>& leave_out);

/// True for .json, .toml, .txt, .xml, .gltf: what is text and shrinks.
bool is_text_name(const std::string& name);

}  // namespace terrane::archive
