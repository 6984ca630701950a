#include "tiler/verify/subtree.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "core/errors.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

constexpr std::size_t kHeaderBytes = 24;
constexpr int kMostLevels = 10;  // a damaged number must not eat memory

class File {
 public:
  explicit File(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
      throw InputError(
          fmt::format("{}: missing or unreadable. Run 'terrane build' again with --force", name_));
    }
    content_.assign(std::istreambuf_iterator<char>(stream), {});
    std::uint32_t magic = 0, version = 0;
    std::uint64_t json_bytes = 0, binary_bytes = 0;
    if (content_.size() < kHeaderBytes) fail("no header");
    std::memcpy(&magic, content_.data(), 4);
    std::memcpy(&version, content_.data() + 4, 4);
    std::memcpy(&json_bytes, content_.data() + 8, 8);
    std::memcpy(&binary_bytes, content_.data() + 16, 8);
    const std::size_t left = content_.size() - kHeaderBytes;
    if (magic != 0x74627573 || version != 1) fail("not the header of a subtree");
    if (json_bytes > left || binary_bytes != left - json_bytes) fail("not as long as it says");
    binary_ = kHeaderBytes + json_bytes;
    document_ = json::parse(content_.substr(kHeaderBytes, json_bytes), nullptr, false);
    if (document_.is_discarded()) fail("its JSON does not parse");
  }

  const json& document() const { return document_; }

  /// A number of a buffer view that is an array of T.
  template <class T>
  T number(std::size_t view_index, std::size_t index) const {
    const json& view = document_.at("bufferViews").at(view_index);
    const auto offset = view.at("byteOffset").get<std::size_t>();
    const auto size = view.at("byteLength").get<std::size_t>();
    const std::size_t all = content_.size() - binary_;
    if (view.at("buffer") != 0 || offset > all || size > all - offset ||
        index >= size / sizeof(T)) {
      fail(fmt::format("buffer view {} reaches past the end", view_index));
    }
    T value;
    std::memcpy(&value, content_.data() + binary_ + offset + index * sizeof(T), sizeof(T));
    return value;
  }

  bool is_available(const json& availability, std::size_t index) const {
    if (availability.contains("constant")) return availability.at("constant") == 1;
    const auto byte =
        number<unsigned char>(availability.at("bitstream").get<std::size_t>(), index / 8);
    return (byte >> (index % 8) & 1) != 0;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(
        fmt::format("{}: damaged ({}). Run 'terrane build' again with --force", name_, what));
  }

 private:
  std::string name_;
  std::string content_;
  std::size_t binary_ = 0;
  json document_;
};

/// Every second bit, from the lowest on.
std::int64_t even_bits(std::size_t code) {
  std::int64_t bits = 0;
  for (int n = 0; code != 0; ++n, code >>= 2) bits |= static_cast<std::int64_t>(code & 1) << n;
  return bits;
}

void take_tiles(const File& file, int levels, Subtree& subtree) {
  const json& document = file.document();
  std::size_t first = 0;
  for (int depth = 0; depth < levels; ++depth) {
    const std::size_t count = std::size_t{1} << (2 * depth);
    for (std::size_t code = 0; code < count; ++code) {
      if (!file.is_available(document.at("tileAvailability"), first + code)) continue;
      const bool has_content =
          file.is_available(document.at("contentAvailability").at(0), first + code);
      subtree.tiles.push_back({.depth = depth,
                               .x = even_bits(code),
                               .y = even_bits(code >> 1),
                               .has_content = has_content});
    }
    first += count;
  }
  for (std::size_t code = 0; code < std::size_t{1} << (2 * levels); ++code) {
    if (!file.is_available(document.at("childSubtreeAvailability"), code)) continue;
    subtree.children.push_back({even_bits(code), even_bits(code >> 1)});
  }
}

/// The property table with a row for each tile.
class Metadata {
 public:
  Metadata(const File& file, std::size_t tiles)
      : file_(file),
        table_(file.document()
                   .at("propertyTables")
                   .at(file.document().at("tileMetadata").get<std::size_t>())) {
    if (table_.at("count") != tiles) file.fail("has not one row for each tile");
  }

  template <class T>
  T number(const std::string& property, std::size_t index) const {
    const json& values = table_.at("properties").at(property).at("values");
    return file_.number<T>(values.get<std::size_t>(), index);
  }

 private:
  const File& file_;
  const json& table_;
};

void take_metadata(const File& file, const std::string& box_property, Subtree& subtree) {
  const Metadata metadata(file, subtree.tiles.size());
  for (std::size_t row = 0; row < subtree.tiles.size(); ++row) {
    SubtreeTile& tile = subtree.tiles[row];
    for (std::size_t n = 0; n < 12; ++n) {
      tile.box[n] = metadata.number<double>(box_property, 12 * row + n);
    }
    tile.triangles = metadata.number<std::uint32_t>("triangles", row);
    tile.bytes = metadata.number<std::uint32_t>("bytes", row);
    tile.max_error_m = metadata.number<double>("max_error_m", row);
  }
}

void take_facts(const File& file, const TerrainProperties& names, TerrainSubtree& subtree) {
  const Metadata metadata(file, subtree.listing.tiles.size());
  for (std::size_t row = 0; row < subtree.listing.tiles.size(); ++row) {
    TerrainFacts& facts = subtree.facts.emplace_back();
    facts.min_height_m = metadata.number<double>(names.min_height, row);
    facts.max_height_m = metadata.number<double>(names.max_height, row);
    facts.sphere_radius_m = metadata.number<double>(names.bounding_sphere, 4 * row + 3);
    for (std::size_t n = 0; n < 3; ++n) {
      facts.sphere_centre[n] = metadata.number<double>(names.bounding_sphere, 4 * row + n);
      facts.horizon[n] = metadata.number<double>(names.horizon_occlusion_point, 3 * row + n);
    }
  }
}

/// Calls take(file) for a file that is open; what is wrong in its JSON becomes an InputError.
template <class Take>
void read(const std::filesystem::path& path, int levels, const Take& take) {
  const File file(path);
  if (levels < 1 || levels > kMostLevels) file.fail(fmt::format("{} levels", levels));
  try {
    take(file);
  } catch (const json::exception& error) {
    file.fail(error.what());
  }
}

}  // namespace

Subtree read_subtree(const std::filesystem::path& path, int levels,
                     const std::string& box_property) {
  Subtree subtree;
  read(path, levels, [&](const File& file) {
    take_tiles(file, levels, subtree);
    take_metadata(file, box_property, subtree);
  });
  return subtree;
}

TerrainSubtree read_terrain_subtree(const std::filesystem::path& path, int levels,
                                    const TerrainProperties& names) {
  TerrainSubtree subtree;
  read(path, levels, [&](const File& file) {
    take_tiles(file, levels, subtree.listing);
    take_facts(file, names, subtree);
  });
  return subtree;
}

}  // namespace terrane::verify
