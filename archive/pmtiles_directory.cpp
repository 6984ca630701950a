#include "archive/pmtiles_directory.h"

#include <limits>

#include "archive/pmtiles_tile_id.h"

namespace terrane::archive {
namespace {

constexpr std::uint64_t kLargestOffset = std::uint64_t{1} << 62;

void append_varint(std::string& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>(value | 0x80));
  bytes.push_back(static_cast<char>(value));
}

/// Numbers of seven bits a byte, the lowest first.
class Varints {
 public:
  Varints(std::string_view bytes, const ArchiveFile& file) : bytes_(bytes), file_(file) {}

  std::uint64_t next() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (at_ == bytes_.size()) file_.fail("a directory is cut off");
      const auto byte = static_cast<unsigned char>(bytes_[at_++]);
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if (byte < 0x80) return value;
    }
    file_.fail("a number in a directory is too long");
  }

  std::uint32_t next_32() {
    const std::uint64_t value = next();
    if (value > std::numeric_limits<std::uint32_t>::max()) {
      file_.fail("a number in a directory is too large");
    }
    return static_cast<std::uint32_t>(value);
  }

  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  const ArchiveFile& file_;
  std::size_t at_ = 0;
};

void read_ids(Varints& numbers, std::vector<DirectoryEntry>& entries, const ArchiveFile& file) {
  const std::uint64_t end = first_id_of_zoom(kLargestZoom + 1);
  std::uint64_t id = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint64_t step = numbers.next();
    if (step >= end - id || (i > 0 && step == 0))
      file.fail("the tiles of a directory are unsorted");
    id += step;
    entries[i].tile_id = id;
  }
}

void read_offsets(Varints& numbers, std::vector<DirectoryEntry>& entries, const ArchiveFile& file) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint64_t code = numbers.next();
    if (code > kLargestOffset || (code == 0 && i == 0)) file.fail("a directory has a wild offset");
    entries[i].offset = code == 0 ? entries[i - 1].offset + entries[i - 1].length : code - 1;
    if (entries[i].offset > kLargestOffset) file.fail("a directory has a wild offset");
  }
}

void check_runs(const std::vector<DirectoryEntry>& entries, const ArchiveFile& file) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].length == 0) file.fail("a directory lists an empty tile");
    const std::uint64_t end =
        i + 1 < entries.size() ? entries[i + 1].tile_id : first_id_of_zoom(kLargestZoom + 1);
    if (entries[i].run_length > end - entries[i].tile_id) file.fail("runs of tiles overlap");
  }
}

}  // namespace

std::string encode_directory(std::span<const DirectoryEntry> entries) {
  std::string bytes;
  append_varint(bytes, entries.size());
  std::uint64_t last_id = 0;
  for (const DirectoryEntry& entry : entries) {
    append_varint(bytes, entry.tile_id - last_id);
    last_id = entry.tile_id;
  }
  for (const DirectoryEntry& entry : entries) append_varint(bytes, entry.run_length);
  for (const DirectoryEntry& entry : entries) append_varint(bytes, entry.length);
  const DirectoryEntry* before = nullptr;
  for (const DirectoryEntry& entry : entries) {
    const bool follows = before != nullptr && entry.offset == before->offset + before->length;
    append_varint(bytes, follows ? 0 : entry.offset + 1);
    before = &entry;
  }
  return bytes;
}

std::vector<DirectoryEntry> decode_directory(std::string_view bytes, const ArchiveFile& file) {
  Varints numbers(bytes, file);
  const std::uint64_t count = numbers.next();
  // four numbers each: a damaged count must not eat memory
  if (count == 0 || count > bytes.size() / 4) file.fail("a directory has a wild number of entries");
  std::vector<DirectoryEntry> entries(count);
  read_ids(numbers, entries, file);
  for (DirectoryEntry& entry : entries) entry.run_length = numbers.next_32();
  for (DirectoryEntry& entry : entries) entry.length = numbers.next_32();
  read_offsets(numbers, entries, file);
  if (!numbers.is_at_end()) file.fail("a directory has bytes left over");
  check_runs(entries, file);
  return entries;
}

}  // namespace terrane::archive
