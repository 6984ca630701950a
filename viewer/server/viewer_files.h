#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace terrane::viewer {

/// One file of the web viewer.
struct ViewerFile {
  std::string_view path;  ///< relative to the output folder, with '/'
  std::string_view content;
};

/// The web viewer that is part of this binary; empty if it was built without (TERRANE_WEB=OFF).
std::span<const ViewerFile> viewer_files();

/// The page that cuts volumes, likewise.
std::span<const ViewerFile> volume_page_files();

/// What the viewer loads beside viewer_files() where it shows a merge tree (`?tree=`): its page,
/// and the engine in WebAssembly, which is empty if it was built without (TERRANE_WASM=OFF).
std::span<const ViewerFile> tree_page_files();
std::span<const ViewerFile> engine_files();

/// Writes viewer_files() below a folder, which is made if it is missing. Each file gets a
/// temporary name first and is then renamed, so that none is ever half-written; a file that holds
/// the same content already is left alone.
///
/// \throws OutputError if a file cannot be written.
void write_viewer(const std::filesystem::path& out);

/// The same with volume_page_files().
/// \throws OutputError if a file cannot be written.
void write_volume_page(const std::filesystem::path& out);

}  // namespace terrane::viewer
