#include "tiler/files/begin_output.h"

#include <fmt/format.h>

#include <vector>

#include "tiler/files/whole_file.h"

namespace terrane::tiler {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> entries_but(const fs::path& kept, const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path() != kept) entries.push_back(entry.path());
  }
  return entries;
}

}  // namespace

void begin_output(const fs::path& out, const std::string& key) {
  std::error_code error;
  const fs::path work = out / ".work", key_file = work / "key";
  if (fs::exists(key_file, error) && read_whole_file(key_file) == key) return;
  // the key of no output says whose the rest is, also if this run is killed while it removes it
  write_whole_file(key_file, "");
  for (const char* ours : {"terrane.json", "tileset.json", "layer.json", "tiles.json", "tiles",
                           "content", "tilesets", "subtrees", "west", "east"}) {
    fs::remove_all(out / ours, error);
  }
  constexpr int kMostZooms = 40;
  for (int zoom = 0; zoom < kMostZooms; ++zoom) {
    fs::remove_all(out / fmt::format("{}", zoom), error);
  }
  for (const fs::path& left : entries_but(key_file, work)) fs::remove_all(left, error);
  write_whole_file(key_file, key);
}

std::int64_t bytes_below(const fs::path& folder) {
  std::error_code error;
  std::int64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) bytes += static_cast<std::int64_t>(entry.file_size(error));
  }
  return bytes;
}

}  // namespace terrane::tiler
