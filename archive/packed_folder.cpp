#include "archive/packed_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include "archive/archive.h"
#include "core/errors.h"

namespace terrane::archive {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) { return path.filename().native().starts_with('.'); }

void check_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(fmt::format("{}: no such folder. Give the folder that 'terrane build' wrote",
                                 folder.string()));
  }
  if (fs::exists(folder / ".work", error)) {
    throw InputError(fmt::format("{}: its build is not finished. Run 'terrane build' again first",
                                 folder.string()));
  }
  const bool has_tile_set = std::ranges::any_of(
      fs::directory_iterator(folder),
      [](const fs::directory_entry& entry) { return entry.path().extension() == ".json"; });
  if (!has_tile_set) {
    throw InputError(
        fmt::format("{}: holds no tile set (no tileset.json, layer.json or the like). Run 'terrane "
                    "build' first",
                    folder.string()));
  }
}

bool is_sibling(const std::string& name, const std::set<std::string>& names) {
  return (name.ends_with(".gz") || name.ends_with(".br")) &&
         names.contains(name.substr(0, name.size() - 3));
}

}  // namespace

std::string PackedFile::read() const {
  std::ifstream stream(path, std::ios::binary);
  std::string content;
  content.reserve(bytes);
  content.assign(std::istreambuf_iterator<char>(stream), {});
  if (!stream.good() && !stream.eof()) content.clear();
  if (content.size() == bytes) return content;
  throw InputError(fmt::format(
      "{}: cannot be read, or changed while it was packed. Check the file and pack again",
      path.string()));
}

std::vector<PackedFile> list_folder(const fs::path& folder,
                                    const std::set<std::string>& leave_out) {
  check_folder(folder);
  std::vector<PackedFile> files;
  std::set<std::string> names;
  for (auto at = fs::recursive_directory_iterator(folder); at != fs::end(at); ++at) {
    if (is_hidden(at->path())) {
      if (at->is_directory()) at.disable_recursion_pending();
      continue;
    }
    if (!at->is_regular_file() || is_archive_name(at->path())) continue;
    std::string name = at->path().lexically_relative(folder).generic_string();
    if (name.ends_with(".tmp") || leave_out.contains(name) || !is_safe_name(name)) continue;
    names.insert(name);
    files.push_back({std::move(name), at->path(), at->file_size()});
  }
  std::erase_if(files, [&](const PackedFile& file) { return is_sibling(file.name, names); });
  std::ranges::sort(files, {}, &PackedFile::name);
  return files;
}

bool is_text_name(const std::string& name) {
  return std::ranges::any_of(std::array{".json", ".toml", ".txt", ".xml", ".gltf"},
                             [&](const char* extension) { return name.ends_with(extension); });
}

}  // namespace terrane::archive
