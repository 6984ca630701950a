#include "archive/write_three_tz.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "archive/little_endian.h"
#include "archive/new_file.h"
#include "archive/zip_records.h"
#include "core/deflate/deflate.h"

namespace terrane::archive {
namespace {

constexpr std::uint16_t kNamesAreUtf8 = 0x0800;
constexpr std::uint16_t kFirstDay = 0x0021;  // 1980-01-01
constexpr std::uint16_t kUnix = 3 << 8;
constexpr std::uint16_t kVersionZip64 = 45;
constexpr std::uint32_t kRegularFile = 0100644U << 16;

/// A file as it lies in the archive.
struct Member {
  std::string name;
  std::uint64_t header_offset = 0;
  std::uint64_t stored_bytes = 0;
  std::uint64_t plain_bytes = 0;
  std::uint32_t crc32 = 0;
  std::uint16_t method = zip::kMethodStored;
};

std::uint32_t low_or_mark(std::uint64_t value) {
  return value < zip::kIsInExtra ? static_cast<std::uint32_t>(value) : zip::kIsInExtra;
}

/// What both headers of a file share: version, flags, method, time, checksum, sizes, name's length.
void append_shared(std::string& bytes, const Member& member, std::size_t extra_bytes) {
  append_little_endian(bytes, kVersionZip64);
  append_little_endian(bytes, kNamesAreUtf8);
  append_little_endian(bytes, member.method);
  append_little_endian(bytes, std::uint16_t{0});
  append_little_endian(bytes, kFirstDay);
  append_little_endian(bytes, member.crc32);
  append_little_endian(bytes, low_or_mark(member.stored_bytes));
  append_little_endian(bytes, low_or_mark(member.plain_bytes));
  append_little_endian(bytes, static_cast<std::uint16_t>(member.name.size()));
  append_little_endian(bytes, static_cast<std::uint16_t>(extra_bytes));
}

/// The values that do not fit 32 bits, as an extra field; a local header needs both sizes or none.
std::string extra_of(const Member& member, bool is_local) {
  std::string values;
  const bool is_large = std::max(member.plain_bytes, member.stored_bytes) >= zip::kIsInExtra;
  if (member.plain_bytes >= zip::kIsInExtra || (is_local && is_large)) {
    append_little_endian(values, member.plain_bytes);
  }
  if (member.stored_bytes >= zip::kIsInExtra || (is_local && is_large)) {
    append_little_endian(values, member.stored_bytes);
  }
  if (!is_local && member.header_offset >= zip::kIsInExtra) {
    append_little_endian(values, member.header_offset);
  }
  if (values.empty()) return {};
  std::string extra;
  append_little_endian(extra, zip::kExtraZip64);
  append_little_endian(extra, static_cast<std::uint16_t>(values.size()));
  return extra + values;
}

void append_local_header(std::string& bytes, const Member& member) {
  const std::string extra = extra_of(member, /*is_local=*/true);
  append_little_endian(bytes, zip::kLocalHeader);
  append_shared(bytes, member, extra.size());
  bytes += member.name + extra;
}

void append_central_header(std::string& bytes, const Member& member) {
  const std::string extra = extra_of(member, /*is_local=*/false);
  append_little_endian(bytes, zip::kCentralHeader);
  append_little_endian(bytes, static_cast<std::uint16_t>(kUnix | kVersionZip64));
  append_shared(bytes, member, extra.size());
  append_little_endian(bytes, std::uint16_t{0});  // comment
  append_little_endian(bytes, std::uint16_t{0});  // disk
  append_little_endian(bytes, std::uint16_t{0});  // internal attributes
  append_little_endian(bytes, kRegularFile);
  append_little_endian(bytes, low_or_mark(member.header_offset));
  bytes += member.name + extra;
}

void write_member(NewFile& file, std::string name, std::string content, bool may_deflate,
                  std::vector<Member>& members) {
  Member member{.name = std::move(name),
                .header_offset = file.position(),
                .plain_bytes = content.size(),
                .crc32 = crc32_of(content)};
  if (may_deflate) {
    std::string smaller = deflate_raw(content);
    if (smaller.size() < content.size()) {
      content = std::move(smaller);
      member.method = zip::kMethodDeflated;
    }
  }
  member.stored_bytes = content.size();
  std::string header;
  append_local_header(header, member);
  file.write(header);
  file.write(content);
  members.push_back(std::move(member));
}

using Md5 = std::array<unsigned char, 16>;

Md5 md5_of(const std::string& text) {
  Md5 digest;
  unsigned int length = 0;
  EVP_Digest(text.data(), text.size(), digest.data(), &length, EVP_md5(), nullptr);
  return digest;
}

std::string index_of(const std::vector<Member>& members) {
  struct Line {
    std::uint64_t low, high;
    Md5 md5;
    std::uint64_t offset;
  };
  std::vector<Line> lines;
  for (const Member& member : members) {
    const Md5 md5 = md5_of(member.name);
    const std::string_view bytes(reinterpret_cast<const char*>(md5.data()), md5.size());
    lines.push_back({read_little_endian<std::uint64_t>(bytes, 0),
                     read_little_endian<std::uint64_t>(bytes, 8), md5, member.header_offset});
  }
  std::ranges::sort(lines, {}, [](const Line& line) { return std::tuple(line.low, line.high); });
  std::string index;
  for (const Line& line : lines) {
    index.append(reinterpret_cast<const char*>(line.md5.data()), line.md5.size());
    append_little_endian(index, line.offset);
  }
  return index;
}

void write_directory(NewFile& file, const std::vector<Member>& members) {
  const std::uint64_t offset = file.position();
  std::string directory;
  for (const Member& member : members) append_central_header(directory, member);
  file.write(directory);

  const std::uint64_t end_offset = file.position();
  const bool needs_64 = members.size() >= zip::kManyEntries || end_offset >= zip::kIsInExtra;
  std::string end;
  if (needs_64) {
    append_little_endian(end, zip::kEnd64);
    append_little_endian(end, std::uint64_t{zip::kEnd64Bytes - 12});
    append_little_endian(end, static_cast<std::uint16_t>(kUnix | kVersionZip64));
    append_little_endian(end, kVersionZip64);
    append_little_endian(end, std::uint64_t{0});  // this disk, disk of the directory
    append_little_endian(end, std::uint64_t{members.size()});
    append_little_endian(end, std::uint64_t{members.size()});
    append_little_endian(end, std::uint64_t{directory.size()});
    append_little_endian(end, offset);
    append_little_endian(end, zip::kEnd64Locator);
    append_little_endian(end, std::uint32_t{0});
    append_little_endian(end, end_offset);
    append_little_endian(end, std::uint32_t{1});
  }
  const auto count =
      static_cast<std::uint16_t>(std::min<std::size_t>(members.size(), zip::kManyEntries));
  append_little_endian(end, zip::kEnd);
  append_little_endian(end, std::uint32_t{0});  // this disk, disk of the directory
  append_little_endian(end, count);
  append_little_endian(end, count);
  append_little_endian(end, low_or_mark(directory.size()));
  append_little_endian(end, low_or_mark(offset));
  append_little_endian(end, std::uint16_t{0});  // comment
  file.write(end);
}

}  // namespace

void write_three_tz(const std::vector<PackedFile>& files, const std::filesystem::path& out,
                    Progress& progress) {
  progress.begin("packing", static_cast<std::int64_t>(files.size()));
  NewFile file(out);
  std::vector<Member> members;
  for (const PackedFile& packed : files) {
    write_member(file, packed.name, packed.read(), is_text_name(packed.name), members);
    progress.advance(1);
  }
  write_member(file, std::string(zip::kIndexName), index_of(members), /*may_deflate=*/false,
               members);
  write_directory(file, members);
  file.finish();
}

}  // namespace terrane::archive
