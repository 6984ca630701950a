#include "tiler/tileset/subtree_bytes.h"

#include <algorithm>
#include <bit>

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "subtrees are little-endian");

void append_word(std::string& bytes, std::uint64_t word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

int best_levels_per_subtree(int levels) {
  if (levels <= 5) return levels;
  const auto missing = [levels](int per_subtree) {
    return (per_subtree - levels % per_subtree) % per_subtree;
  };
  return std::min({4, 5, 3}, [&](int a, int b) { return missing(a) < missing(b); });
}

std::int64_t morton(std::int64_t x, std::int64_t y) {
  std::int64_t code = 0;
  for (int bit = 0; bit < 31; ++bit) {
    code |= ((x >> bit & 1) << (2 * bit)) | ((y >> bit & 1) << (2 * bit + 1));
  }
  return code;
}

std::int64_t tiles_above(int depth) { return ((std::int64_t{1} << (2 * depth)) - 1) / 3; }

int SubtreeBuffers::add_bytes(const char* begin, std::size_t size) {
  bytes_.resize((bytes_.size() + 7) / 8 * 8);
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
  bytes_.append(begin, size);
  return static_cast<int>(views_.size()) - 1;
}

std::string SubtreeBuffers::padded() const {
  std::string bytes = bytes_;
  bytes.resize((bytes.size() + 7) / 8 * 8);
  return bytes;
}

void SubtreeAvailability::set(std::int64_t index) {
  bits_[static_cast<std::size_t>(index / 8)] |= static_cast<unsigned char>(1 << (index % 8));
  ++count_;
}

ordered_json SubtreeAvailability::json(SubtreeBuffers& buffers) const {
  if (count_ == 0 || count_ == size_) return {{"constant", count_ == 0 ? 0 : 1}};
  return {{"bitstream", buffers.add(bits_)}, {"availableCount", count_}};
}

std::string pack_subtree(std::string json, const std::string& binary) {
  json.resize((json.size() + 7) / 8 * 8, ' ');
  std::string subtree("subt\1\0\0\0", 8);
  append_word(subtree, json.size());
  append_word(subtree, binary.size());
  return subtree + json + binary;
}

}  // namespace terrane::tiler
