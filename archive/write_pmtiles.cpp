#include "archive/write_pmtiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "archive/geographic_bounds.h"
#include "archive/new_file.h"
#include "archive/pmtiles_directory.h"
#include "archive/pmtiles_header.h"
#include "archive/pmtiles_plan.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"

namespace terrane::archive {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kFirstLeafEntries = 4096;

/// FNV-1a; equal hashes are compared byte by byte.
std::uint64_t hash_of(std::string_view content) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : content) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

/// The contents in the order in which they are written, equal ones once.
class TileData {
 public:
  /// \return its offset.
  std::uint64_t add(const PackedFile& file, const std::string& content) {
    are_all_gzipped_ = are_all_gzipped_ && looks_gzipped(content);
    auto& alike = by_hash_[hash_of(content)];
    for (const auto& [other, offset] : alike) {
      if (other->bytes == file.bytes && other->read() == content) return offset;
    }
    alike.emplace_back(&file, bytes_);
    files_.push_back(&file);
    bytes_ += content.size();
    return alike.back().second;
  }

  const std::vector<const PackedFile*>& files() const { return files_; }
  std::uint64_t bytes() const { return bytes_; }
  bool are_all_gzipped() const { return are_all_gzipped_ && !files_.empty(); }

 private:
  std::map<std::uint64_t, std::vector<std::pair<const PackedFile*, std::uint64_t>>> by_hash_;
  std::vector<const PackedFile*> files_;
  std::uint64_t bytes_ = 0;
  bool are_all_gzipped_ = true;
};

std::vector<DirectoryEntry> lay_out(const PmtilesPlan& plan, TileData& data, Progress& progress) {
  std::vector<DirectoryEntry> entries;
  for (const PlacedTile& tile : plan.tiles) {
    if (tile.file->bytes > 0xffffffff) {
      throw InputError(fmt::format("{}: larger than 4 GiB, too large for a PMTiles. Pack as .3tz",
                                   tile.file->path.string()));
    }
    const std::uint64_t offset = data.add(*tile.file, tile.file->read());
    const bool prolongs = !entries.empty() && entries.back().offset == offset &&
                          entries.back().tile_id + entries.back().run_length == tile.id;
    if (prolongs) {
      ++entries.back().run_length;
    } else {
      entries.push_back({tile.id, offset, static_cast<std::uint32_t>(tile.file->bytes), 1});
    }
    progress.advance(1);
  }
  return entries;
}

struct Directories {
  std::string root;
  std::string leaves;
};

/// Leaves grow until their list fits into the first request.
Directories encode_directories(const std::vector<DirectoryEntry>& entries) {
  constexpr std::size_t kMostRootBytes = PmtilesHeader::kFirstRequestBytes - PmtilesHeader::kBytes;
  Directories directories{.root = gzip(encode_directory(entries)), .leaves = {}};
  for (std::size_t leaf_entries = kFirstLeafEntries; directories.root.size() > kMostRootBytes;
       leaf_entries *= 2) {
    std::vector<DirectoryEntry> root;
    directories.leaves.clear();
    for (std::size_t begin = 0; begin < entries.size(); begin += leaf_entries) {
      const std::size_t count = std::min(leaf_entries, entries.size() - begin);
      const std::string leaf = gzip(encode_directory(std::span(entries).subspan(begin, count)));
      root.push_back({entries[begin].tile_id, directories.leaves.size(),
                      static_cast<std::uint32_t>(leaf.size()), 0});
      directories.leaves += leaf;
    }
    directories.root = gzip(encode_directory(root));
  }
  return directories;
}

struct Coded {
  std::string bytes;
  bool is_gzipped = false;
};

Coded coded(std::string content) {
  if (looks_gzipped(content)) return {std::move(content), false};
  std::string smaller = gzip(content);
  if (smaller.size() < content.size()) return {std::move(smaller), true};
  return {std::move(content), false};
}

ordered_json content_of(const PackedFile& file) {
  std::string text = file.read();
  if (file.name.ends_with(".json")) {
    auto json = ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!json.is_discarded() && !json.is_string()) return json;
    throw InputError(fmt::format("{}: is no JSON. Build the folder again", file.path.string()));
  }
  return text;
}

/// \param at_end  where the files beside the tiles begin, from the start of the tile data.
ordered_json describe(const PmtilesPlan& plan, const std::filesystem::path& folder,
                      std::uint64_t at_end) {
  ordered_json own{{"version", 1}};
  if (plan.path) {
    own["tiles"] = {{"path", plan.path->pattern()},
                    {"first_zoom", plan.path->first_zoom()},
                    {"zoom_step", plan.path->zoom_step()}};
  }
  own["files"] = ordered_json::object();
  for (const PackedFile* file : plan.at_top) own["files"][file->name] = content_of(*file);
  own["stored"] = ordered_json::object();
  for (const PackedFile* file : plan.beside) {
    const Coded content = coded(file->read());
    own["stored"][file->name] = {{"offset", at_end},
                                 {"length", content.bytes.size()},
                                 {"compression", content.is_gzipped ? "gzip" : "none"}};
    at_end += content.bytes.size();
  }
  const auto absolute = std::filesystem::absolute(folder / ".").lexically_normal().parent_path();
  return {{"name", absolute.filename().string()},
          {"generator", TERRANE_GENERATOR},
          {"terrane_archive", std::move(own)}};
}

std::uint8_t tile_type_of(const PmtilesPlan& plan) {
  const std::string pattern = plan.path ? plan.path->pattern() : "";
  if (pattern.ends_with(".png")) return 2;
  if (pattern.ends_with(".jpg") || pattern.ends_with(".jpeg")) return 3;
  if (pattern.ends_with(".webp")) return 4;
  return 0;
}

void place_on_earth(const GeographicBounds& bounds, PmtilesHeader& header) {
  const auto e7 = [](double degrees) { return static_cast<std::int32_t>(degrees * 1e7); };
  header.west_e7 = e7(bounds.west_deg);
  header.south_e7 = e7(bounds.south_deg);
  header.east_e7 = e7(bounds.east_deg);
  header.north_e7 = e7(bounds.north_deg);
  header.centre_longitude_e7 = e7((bounds.west_deg + bounds.east_deg) / 2);
  header.centre_latitude_e7 = e7((bounds.south_deg + bounds.north_deg) / 2);
}

PmtilesHeader header_of(const PmtilesPlan& plan, const std::vector<DirectoryEntry>& entries,
                        const TileData& data) {
  PmtilesHeader header;
  header.addressed_tiles = plan.tiles.size();
  header.tile_entries = entries.size();
  header.tile_contents = data.files().size();
  header.is_clustered = true;
  header.tile_compression = data.are_all_gzipped() ? PmtilesHeader::kGzip : PmtilesHeader::kNone;
  header.tile_type = tile_type_of(plan);
  if (plan.tiles.empty()) return header;
  header.min_zoom = static_cast<std::uint8_t>(tile_at(plan.tiles.front().id).zoom);
  header.max_zoom = static_cast<std::uint8_t>(tile_at(plan.tiles.back().id).zoom);
  header.centre_zoom = header.min_zoom;
  return header;
}

}  // namespace

void write_pmtiles(const std::filesystem::path& folder, const std::vector<PackedFile>& files,
                   const std::filesystem::path& out, Progress& progress) {
  const PmtilesPlan plan = plan_pmtiles(files, folder);
  if (plan.tiles.empty()) {
    throw InputError(fmt::format("{}: has no tiles named .../level/x/y.extension. Pack it as .3tz",
                                 folder.string()));
  }
  progress.begin("packing", static_cast<std::int64_t>(2 * plan.tiles.size()));
  TileData data;
  const std::vector<DirectoryEntry> entries = lay_out(plan, data, progress);
  const Directories directories = encode_directories(entries);
  const ordered_json description = describe(plan, folder, data.bytes());
  const std::string metadata = gzip(description.dump());

  PmtilesHeader header = header_of(plan, entries, data);
  place_on_earth(bounds_of(description["terrane_archive"]["files"].dump()), header);
  header.root = {PmtilesHeader::kBytes, directories.root.size()};
  header.metadata = {header.root.offset + header.root.length, metadata.size()};
  header.leaves = {header.metadata.offset + header.metadata.length, directories.leaves.size()};
  header.tiles = {header.leaves.offset + header.leaves.length, data.bytes()};
  for (const auto& [name, place] : description["terrane_archive"]["stored"].items()) {
    header.tiles.length += place["length"].get<std::uint64_t>();
  }

  NewFile file(out);
  file.write(encode_header(header));
  file.write(directories.root);
  file.write(metadata);
  file.write(directories.leaves);
  for (const PackedFile* tile : data.files()) {
    file.write(tile->read());
    progress.advance(1);
  }
  for (const PackedFile* beside : plan.beside) file.write(coded(beside->read()).bytes);
  file.finish();
}

}  // namespace terrane::archive
