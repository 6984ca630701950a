#include "archive/pmtiles_header.h"

#include <fmt/format.h>

#include "archive/little_endian.h"

namespace terrane::archive {
namespace {

constexpr std::string_view kMagic = "PMTiles";
constexpr std::uint8_t kVersion = 3;

/// Reads one field after the other.
class Fields {
 public:
  Fields(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  template <class T>
  void take(T& field) {
    field = read_little_endian<T>(bytes_, at_);
    at_ += sizeof(T);
  }
  void take(PmtilesHeader::Section& section) {
    take(section.offset);
    take(section.length);
  }

 private:
  std::string_view bytes_;
  std::size_t at_;
};

void append(std::string& bytes, const PmtilesHeader::Section& section) {
  append_little_endian(bytes, section.offset);
  append_little_endian(bytes, section.length);
}

PmtilesHeader decode(std::string_view bytes) {
  PmtilesHeader header;
  Fields fields(bytes, kMagic.size() + 1);
  for (auto* section : {&header.root, &header.metadata, &header.leaves, &header.tiles}) {
    fields.take(*section);
  }
  fields.take(header.addressed_tiles);
  fields.take(header.tile_entries);
  fields.take(header.tile_contents);
  std::uint8_t clustered = 0;
  fields.take(clustered);
  header.is_clustered = clustered == 1;
  for (auto* byte : {&header.internal_compression, &header.tile_compression, &header.tile_type,
                     &header.min_zoom, &header.max_zoom}) {
    fields.take(*byte);
  }
  for (auto* bound : {&header.west_e7, &header.south_e7, &header.east_e7, &header.north_e7}) {
    fields.take(*bound);
  }
  fields.take(header.centre_zoom);
  fields.take(header.centre_longitude_e7);
  fields.take(header.centre_latitude_e7);
  return header;
}

}  // namespace

std::string encode_header(const PmtilesHeader& header) {
  std::string bytes(kMagic);
  append_little_endian(bytes, kVersion);
  for (const auto* section : {&header.root, &header.metadata, &header.leaves, &header.tiles}) {
    append(bytes, *section);
  }
  append_little_endian(bytes, header.addressed_tiles);
  append_little_endian(bytes, header.tile_entries);
  append_little_endian(bytes, header.tile_contents);
  append_little_endian(bytes, std::uint8_t{header.is_clustered});
  for (const std::uint8_t byte : {header.internal_compression, header.tile_compression,
                                  header.tile_type, header.min_zoom, header.max_zoom}) {
    append_little_endian(bytes, byte);
  }
  for (const std::int32_t bound :
       {header.west_e7, header.south_e7, header.east_e7, header.north_e7}) {
    append_little_endian(bytes, bound);
  }
  append_little_endian(bytes, header.centre_zoom);
  append_little_endian(bytes, header.centre_longitude_e7);
  append_little_endian(bytes, header.centre_latitude_e7);
  return bytes;
}

PmtilesHeader read_header(const ArchiveFile& file) {
  if (file.bytes() < PmtilesHeader::kBytes) file.fail("shorter than the header of a PMTiles");
  const std::string bytes = file.read(0, PmtilesHeader::kBytes);
  if (!bytes.starts_with(kMagic)) file.fail("no PMTiles header");
  const auto version = read_little_endian<std::uint8_t>(bytes, kMagic.size());
  if (version != kVersion) file.fail(fmt::format("PMTiles version {}, not 3", version));
  const PmtilesHeader header = decode(bytes);
  for (const auto* section : {&header.root, &header.metadata, &header.leaves, &header.tiles}) {
    if (!file.holds(section->offset, section->length)) {
      file.fail(fmt::format("a section of {} bytes at {} reaches past its end", section->length,
                            section->offset));
    }
  }
  if (header.internal_compression != PmtilesHeader::kGzip &&
      header.internal_compression != PmtilesHeader::kNone) {
    file.fail(fmt::format("internal compression {}, only none and gzip are known",
                          header.internal_compression));
  }
  return header;
}

}  // namespace terrane::archive
