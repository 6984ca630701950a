#include "tiler/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "tiler/seam.h"
#include "tiler/whole_file.h"

namespace terrane::tiler {
namespace {

namespace fs = std::filesystem;

bool holds_nothing(const fs::path& folder) {
  return fs::directory_iterator(folder) == fs::directory_iterator();
}

bool is_complete(const nlohmann::json& tile, const fs::path& root) {
  std::error_code error;
  const auto bytes = tile.at("extras").at("terrane").at("bytes").get<std::uintmax_t>();
  const fs::path file = root / tile.at("content").at("uri").get<std::string>();
  if (fs::file_size(file, error) != bytes || error) return false;
  const auto children = tile.value("children", nlohmann::json::array());
  return std::all_of(children.begin(), children.end(),
                     [&](const nlohmann::json& child) { return is_complete(child, root); });
}

}  // namespace

fs::path OutputFolder::glb(const TileId& tile) const {
  return root_ / "tiles" / (path_of(tile) + ".glb");
}

fs::path OutputFolder::finished_tile(const TileId& tile) const {
  return work() / (path_of(tile) + ".tile");
}

fs::path OutputFolder::finished_seam(const SeamId& seam) const {
  return work() / "seams" / (path_of(seam) + ".seam");
}

void OutputFolder::forget_seams(int level) const {
  std::error_code error;
  fs::remove_all(work() / "seams" / fmt::format("{}", level), error);
}

void OutputFolder::claim(bool force) const {
  std::error_code error;
  if (fs::exists(root_, error) && !fs::is_directory(root_, error)) {
    throw OutputError(
        fmt::format("{}: is a file, not a folder. Choose another output folder", root_.string()));
  }
  fs::create_directories(root_, error);
  if (error) {
    throw OutputError(
        fmt::format("{}: the folder cannot be made ({}). Choose another output folder",
                    root_.string(), error.message()));
  }
  const bool is_ours = fs::exists(summary(), error) || fs::exists(work() / "key", error);
  if (force || is_ours || holds_nothing(root_)) return;
  throw OutputError(fmt::format(
      "{}: holds files that terrane did not write. Choose an empty folder, or add --force to write "
      "among them",
      root_.string()));
}

std::string OutputFolder::finished_key() const {
  try {
    const auto tree = nlohmann::json::parse(read_whole_file(tileset()));
    if (!is_complete(tree.at("root"), root_)) return {};
    return nlohmann::json::parse(read_whole_file(summary())).at("key").get<std::string>();
  } catch (const std::exception&) {
    return {};  // nothing there, or not whole: the same to whoever asks
  }
}

void OutputFolder::begin(const std::string& key) const {
  std::error_code error;
  const fs::path key_file = work() / "key";
  if (fs::exists(key_file, error) && read_whole_file(key_file) == key) return;
  fs::remove(summary(), error);
  fs::remove(tileset(), error);
  fs::remove_all(root_ / "tiles", error);
  fs::remove_all(work(), error);
  write_whole_file(key_file, key);
}

void OutputFolder::end() const {
  std::error_code error;
  fs::remove_all(work(), error);
}

}  // namespace terrane::tiler
