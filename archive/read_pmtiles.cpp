#include "archive/read_pmtiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "archive/pmtiles_directory.h"
#include "archive/pmtiles_header.h"
#include "archive/tile_path.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"

namespace terrane::archive {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kLargestDirectoryBytes = std::uint64_t{1} << 28;
constexpr std::uint64_t kLargestMetadataBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostTiles = std::uint64_t{1} << 32;
constexpr int kDeepestDirectory = 4;

class Pmtiles final : public Archive {
 public:
  explicit Pmtiles(std::unique_ptr<const ArchiveFile> file)
      : file_(std::move(file)), header_(read_header(*file_)) {
    read_metadata();
    read_directory(file_->read(header_.root.offset, header_.root.length), 0);
    if (addressed_ != header_.addressed_tiles) {
      file_->fail(fmt::format("{} tiles are listed, its header says {}", addressed_,
                              header_.addressed_tiles));
    }
  }

  std::optional<Content> find(std::string_view name) const override {
    if (const auto found = texts_.find(name); found != texts_.end()) return found->second;
    if (const auto found = stored_.find(name); found != stored_.end()) return found->second;
    const auto place = path_ ? path_->place_of(name) : std::nullopt;
    if (!place) return std::nullopt;
    const DirectoryEntry* entry = entry_of(tile_id_of(*place));
    if (entry == nullptr) return std::nullopt;
    return StoredBytes{header_.tiles.offset + entry->offset, entry->length, Coding::kNone};
  }

  void for_each_name(const std::function<void(const std::string&)>& visit) const override {
    for (const auto& [name, text] : texts_) visit(name);
    for (const auto& [name, place] : stored_) visit(name);
    for (const DirectoryEntry& entry : entries_) {
      for (std::uint64_t id = entry.tile_id; id < entry.tile_id + entry.run_length; ++id) {
        const auto name = path_ ? path_->name_of(tile_at(id)) : std::nullopt;
        if (name) visit(*name);
      }
    }
  }

  ArchiveFacts facts() const override {
    std::set<std::uint64_t> offsets;
    std::uint64_t bytes = 0;
    for (const DirectoryEntry& entry : entries_) {
      if (offsets.insert(entry.offset).second) bytes += entry.length;
    }
    return {.format = "PMTiles 3",
            .files = texts_.size() + stored_.size() + addressed_,
            .contents = texts_.size() + stored_.size() + offsets.size(),
            .tile_bytes = bytes,
            .tiles = describe_tiles()};
  }

  const ArchiveFile& file() const override { return *file_; }

 private:
  std::string describe_tiles() const {
    return fmt::format("{} of {}, zooms {} to {}, {}", addressed_,
                       path_ ? path_->pattern() : "none", header_.min_zoom, header_.max_zoom,
                       header_.is_clustered ? "clustered" : "not clustered");
  }

  std::string unpacked(const std::string& bytes, std::uint64_t most_bytes) const {
    if (header_.internal_compression == PmtilesHeader::kNone) return bytes;
    auto plain = gunzip(bytes, most_bytes);
    if (!plain) file_->fail("its directory or metadata does not decompress");
    return *std::move(plain);
  }

  void read_metadata() {
    const std::string text = unpacked(file_->read(header_.metadata.offset, header_.metadata.length),
                                      kLargestMetadataBytes);
    const auto metadata = ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!metadata.is_object()) file_->fail("its metadata is no JSON object");
    const auto own = metadata.find("terrane_archive");
    if (own == metadata.end()) {
      throw InputError(fmt::format(
          "{}: a PMTiles that 'terrane pack' did not write: it does not say which files its tiles "
          "are. Use the program that wrote it",
          file_->path().string()));
    }
    try {
      read_own(*own);
    } catch (const ordered_json::exception& error) {
      file_->fail(error.what());
    }
  }

  void read_own(const ordered_json& own) {
    if (const int version = own.at("version").get<int>(); version != 1) {
      throw InputError(
          fmt::format("{}: layout {} of terrane's archives, this terrane reads 1. Use "
                      "the terrane that packed it",
                      file_->path().string(), version));
    }
    if (own.contains("tiles")) read_tile_path(own.at("tiles"));
    for (const auto& [name, content] : own.at("files").items()) {
      check_name(name);
      texts_.emplace(name, content.is_string() ? content.get<std::string>() : content.dump());
    }
    for (const auto& [name, place] : own.at("stored").items()) {
      check_name(name);
      stored_.emplace(name, place_in_tiles(place));
    }
  }

  void read_tile_path(const ordered_json& tiles) {
    const auto pattern = tiles.at("path").get<std::string>();
    path_ = TilePath::parse(pattern, tiles.at("first_zoom").get<std::int64_t>(),
                            tiles.at("zoom_step").get<std::int64_t>());
    if (!path_) file_->fail(fmt::format("'{}' is no path of tiles", pattern));
    check_name(*path_->name_of({path_->first_zoom(), 0, 0}));
  }

  void check_name(const std::string& name) const {
    if (!is_safe_name(name)) file_->fail("a file in it has an unsafe name");
  }

  StoredBytes place_in_tiles(const ordered_json& place) const {
    const auto offset = place.at("offset").get<std::uint64_t>();
    const auto length = place.at("length").get<std::uint64_t>();
    check_in_tiles(offset, length);
    const auto compression = place.at("compression").get<std::string>();
    if (compression != "gzip" && compression != "none") {
      file_->fail(fmt::format("a file is compressed as '{}'", compression));
    }
    return {header_.tiles.offset + offset, length,
            compression == "gzip" ? Coding::kGzip : Coding::kNone};
  }

  void check_in_tiles(std::uint64_t offset, std::uint64_t length) const {
    if (offset > header_.tiles.length || length > header_.tiles.length - offset) {
      file_->fail("a tile reaches past the tile data");
    }
  }

  void read_directory(const std::string& bytes, int depth) {
    if (depth > kDeepestDirectory) file_->fail("directories in directories without end");
    const auto entries = decode_directory(unpacked(bytes, kLargestDirectoryBytes), *file_);
    for (const DirectoryEntry& entry : entries) {
      // leaves may hold what lies between two entries only: so no byte is listed twice
      if (entry.tile_id < next_id_) file_->fail("its directories are unsorted");
      if (entry.run_length == 0) {
        read_leaf(entry, depth);
      } else {
        add(entry);
      }
    }
  }

  void read_leaf(const DirectoryEntry& entry, int depth) {
    const auto& leaves = header_.leaves;
    if (entry.offset > leaves.length || entry.length > leaves.length - entry.offset) {
      file_->fail("a directory reaches past its section");
    }
    read_directory(file_->read(leaves.offset + entry.offset, entry.length), depth + 1);
  }

  void add(const DirectoryEntry& entry) {
    check_in_tiles(entry.offset, entry.length);
    entries_.push_back(entry);
    next_id_ = entry.tile_id + entry.run_length;
    addressed_ += entry.run_length;
    if (addressed_ > kMostTiles) file_->fail("a wild number of tiles");
  }

  const DirectoryEntry* entry_of(std::uint64_t id) const {
    const auto after = std::ranges::upper_bound(entries_, id, {}, &DirectoryEntry::tile_id);
    if (after == entries_.begin()) return nullptr;
    const DirectoryEntry& entry = *(after - 1);
    return id - entry.tile_id < entry.run_length ? &entry : nullptr;
  }

  std::unique_ptr<const ArchiveFile> file_;
  PmtilesHeader header_;
  std::optional<TilePath> path_;
  std::map<std::string, std::string, std::less<>> texts_;
  std::map<std::string, StoredBytes, std::less<>> stored_;
  std::vector<DirectoryEntry> entries_;
  std::uint64_t next_id_ = 0;
  std::uint64_t addressed_ = 0;
};

}  // namespace

std::unique_ptr<Archive> read_pmtiles(std::unique_ptr<const ArchiveFile> file) {
  return std::make_unique<Pmtiles>(std::move(file));
}

}  // namespace terrane::archive
