#include "tiler/verify/glb.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "core/errors.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN\0"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::size_t kMostElements = std::size_t{1} << 28;  // a damaged count must not eat memory

constexpr int kShort = 5122;
constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;

std::uint32_t word_at(const std::vector<unsigned char>& content, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, content.data() + offset, sizeof word);
  return word;
}

/// What KHR_draco_mesh_compression says of a primitive; null if nothing.
const json* draco_extension(const json& primitive) {
  const auto extensions = primitive.find("extensions");
  if (extensions == primitive.end()) return nullptr;
  const auto draco = extensions->find("KHR_draco_mesh_compression");
  return draco == extensions->end() ? nullptr : &*draco;
}

template <class T>
Glb::Vector vector_of(const unsigned char* element) {
  std::array<T, 3> values;
  std::memcpy(values.data(), element, sizeof values);
  const auto as_double = [&](std::size_t axis) { return static_cast<double>(values[axis]); };
  return {as_double(0), as_double(1), as_double(2)};
}

}  // namespace

void Glb::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: damaged tile ({}). Run 'terrane build' again with --force",
                               file_.string(), what));
}

Glb Glb::read(const std::filesystem::path& file) {
  Glb glb;
  glb.file_ = file;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError(fmt::format(
        "{}: tileset.json lists it, but it is missing. Run 'terrane build' again with --force",
        file.string()));
  }
  glb.content_.assign(std::istreambuf_iterator<char>(stream), {});
  glb.split_chunks();
  return glb;
}

void Glb::split_chunks() {
  if (content_.size() < kHeaderBytes + kChunkHeaderBytes || word_at(content_, 0) != kMagic ||
      word_at(content_, 4) != 2) {
    fail("no binary glTF 2 header");
  }
  if (word_at(content_, 8) != content_.size()) {
    fail(fmt::format("{} bytes, its header says {}", content_.size(), word_at(content_, 8)));
  }
  const std::size_t json_begin = kHeaderBytes + kChunkHeaderBytes;
  const std::size_t json_size = word_at(content_, kHeaderBytes);
  const std::size_t binary_header = json_begin + json_size;
  if (word_at(content_, kHeaderBytes + 4) != kJsonChunk ||
      binary_header + kChunkHeaderBytes > content_.size() ||
      word_at(content_, binary_header + 4) != kBinaryChunk) {
    fail("no JSON chunk followed by a binary one");
  }
  binary_begin_ = binary_header + kChunkHeaderBytes;
  binary_size_ = word_at(content_, binary_header);
  if (binary_begin_ + binary_size_ > content_.size()) fail("its binary chunk is cut off");
  const auto begin = content_.begin() + static_cast<std::ptrdiff_t>(json_begin);
  document_ = json::parse(begin, begin + static_cast<std::ptrdiff_t>(json_size), nullptr, false);
  if (document_.is_discarded()) fail("its JSON does not parse");
}

const json& Glb::accessor_of(const json& index) const {
  return document_.at("accessors").at(index.get<std::size_t>());
}

std::vector<unsigned char> Glb::plain_view(const json& view, std::size_t index) const {
  const auto offset = view.value("byteOffset", std::size_t{0});
  const auto size = view.at("byteLength").get<std::size_t>();
  if (view.at("buffer").get<int>() != 0 || offset > binary_size_ || size > binary_size_ - offset) {
    fail(fmt::format("buffer view {} reaches past the end", index));
  }
  const auto begin = content_.begin() + static_cast<std::ptrdiff_t>(binary_begin_ + offset);
  return {begin, begin + static_cast<std::ptrdiff_t>(size)};
}

/// \param stride  in: bytes of an element; out: from one element to the next.
std::vector<unsigned char> Glb::decode_view(std::size_t index, std::size_t& stride) const {
  const json& whole = document_.at("bufferViews").at(index);
  const json none = json::object();
  const json& extensions = whole.contains("extensions") ? whole.at("extensions") : none;
  if (!extensions.contains("EXT_meshopt_compression")) {
    stride = whole.value("byteStride", stride);
    if (stride == 0) fail(fmt::format("buffer view {} has a stride of 0", index));
    return plain_view(whole, index);
  }
  const json& view = extensions.at("EXT_meshopt_compression");
  const auto offset = view.value("byteOffset", std::size_t{0});
  const auto size = view.at("byteLength").get<std::size_t>();
  const auto count = view.at("count").get<std::size_t>();
  const auto mode = view.at("mode").get<std::string>();
  stride = view.at("byteStride").get<std::size_t>();
  if (view.at("buffer").get<int>() != 0 || offset > binary_size_ || size > binary_size_ - offset) {
    fail(fmt::format("buffer view {} reaches past the end", index));
  }
  const auto filter = view.value("filter", "NONE");
  if (count > kMostElements || (filter != "NONE" && filter != "EXPONENTIAL")) {
    fail(fmt::format("buffer view {} has {} elements or the filter {}", index, count, filter));
  }
  const bool is_attributes =
      mode == "ATTRIBUTES" && stride >= 4 && stride <= 256 && stride % 4 == 0;
  const bool is_triangles = mode == "TRIANGLES" && (stride == 2 || stride == 4) && count % 3 == 0;
  if (!is_attributes && !is_triangles) {
    fail(fmt::format("buffer view {}: mode {} with a stride of {}", index, mode, stride));
  }
  std::vector<unsigned char> decoded(count * stride);
  const unsigned char* encoded = content_.data() + binary_begin_ + offset;
  const int status = is_attributes
                         ? meshopt_decodeVertexBuffer(decoded.data(), count, stride, encoded, size)
                         : meshopt_decodeIndexBuffer(decoded.data(), count, stride, encoded, size);
  if (status != 0) fail(fmt::format("buffer view {} does not decompress", index));
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), count, stride);
  return decoded;
}

Glb::View Glb::view_of(const json& accessor, std::size_t element_bytes) const {
  View view{.stride = element_bytes};
  view.bytes = decode_view(accessor.at("bufferView").get<std::size_t>(), view.stride);
  const auto offset = accessor.value("byteOffset", std::size_t{0});
  const auto count = accessor.at("count").get<std::size_t>();
  const bool fits =
      count == 0 ||
      (count <= kMostElements && element_bytes <= view.stride && offset <= view.bytes.size() &&
       offset + (count - 1) * view.stride + element_bytes <= view.bytes.size());
  if (!fits) fail("an accessor reaches past its buffer view");
  view.bytes.erase(view.bytes.begin(),
                   view.bytes.begin() + static_cast<std::ptrdiff_t>(count == 0 ? 0 : offset));
  return view;
}

DracoPrimitive Glb::draco_of(const json& coded) const {
  const auto index = coded.at("bufferView").get<std::size_t>();
  const auto bytes = plain_view(document_.at("bufferViews").at(index), index);
  auto decoded = DracoPrimitive::decode(bytes);
  if (!decoded) fail("its Draco mesh does not decode");
  return *std::move(decoded);
}

std::vector<Glb::Vector> Glb::vectors(const json& primitive, const char* attribute) const {
  const json& accessor = accessor_of(primitive.at("attributes").at(attribute));
  const int type = accessor.at("componentType").get<int>();
  if ((type != kShort && type != kFloat) || accessor.at("type") != "VEC3") {
    fail("a vertex attribute is not SHORT or FLOAT VEC3");
  }
  const auto count = accessor.at("count").get<std::size_t>();
  if (const json* coded = draco_extension(primitive)) {
    auto vectors = draco_of(*coded).vectors(coded->at("attributes").at(attribute));
    if (vectors.size() != count) fail("an accessor is not as long as its Draco attribute");
    return vectors;
  }
  const View view = view_of(accessor, type == kShort ? 6 : 12);
  std::vector<Vector> vectors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned char* element = view.bytes.data() + i * view.stride;
    vectors[i] = type == kShort ? vector_of<std::int16_t>(element) : vector_of<float>(element);
  }
  return vectors;
}

std::vector<std::uint32_t> Glb::indices(const json& primitive) const {
  const json* coded = draco_extension(primitive);
  if (coded == nullptr) return whole_numbers(primitive.at("indices"));
  auto indices = draco_of(*coded).indices();
  if (accessor_of(primitive.at("indices")).at("count") != indices.size()) {
    fail("an accessor is not as long as its Draco mesh");
  }
  return indices;
}

std::vector<std::uint32_t> Glb::whole_numbers(const json& accessor_index) const {
  const json& accessor = accessor_of(accessor_index);
  const int type = accessor.at("componentType").get<int>();
  if ((type != kUnsignedShort && type != kUnsignedInt) || accessor.at("type") != "SCALAR") {
    fail("indices are not UNSIGNED SHORT or INT");
  }
  const std::size_t element_bytes = type == kUnsignedShort ? 2 : 4;
  const View view = view_of(accessor, element_bytes);
  // the type and the stride must agree, or every second index would be read as zero
  if (view.stride != element_bytes) fail("indices are packed in another width than their type");
  std::vector<std::uint32_t> numbers(accessor.at("count").get<std::size_t>(), 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::memcpy(&numbers[i], view.bytes.data() + i * view.stride, element_bytes);
  }
  return numbers;
}

}  // namespace terrane::verify
