#include "hierarchy/levels/levels_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/errors.h"
#include "hierarchy/merge/packed_numbers.h"

namespace terrane::hierarchy {
namespace {

constexpr std::string_view kMagic = "TERRLVLS";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 64;
constexpr std::size_t kChecksumBytes = 4;
static_assert(std::endian::native == std::endian::little,
              "numbers are stored as they lie in memory");

/// The fixed part, as it lies in the file.
struct Header {
  char magic[8] = {};
  std::uint32_t version = kVersion;
  std::int32_t exponent = 0;
  double origin[3] = {};
  std::uint32_t vertices = 0, triangles = 0, levels = 0, collapses = 0;
  std::uint64_t body_bytes = 0;
};
static_assert(sizeof(Header) == kHeaderBytes);

void write_coarsest(const LevelSequence& sequence, PackedWriter& writer) {
  Eigen::Vector3i point(0, 0, 0);
  for (const Eigen::Vector3i& p : sequence.coarsest_points) {
    writer.difference(p, point);
    point = p;
  }
  std::int64_t corner = 0;
  for (const Corners& corners : sequence.coarsest_triangles) {
    for (const std::uint32_t v : corners) {
      writer.signed_number(v - corner);
      corner = v;
    }
  }
}

std::uint64_t rank_of(std::uint32_t apex, const std::vector<std::uint32_t>& link) {
  return static_cast<std::uint64_t>(std::ranges::find(link, apex) - link.begin());
}

void write_collapses(const LevelSequence& sequence, PackedWriter& writer) {
  LevelRebuilder rebuilder(sequence);
  for (auto level = sequence.levels.rbegin(); level != sequence.levels.rend(); ++level) {
    writer.number(level->size());
    std::int64_t previous = 0;
    for (const Collapse& collapse : *level) {
      writer.signed_number(collapse.corners[0] - previous);
      previous = collapse.corners[0];
      const auto link = rebuilder.link(collapse.corners[0]);
      for (const std::uint32_t apex : collapse.apexes) writer.number(rank_of(apex, link));
      for (const Eigen::Vector3i& p : collapse.before) writer.difference(p, collapse.after);
      rebuilder.split(collapse);
    }
  }
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
  return packed;
}

Header header_of(const LevelSequence& sequence, std::size_t body_bytes) {
  Header header;
  std::ranges::copy(kMagic, header.magic);
  header.exponent = sequence.lattice.exponent();
  for (int axis = 0; axis < 3; ++axis) header.origin[axis] = sequence.lattice.origin()[axis];
  header.vertices = static_cast<std::uint32_t>(sequence.coarsest_points.size());
  header.triangles = static_cast<std::uint32_t>(sequence.coarsest_triangles.size());
  header.levels = sequence.level_count();
  for (const auto& level : sequence.levels) {
    header.collapses += static_cast<std::uint32_t>(level.size());
  }
  header.body_bytes = body_bytes;
  return header;
}

/// Reads and checks everything but the collapses themselves.
Header read_header(std::string_view bytes, const std::string& file) {
  if (!bytes.starts_with(kMagic)) {
    throw InputError(
        fmt::format("{}: is no file of levels. Name one that terrane levels wrote", file));
  }
  const PackedReader reader(bytes, file);
  Header header;
  if (bytes.size() < kHeaderBytes + kChecksumBytes) reader.damaged();
  std::memcpy(&header, bytes.data(), kHeaderBytes);
  if (header.version != kVersion) {
    throw InputError(fmt::format("{}: is of version {}, and this terrane reads {}. Build it again",
                                 file, header.version, kVersion));
  }
  std::uint32_t stored = 0;
  std::memcpy(&stored, bytes.data() + bytes.size() - kChecksumBytes, kChecksumBytes);
  if (crc32_of(bytes.substr(0, bytes.size() - kChecksumBytes)) != stored) reader.damaged();
  return header;
}

std::string inflated(std::string_view packed, std::size_t size, const PackedReader& reader) {
  // deflate shrinks to a 1032nd at best: no more than that is ever to be allocated
  if (size / 1100 > packed.size()) reader.damaged();
  std::string bytes(size, '\0');
  uLongf got = size;
  const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (status != Z_OK || got != size) reader.damaged();
  return bytes;
}

void read_coarsest(const Header& header, PackedReader& reader, LevelSequence& sequence) {
  Eigen::Vector3i point(0, 0, 0);
  for (std::uint32_t i = 0; i < header.vertices; ++i) {
    point = reader.sum(point);
    sequence.coarsest_points.push_back(point);
  }
  std::uint32_t corner = 0;
  for (std::uint32_t i = 0; i < header.triangles; ++i) {
    Corners corners;
    for (std::uint32_t& v : corners) v = corner = reader.id_near(corner, header.vertices);
    sequence.coarsest_triangles.push_back(corners);
  }
}

Collapse read_collapse(const LevelRebuilder& rebuilder, std::uint32_t previous,
                       PackedReader& reader) {
  const auto next = static_cast<std::uint32_t>(rebuilder.points().size());
  const std::uint32_t centre = reader.id_near(previous, next);
  Collapse collapse{.corners = {centre, next, next + 1}, .after = rebuilder.points()[centre]};
  const auto link = rebuilder.link(centre);
  for (std::uint32_t& apex : collapse.apexes) {
    const std::uint64_t rank = reader.number();
    if (rank > link.size()) reader.damaged();
    apex = rank == link.size() ? kOutside : link[rank];
  }
  for (Eigen::Vector3i& p : collapse.before) p = reader.sum(collapse.after);
  return collapse;
}

void read_collapses(const Header& header, PackedReader& reader, LevelSequence& sequence) {
  LevelRebuilder rebuilder(sequence);
  sequence.levels.resize(header.levels);
  for (auto level = sequence.levels.rbegin(); level != sequence.levels.rend(); ++level) {
    const std::uint64_t count = reader.number();
    if (count > header.collapses) reader.damaged();
    std::uint32_t previous = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const Collapse collapse = read_collapse(rebuilder, previous, reader);
      previous = collapse.corners[0];
      rebuilder.split(collapse);
      level->push_back(collapse);
    }
  }
}

}  // namespace

std::string encode_levels(const LevelSequence& sequence) {
  PackedWriter body;
  write_coarsest(sequence, body);
  write_collapses(sequence, body);
  const Header header = header_of(sequence, body.bytes().size());
  std::string bytes(kHeaderBytes, '\0');
  std::memcpy(bytes.data(), &header, kHeaderBytes);
  bytes += deflated(body.bytes());
  const std::uint32_t sum = crc32_of(bytes);
  bytes.resize(bytes.size() + kChecksumBytes);
  std::memcpy(bytes.data() + bytes.size() - kChecksumBytes, &sum, kChecksumBytes);
  return bytes;
}

LevelSequence decode_levels(std::string_view bytes, const std::string& file) {
  const Header header = read_header(bytes, file);
  const std::string body =
      inflated(bytes.substr(kHeaderBytes, bytes.size() - kHeaderBytes - kChecksumBytes),
               header.body_bytes, PackedReader(bytes, file));
  PackedReader reader(body, file);
  LevelSequence sequence;
  sequence.lattice = {{header.origin[0], header.origin[1], header.origin[2]}, header.exponent};
  read_coarsest(header, reader, sequence);
  read_collapses(header, reader, sequence);
  if (!reader.is_at_end()) reader.damaged();
  return sequence;
}

}  // namespace terrane::hierarchy
