#include "tiler/files/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "tiler/files/begin_output.h"
#include "tiler/files/whole_file.h"
#include "tiler/seams/seam.h"

namespace terrane::tiler {
namespace {

namespace fs = std::filesystem;

bool holds_at_most(std::string_view name, const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename() != name) return false;
  }
  return true;
}

/// No more than a run leaves that was killed before it had written its key?
bool holds_nothing(const fs::path& folder) {
  return holds_at_most(".work", folder) && holds_at_most("key.tmp", folder / ".work");
}

/// Files of some kind below a folder of an output.
struct Found {
  std::uintmax_t files = 0, bytes = 0;

  void count(const fs::path& below, std::string_view extension) {
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(below, error)) {
      if (!entry.is_regular_file(error) || entry.path().extension() != extension) continue;
      ++files;
      bytes += entry.file_size(error);
    }
  }
};

/// \param summary  terrane.json
bool is_complete(const nlohmann::json& summary, const fs::path& root) {
  Found stated, tiles;
  for (const auto& level : summary.at("levels")) {
    stated.files += level.at("tiles").get<std::uintmax_t>();
    stated.bytes += level.at("bytes").get<std::uintmax_t>();
  }
  tiles.count(root / "tiles", ".glb");
  tiles.count(root / "content", ".glb");
  Found tilesets{1, fs::file_size(root / "tileset.json")};
  tilesets.count(root / "tilesets", ".json");
  tilesets.count(root / "subtrees", ".subtree");
  return tiles.files == stated.files && tiles.bytes == stated.bytes &&
         tilesets.files == summary.at("tilesets").at("files") &&
         tilesets.bytes == summary.at("tilesets").at("bytes");
}

}  // namespace

fs::path OutputFolder::finished_tile(const TileId& tile) const {
  return work() / (path_of(tile) + ".tile");
}

fs::path OutputFolder::finished_seam(const SeamId& seam) const {
  // all seams of a column of tiles in one folder: folders cost more than files
  std::string name = path_of(seam) + ".seam";
  name[name.rfind('/')] = '-';
  return work() / "seams" / name;
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
    const auto json = nlohmann::json::parse(read_whole_file(summary()));
    return is_complete(json, root_) ? json.at("key").get<std::string>() : std::string();
  } catch (const std::exception&) {
    return {};  // nothing there, or not whole: the same to whoever asks
  }
}

void OutputFolder::begin(const std::string& key) const { begin_output(root_, key); }

void OutputFolder::end() const {
  std::error_code error;
  fs::remove_all(work(), error);
}

}  // namespace terrane::tiler
