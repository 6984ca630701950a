#include "hierarchy/merge/tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>

#include "core/errors.h"
#include "hierarchy/levels/level_sequence.h"
#include "hierarchy/merge/grow_tree.h"
#include "hierarchy/merge/normal_code.h"
#include "hierarchy/merge/packed_numbers.h"

namespace terrane::hierarchy {
namespace {

constexpr std::string_view kMagic = "TERRTREE";
constexpr std::uint32_t kVersion = 2, kOldestVersion = 1;  // 1: without colours
constexpr std::size_t kHeaderBytes = 64, kChecksumBytes = 4, kBlockHeaderBytes = 8;
constexpr std::uint32_t kMergesPerBlock = 4096;
constexpr float kLargestAngle = 4;  // pi, and what rounding up may add

/// The header without its checksum.
struct Header {
  std::int32_t exponent = 0;
  std::array<double, 3> origin{};
  ErrorMeasure measure = ErrorMeasure::kDistance;
  Region region = Region::kRemovedEnd;
  bool has_colours = false;
  std::uint32_t points = 0, triangles = 0, merges = 0, coarsest_bytes = 0;
};

std::string encoded(const Header& header) {
  PackedWriter writer;
  writer.fixed32(kVersion);
  writer.fixed32(std::bit_cast<std::uint32_t>(header.exponent));
  for (const double value : header.origin) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    writer.fixed32(static_cast<std::uint32_t>(bits));
    writer.fixed32(static_cast<std::uint32_t>(bits >> 32));
  }
  writer.fixed16(static_cast<std::uint32_t>(header.measure) |
                 static_cast<std::uint32_t>(header.region) << 8);
  writer.fixed16(header.has_colours);
  for (const auto n : {header.points, header.triangles, header.merges, header.coarsest_bytes}) {
    writer.fixed32(n);
  }
  return std::string(kMagic) + writer.bytes();
}

void append_checksum(std::string& bytes, std::size_t from) {
  PackedWriter writer;
  writer.fixed32(crc32_of(std::string_view(bytes).substr(from)));
  bytes += writer.bytes();
}

std::uint32_t upper_half(float value) { return std::bit_cast<std::uint32_t>(value) >> 16; }

std::span<float MergeBounds::*const> bound_members(bool with_colours) {
  static constexpr std::array<float MergeBounds::*, 10> kMembers{
      &MergeBounds::error,        &MergeBounds::all_error, &MergeBounds::switched,
      &MergeBounds::all_switched, &MergeBounds::radius,    &MergeBounds::all_radius,
      &MergeBounds::angle,        &MergeBounds::all_angle, &MergeBounds::colour,
      &MergeBounds::all_colour};
  return std::span(kMembers).first(with_colours ? 10 : 8);
}

/// Normal, and colour if there is one.
void write_look(const MergeTree& tree, std::uint32_t vertex, PackedWriter& writer) {
  writer.fixed32(encoded_normal(tree.normals[vertex].cast<double>()));
  if (tree.colours.empty()) return;
  const auto [red, green, blue] = tree.colours[vertex];
  writer.fixed16(static_cast<std::uint32_t>(red | green << 8));
  writer.fixed16(blue);
}

std::string coarsest_body(const MergeTree& tree) {
  PackedWriter writer;
  Eigen::Vector3i point(0, 0, 0);
  for (std::uint32_t v = 0; v < tree.coarsest_points; ++v) {
    writer.difference(tree.points[v], point);
    point = tree.points[v];
    write_look(tree, v, writer);
  }
  std::int64_t corner = 0;
  for (std::uint32_t t = 0; t < tree.coarsest_triangles; ++t) {
    for (const std::uint32_t v : tree.triangles[t]) {
      writer.signed_number(v - corner);
      corner = v;
    }
  }
  return writer.bytes();
}

/// What a number is stored as the difference from.
struct Previous {
  std::uint32_t level = 0, parent = 0;
};

/// The apexes of the split that undoes a merge.
std::array<std::uint32_t, 3> apexes_of(const MergeTree& tree, const Merge& merge) {
  // the triangles beside the core were added after those dealt out, in the order of the apexes
  const bool is_edge = merge.child_count == 1;
  const std::array<std::uint32_t, 3> corners{is_edge ? merge.parent : merge.first_child,
                                             is_edge ? merge.first_child : merge.first_child + 1,
                                             merge.first_child + 2};
  const std::size_t arcs = is_edge ? 2 : 3;
  std::array<std::uint32_t, 3> apexes{kOutside, kOutside, kOutside};
  const std::uint32_t dealt = merge.coarse_end - merge.coarse_begin;
  for (std::uint32_t t = merge.fine_begin + dealt; t < merge.fine_end; ++t) {
    const Corners& c = tree.triangles[t];
    for (std::size_t k = 0; k < arcs; ++k) {
      const bool is_beside = c[0] == corners[(k + 1) % arcs] && c[1] == corners[k];
      if (is_beside) apexes[k] = c[2];
    }
  }
  return apexes;
}

void write_merge(const MergeTree& tree, std::uint32_t i, const TreeGrower& grower,
                 const Split& split, Previous& previous, PackedWriter& writer) {
  const Merge& merge = tree.merges[i];
  writer.number(previous.level - merge.level);
  writer.signed_number((std::int64_t{merge.parent} - previous.parent) * 2 +
                       (merge.child_count == 3));
  previous = {merge.level, merge.parent};
  const auto ring = grower.ring(merge.parent);
  for (std::size_t k = 0; k < (merge.child_count == 1 ? 2 : 3); ++k) {
    writer.number(static_cast<std::uint64_t>(std::find(ring.begin(), ring.end(), split.apexes[k]) -
                                             ring.begin()));
  }
  for (std::uint32_t k = 0; k < merge.child_count; ++k) {
    writer.difference(split.places[k], tree.points[merge.parent]);
    write_look(tree, merge.first_child + k, writer);
  }
  for (const auto member : bound_members(!tree.colours.empty())) {
    writer.fixed16(upper_half(tree.bounds[i].*member));
  }
}

Split split_of(const MergeTree& tree, std::uint32_t i) {
  const Merge& merge = tree.merges[i];
  Split split{.parent = merge.parent,
              .child_count = merge.child_count,
              .apexes = apexes_of(tree, merge),
              .level = merge.level};
  for (std::uint32_t k = 0; k < merge.child_count; ++k) {
    split.places[k] = tree.points[merge.first_child + k];
  }
  return split;
}

/// Everything of a tree that a grower begins with.
MergeTree seed_of(const MergeTree& tree) {
  MergeTree seed{.lattice = tree.lattice, .measure = tree.measure, .region = tree.region};
  seed.points.assign(tree.points.begin(), tree.points.begin() + tree.coarsest_points);
  seed.triangles.assign(tree.triangles.begin(), tree.triangles.begin() + tree.coarsest_triangles);
  return seed;
}

/// Takes the parts of a file one after the other.
class Parts {
 public:
  Parts(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  /// The next part of a size, whose checksum follows; nothing if the bytes end before that.
  std::optional<std::string_view> take(std::size_t size) {
    if (bytes_.size() < kChecksumBytes || size > bytes_.size() - kChecksumBytes) return {};
    const std::string_view part = bytes_.substr(0, size);
    PackedReader checksum(bytes_.substr(size, kChecksumBytes), file_);
    if (checksum.fixed32() != crc32_of(part)) checksum.damaged();
    bytes_.remove_prefix(size + kChecksumBytes);
    return part;
  }
  std::string_view rest() const { return bytes_; }
  [[noreturn]] void damaged() const { PackedReader({}, file_).damaged(); }

 private:
  std::string_view bytes_;
  const std::string& file_;
};

Header read_header(std::string_view bytes, const std::string& file) {
  PackedReader reader(bytes.substr(kMagic.size()), file);
  const std::uint32_t version = reader.fixed32();
  if (version < kOldestVersion || version > kVersion) {
    throw InputError(file + ": is of version " + std::to_string(version) +
                     ", and this terrane reads " + std::to_string(kVersion) + ". Build it again");
  }
  Header header;
  header.exponent = std::bit_cast<std::int32_t>(reader.fixed32());
  for (double& value : header.origin) {
    const std::uint64_t low = reader.fixed32();
    value = std::bit_cast<double>(low | std::uint64_t{reader.fixed32()} << 32);
    if (!std::isfinite(value)) reader.damaged();
  }
  const std::uint32_t kinds = reader.fixed16(), colours = reader.fixed16();
  if ((kinds & 0xff) > 1 || (kinds >> 8) > 1 || colours > version - 1) reader.damaged();
  // beyond, places or what is worked out from them would not be finite
  if (header.exponent < -1000 || header.exponent > 200) reader.damaged();
  header.measure = static_cast<ErrorMeasure>(kinds & 0xff);
  header.region = static_cast<Region>(kinds >> 8);
  header.has_colours = colours == 1;
  for (std::uint32_t* n :
       {&header.points, &header.triangles, &header.merges, &header.coarsest_bytes}) {
    *n = reader.fixed32();
  }
  return header;
}

/// How the vertices of a tree look, as they are read.
struct Looks {
  bool has_colours = false;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Colour> colours;

  void read(PackedReader& reader) {
    normals.push_back(decoded_normal(reader.fixed32()));
    if (!has_colours) return;
    const std::uint32_t two = reader.fixed16(), last = reader.fixed16();
    if (last > 0xff) reader.damaged();
    colours.push_back({static_cast<std::uint8_t>(two & 0xff), static_cast<std::uint8_t>(two >> 8),
                       static_cast<std::uint8_t>(last)});
  }
};

/// Reads splits into a grower.
class MergeReader {
 public:
  MergeReader(MergeTree seed, Looks looks, const std::string& file)
      : grower_(std::move(seed)), looks_(std::move(looks)), file_(file) {}

  void read_block(std::string_view body, std::uint32_t count) {
    PackedReader reader(body, file_);
    if (merge_count() == 0) previous_.level = reader.id_near(0, ~std::uint32_t{0});
    for (std::uint32_t i = 0; i < count; ++i) read_merge(reader);
    if (!reader.is_at_end()) reader.damaged();
  }
  std::uint32_t merge_count() const { return grower_.tree().merge_count(); }
  MergeTree finish() && {
    MergeTree tree = std::move(grower_).finish();
    tree.normals = std::move(looks_.normals);
    tree.colours = std::move(looks_.colours);
    tree.bounds = std::move(bounds_);
    tree.view_ranges = view_ranges_of(tree);
    return tree;
  }

 private:
  void read_merge(PackedReader& reader) {
    Split split;
    const std::uint64_t down = reader.number();
    if (down >= previous_.level) reader.damaged();
    split.level = previous_.level - static_cast<std::uint32_t>(down);
    const std::int64_t parent = reader.signed_number();
    const std::size_t points = grower_.tree().points.size();
    constexpr std::int64_t kMost = std::int64_t{1} << 33;
    const std::int64_t id = previous_.parent + (std::clamp(parent, -kMost, kMost) >> 1);
    if (id < 0 || static_cast<std::uint64_t>(id) >= points) reader.damaged();
    split.parent = static_cast<std::uint32_t>(id);
    split.child_count = parent & 1 ? 3 : 1;
    previous_ = {split.level, split.parent};

    const auto ring = grower_.ring(split.parent);
    for (std::size_t k = 0; k < (split.child_count == 1 ? 2 : 3); ++k) {
      const std::uint64_t rank = reader.number();
      if (rank > ring.size()) reader.damaged();
      split.apexes[k] = rank == ring.size() ? kOutside : ring[rank];
    }
    for (std::uint32_t k = 0; k < split.child_count; ++k) {
      split.places[k] = reader.sum(grower_.tree().points[split.parent]);
      looks_.read(reader);
    }
    grower_.split(split);
    bounds_.push_back(read_bounds(reader));
  }

  MergeBounds read_bounds(PackedReader& reader) const {
    MergeBounds bounds;
    for (const auto member : bound_members(looks_.has_colours)) {
      bounds.*member = std::bit_cast<float>(reader.fixed16() << 16);
      if (!(bounds.*member >= 0) || !std::isfinite(bounds.*member)) reader.damaged();
    }
    if (bounds.angle > kLargestAngle || bounds.all_angle > kLargestAngle) reader.damaged();
    return bounds;
  }

  TreeGrower grower_;
  Looks looks_;
  std::vector<MergeBounds> bounds_;
  const std::string& file_;
  Previous previous_;
};

MergeReader read_coarsest(const Header& header, std::string_view body, const std::string& file) {
  PackedReader reader(body, file);
  MergeTree seed{
      .lattice = {{header.origin[0], header.origin[1], header.origin[2]}, header.exponent},
      .measure = header.measure,
      .region = header.region};
  Looks looks{.has_colours = header.has_colours, .normals = {}, .colours = {}};
  Eigen::Vector3i point(0, 0, 0);
  for (std::uint32_t i = 0; i < header.points; ++i) {
    point = reader.sum(point);
    if (point.cwiseAbs().maxCoeff() > 1 << 24) reader.damaged();
    seed.points.push_back(point);
    looks.read(reader);
  }
  std::uint32_t corner = 0;
  for (std::uint32_t i = 0; i < header.triangles; ++i) {
    Corners corners;
    for (std::uint32_t& v : corners) v = corner = reader.id_near(corner, header.points);
    seed.triangles.push_back(corners);
  }
  if (!reader.is_at_end()) reader.damaged();
  return {std::move(seed), std::move(looks), file};
}

}  // namespace

std::string encode_tree(const MergeTree& tree) {
  const std::string coarsest = coarsest_body(tree);
  const Eigen::Vector3d& origin = tree.lattice.origin();
  std::string bytes = encoded({.exponent = tree.lattice.exponent(),
                               .origin = {origin[0], origin[1], origin[2]},
                               .measure = tree.measure,
                               .region = tree.region,
                               .has_colours = !tree.colours.empty(),
                               .points = tree.coarsest_points,
                               .triangles = tree.coarsest_triangles,
                               .merges = tree.merge_count(),
                               .coarsest_bytes = static_cast<std::uint32_t>(coarsest.size())});
  append_checksum(bytes, 0);
  std::size_t begin = bytes.size();
  bytes += coarsest;
  append_checksum(bytes, begin);

  TreeGrower grower(seed_of(tree));
  Previous previous{.level = tree.level_count()};
  for (std::uint32_t first = 0; first < tree.merge_count(); first += kMergesPerBlock) {
    const std::uint32_t end = std::min(tree.merge_count(), first + kMergesPerBlock);
    PackedWriter body;
    if (first == 0) body.signed_number(tree.level_count());
    for (std::uint32_t i = first; i < end; ++i) {
      const Split split = split_of(tree, i);
      write_merge(tree, i, grower, split, previous, body);
      grower.split(split);
    }
    PackedWriter head;
    head.fixed32(end - first);
    head.fixed32(static_cast<std::uint32_t>(body.bytes().size()));
    begin = bytes.size();
    bytes += head.bytes() + body.bytes();
    append_checksum(bytes, begin);
  }
  return bytes;
}

MergeTree decode_tree(std::string_view bytes, const std::string& file, TreeEnd end) {
  if (!bytes.starts_with(kMagic)) {
    throw InputError(file + ": is no merge tree. Name one that terrane merge-tree wrote");
  }
  Parts parts(bytes, file);
  const auto head = parts.take(kHeaderBytes - kChecksumBytes);
  if (!head) parts.damaged();
  const Header header = read_header(*head, file);
  const auto coarsest = parts.take(header.coarsest_bytes);
  if (!coarsest) parts.damaged();
  MergeReader merges = read_coarsest(header, *coarsest, file);
  while (merges.merge_count() < header.merges) {
    PackedReader sizes(parts.rest().substr(0, kBlockHeaderBytes), file);
    const bool has_sizes = parts.rest().size() >= kBlockHeaderBytes;
    const std::uint32_t count = has_sizes ? sizes.fixed32() : 0;
    const std::uint32_t body_bytes = has_sizes ? sizes.fixed32() : 0;
    if (has_sizes && (count == 0 || count > header.merges - merges.merge_count())) parts.damaged();
    const auto block =
        has_sizes ? parts.take(kBlockHeaderBytes + std::size_t{body_bytes}) : std::nullopt;
    if (!block && end == TreeEnd::kAnywhere) return std::move(merges).finish();
    if (!block) parts.damaged();
    merges.read_block(block->substr(kBlockHeaderBytes), count);
  }
  if (!parts.rest().empty()) parts.damaged();
  return std::move(merges).finish();
}

}  // namespace terrane::hierarchy
