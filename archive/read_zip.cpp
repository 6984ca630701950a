#include "archive/read_zip.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "archive/little_endian.h"
#include "archive/zip_records.h"
#include "core/deflate/deflate.h"

namespace terrane::archive {
namespace {

constexpr std::uint64_t kLongestComment = 0xffff;
constexpr std::uint16_t kEncrypted = 1;

struct Entry {
  std::uint64_t header_offset = 0;  ///< of the local header
  std::uint64_t stored_bytes = 0;
  std::uint64_t plain_bytes = 0;
  std::uint32_t crc32 = 0;
  std::uint16_t method = 0;
};

/// Where the central directory lies.
struct Directory {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t entries = 0;
};

class Zip final : public Archive {
 public:
  explicit Zip(std::unique_ptr<const ArchiveFile> file) : file_(std::move(file)) {
    const Directory directory = find_directory();
    if (!file_->holds(directory.offset, directory.length)) {
      file_->fail("its directory reaches past its end");
    }
    read_entries(file_->read(directory.offset, directory.length), directory.entries);
  }

  std::optional<Content> find(std::string_view name) const override {
    const auto found = entries_.find(name);
    if (found == entries_.end()) return std::nullopt;
    return place_of(found->first, found->second);
  }

  std::optional<std::string> read(std::string_view name) const override {
    auto content = Archive::read(name);
    if (!content) return content;
    const Entry& entry = entries_.find(name)->second;
    if (content->size() != entry.plain_bytes || crc32_of(*content) != entry.crc32) {
      file_->fail(fmt::format("the checksum of {} is wrong", name));
    }
    return content;
  }

  void for_each_name(const std::function<void(const std::string&)>& visit) const override {
    for (const auto& [name, entry] : entries_) visit(name);
  }

  ArchiveFacts facts() const override {
    std::uint64_t bytes = 0;
    for (const auto& [name, entry] : entries_) bytes += entry.stored_bytes;
    return {.format = "3tz",
            .files = entries_.size(),
            .contents = entries_.size(),
            .tile_bytes = bytes};
  }

  const ArchiveFile& file() const override { return *file_; }

 private:
  Directory find_directory() const {
    const std::uint64_t tail_bytes =
        std::min<std::uint64_t>(file_->bytes(), zip::kEndBytes + kLongestComment);
    const std::uint64_t tail_offset = file_->bytes() - tail_bytes;
    const std::string tail = file_->read(tail_offset, tail_bytes);
    std::string signature;
    append_little_endian(signature, zip::kEnd);
    const std::size_t at = tail.rfind(signature);
    if (at == std::string::npos || tail.size() - at < zip::kEndBytes) {
      file_->fail("it has no end, so it is cut off or no ZIP");
    }
    const auto entries = read_little_endian<std::uint16_t>(tail, at + 10);
    const auto length = read_little_endian<std::uint32_t>(tail, at + 12);
    const auto offset = read_little_endian<std::uint32_t>(tail, at + 16);
    const bool needs_64 =
        entries == zip::kManyEntries || length == zip::kIsInExtra || offset == zip::kIsInExtra;
    if (needs_64) return find_directory_64(tail_offset + at);
    return {.offset = offset, .length = length, .entries = entries};
  }

  Directory find_directory_64(std::uint64_t end_offset) const {
    if (end_offset < zip::kEnd64LocatorBytes) file_->fail("its ZIP64 end is missing");
    const std::string locator =
        file_->read(end_offset - zip::kEnd64LocatorBytes, zip::kEnd64LocatorBytes);
    const auto offset = read_little_endian<std::uint64_t>(locator, 8);
    if (read_little_endian<std::uint32_t>(locator, 0) != zip::kEnd64Locator ||
        !file_->holds(offset, zip::kEnd64Bytes)) {
      file_->fail("its ZIP64 end is missing");
    }
    const std::string end = file_->read(offset, zip::kEnd64Bytes);
    if (read_little_endian<std::uint32_t>(end, 0) != zip::kEnd64) {
      file_->fail("its ZIP64 end is missing");
    }
    return {.offset = read_little_endian<std::uint64_t>(end, 48),
            .length = read_little_endian<std::uint64_t>(end, 40),
            .entries = read_little_endian<std::uint64_t>(end, 32)};
  }

  void read_entries(std::string_view directory, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (directory.size() < zip::kCentralHeaderBytes ||
          read_little_endian<std::uint32_t>(directory, 0) != zip::kCentralHeader) {
        file_->fail("its directory is cut off");
      }
      const std::size_t name_bytes = read_little_endian<std::uint16_t>(directory, 28);
      const std::size_t extra_bytes = read_little_endian<std::uint16_t>(directory, 30);
      const std::size_t comment_bytes = read_little_endian<std::uint16_t>(directory, 32);
      const std::size_t end = zip::kCentralHeaderBytes + name_bytes + extra_bytes + comment_bytes;
      if (directory.size() < end) file_->fail("its directory is cut off");
      add(directory, std::string(directory.substr(zip::kCentralHeaderBytes, name_bytes)),
          directory.substr(zip::kCentralHeaderBytes + name_bytes, extra_bytes));
      directory.remove_prefix(end);
    }
  }

  void add(std::string_view header, std::string name, std::string_view extra) {
    if (name.ends_with('/') || name == zip::kIndexName) return;  // a folder; the index of a 3tz
    if (!is_safe_name(name)) file_->fail("a file in it has an unsafe name");
    if ((read_little_endian<std::uint16_t>(header, 8) & kEncrypted) != 0) {
      file_->fail(name + " is encrypted");
    }
    Entry entry{.header_offset = read_little_endian<std::uint32_t>(header, 42),
                .stored_bytes = read_little_endian<std::uint32_t>(header, 20),
                .plain_bytes = read_little_endian<std::uint32_t>(header, 24),
                .crc32 = read_little_endian<std::uint32_t>(header, 16),
                .method = read_little_endian<std::uint16_t>(header, 10)};
    take_zip64(extra, name, entry);
    if (entry.method != zip::kMethodStored && entry.method != zip::kMethodDeflated) {
      file_->fail(
          fmt::format("{} is compressed by method {}, only 0 and 8 are known", name, entry.method));
    }
    if (entry.method == zip::kMethodStored && entry.stored_bytes != entry.plain_bytes) {
      file_->fail(name + " is stored in two lengths");
    }
    if (!entries_.emplace(std::move(name), entry).second) file_->fail("it lists a file twice");
  }

  /// Values that do not fit 32 bits stand in the extra field, in this order.
  void take_zip64(std::string_view extra, const std::string& name, Entry& entry) const {
    while (extra.size() >= 4) {
      const auto kind = read_little_endian<std::uint16_t>(extra, 0);
      const std::size_t length = read_little_endian<std::uint16_t>(extra, 2);
      extra.remove_prefix(4);
      if (length > extra.size()) break;
      std::string_view values = extra.substr(0, length);
      extra.remove_prefix(length);
      if (kind != zip::kExtraZip64) continue;
      for (auto* value : {&entry.plain_bytes, &entry.stored_bytes, &entry.header_offset}) {
        if (*value != zip::kIsInExtra) continue;
        if (values.size() < 8) file_->fail("the ZIP64 lengths of " + name + " are missing");
        *value = read_little_endian<std::uint64_t>(values, 0);
        values.remove_prefix(8);
      }
      return;
    }
  }

  StoredBytes place_of(const std::string& name, const Entry& entry) const {
    const std::string header = file_->read(entry.header_offset, zip::kLocalHeaderBytes);
    if (read_little_endian<std::uint32_t>(header, 0) != zip::kLocalHeader) {
      file_->fail(name + " is not where its directory says");
    }
    const std::uint64_t offset = entry.header_offset + zip::kLocalHeaderBytes +
                                 read_little_endian<std::uint16_t>(header, 26) +
                                 read_little_endian<std::uint16_t>(header, 28);
    if (!file_->holds(offset, entry.stored_bytes)) file_->fail(name + " reaches past its end");
    return {offset, entry.stored_bytes,
            entry.method == zip::kMethodStored ? Coding::kNone : Coding::kDeflate,
            entry.plain_bytes};
  }

  std::unique_ptr<const ArchiveFile> file_;
  std::map<std::string, Entry, std::less<>> entries_;
};

}  // namespace

std::unique_ptr<Archive> read_zip(std::unique_ptr<const ArchiveFile> file) {
  return std::make_unique<Zip>(std::move(file));
}

}  // namespace terrane::archive
