#include "tiler/files/begin_output.h"

#include <fmt/format.h>

#include "tiler/files/whole_file.h"

namespace terrane::tiler {

namespace fs = std::filesystem;

void begin_output(const fs::path& out, const std::string& key) {
  std::error_code error;
  const fs::path key_file = out / ".work" / "key";
  if (fs::exists(key_file, error) && read_whole_file(key_file) == key) return;
  // what says that an output is whole goes first
  for (const char* ours : {"terrane.json", "tileset.json", "layer.json", "tiles.json", "tiles",
                           "content", "tilesets", "subtrees", "west", "east", ".work"}) {
    fs::remove_all(out / ours, error);
  }
  constexpr int kMostZooms = 40;
  for (int zoom = 0; zoom < kMostZooms; ++zoom) {
    fs::remove_all(out / fmt::format("{}", zoom), error);
  }
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
