#include "tiler/gltf/glb_buffers.h"

#include <meshoptimizer.h>

#include <cstring>

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125;

/// 65535 starts a strip anew in some clients' eyes.
bool are_short(std::size_t vertices) { return vertices <= 65535; }

/// Whole numbers without ".0": a glb of a small tile is a quarter text.
ordered_json short_numbers(const std::vector<double>& numbers) {
  ordered_json list = ordered_json::array();
  for (const double number : numbers) {
    const auto whole = static_cast<std::int64_t>(number);
    if (static_cast<double>(whole) == number) {
      list.push_back(whole);
    } else {
      list.push_back(number);
    }
  }
  return list;
}

ordered_json described(const GlbValues& values, std::size_t count) {
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  ordered_json accessor{{"componentType", static_cast<int>(values.component)},
                        {"count", count},
                        {"type", kTypes[values.components]}};
  if (values.is_normalized) accessor["normalized"] = true;
  if (!values.low.empty()) accessor["min"] = short_numbers(values.low);
  if (!values.high.empty()) accessor["max"] = short_numbers(values.high);
  return accessor;
}

ordered_json described(std::size_t indices, std::size_t vertices) {
  return {{"componentType", are_short(vertices) ? kUnsignedShort : kUnsignedInt},
          {"count", indices},
          {"type", "SCALAR"}};
}

/// A view of a buffer; what is left out is 0.
ordered_json part_of(int buffer, std::size_t offset, std::size_t bytes) {
  ordered_json view{{"buffer", buffer}};
  if (offset > 0) view["byteOffset"] = offset;
  view["byteLength"] = bytes;
  return view;
}

std::vector<unsigned char> coded_triangles(const std::vector<std::uint32_t>& indices,
                                           std::size_t vertices) {
  // streams of EXT_meshopt_compression have version 1; the library's default is 0
  [[maybe_unused]] static const bool is_chosen = (meshopt_encodeIndexVersion(1), true);
  std::vector<unsigned char> coded(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  coded.resize(
      meshopt_encodeIndexBuffer(coded.data(), coded.size(), indices.data(), indices.size()));
  return coded;
}

/// Null for none.
const char* name_of(Filter filter) {
  if (filter == Filter::kNone) return nullptr;
  return filter == Filter::kExponential ? "EXPONENTIAL" : "OCTAHEDRAL";
}

}  // namespace

Filter GlbBuffers::filter_of(const GlbValues& values) const {
  return is_meshopt_ ? values.filter : Filter::kNone;
}

const std::string& GlbBuffers::stored(const GlbValues& values) const {
  return filter_of(values) == Filter::kNone ? values.bytes : values.filtered;
}

int GlbBuffers::add_vertices(const GlbValues& values) {
  ordered_json accessor = described(values, values.count);
  accessor["bufferView"] =
      add_vertex_view(stored(values), values.count, values.stride, filter_of(values));
  return add_accessor(accessor);
}

std::array<int, 2> GlbBuffers::add_vertices(const GlbValues& first, const GlbValues& second) {
  // a filter goes over a whole view, and that for unit vectors takes one of them at a time
  const Filter filter = filter_of(first);
  if (filter != filter_of(second) || filter == Filter::kOctahedral) {
    return {add_vertices(first), add_vertices(second)};
  }
  std::string bytes;
  for (std::size_t n = 0; n < first.count; ++n) {
    bytes.append(stored(first), n * first.stride, first.stride);
    bytes.append(stored(second), n * second.stride, second.stride);
  }
  const int view = add_vertex_view(bytes, first.count, first.stride + second.stride, filter);
  std::array<int, 2> numbers;
  for (const bool is_second : {false, true}) {
    ordered_json accessor = described(is_second ? second : first, first.count);
    accessor["bufferView"] = view;
    if (is_second) accessor["byteOffset"] = first.stride;
    numbers[is_second ? 1 : 0] = add_accessor(accessor);
  }
  return numbers;
}

int GlbBuffers::add_vertex_view(const std::string& bytes, std::size_t count, std::size_t stride,
                                Filter filter) {
  int view = 0;
  if (is_meshopt_) {
    std::vector<unsigned char> coded(meshopt_encodeVertexBufferBound(count, stride));
    coded.resize(
        meshopt_encodeVertexBuffer(coded.data(), coded.size(), bytes.data(), count, stride));
    view = add_coded(coded, count, stride, "ATTRIBUTES", name_of(filter));
  } else {
    view = add_raw(bytes);
  }
  views_[view]["byteStride"] = stride;
  views_[view]["target"] = kArrayBuffer;
  return view;
}

int GlbBuffers::add_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  const std::size_t width = are_short(vertices) ? 2 : 4;
  int view = 0;
  if (is_meshopt_) {
    view =
        add_coded(coded_triangles(indices, vertices), indices.size(), width, "TRIANGLES", nullptr);
  } else {
    std::string plain;
    for (const std::uint32_t index : indices) {
      char raw[4];
      std::memcpy(raw, &index, 4);  // the lower half comes first
      plain.append(raw, width);
    }
    view = add_raw(plain);
  }
  views_[view]["target"] = kElementArrayBuffer;
  ordered_json accessor = described(indices.size(), vertices);
  accessor["bufferView"] = view;
  return add_accessor(accessor);
}

int GlbBuffers::add_elsewhere(const GlbValues& values, std::size_t count) {
  return add_accessor(described(values, count));
}

int GlbBuffers::add_elsewhere(std::size_t indices, std::size_t vertices) {
  return add_accessor(described(indices, vertices));
}

int GlbBuffers::add_raw(std::string_view bytes) {
  ordered_json view = part_of(0, bytes_.size(), bytes.size());
  bytes_.append(bytes);
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return add_view(std::move(view));
}

int GlbBuffers::add_coded(const std::vector<unsigned char>& coded, std::size_t count,
                          std::size_t stride, const char* mode, const char* filter) {
  ordered_json view = part_of(1, fallback_bytes_, count * stride);
  ordered_json& extension = view["extensions"][kMeshopt];
  extension = part_of(0, bytes_.size(), coded.size());
  extension["byteStride"] = stride;
  extension["mode"] = mode;
  extension["count"] = count;
  if (filter != nullptr) extension["filter"] = filter;
  fallback_bytes_ += (count * stride + 3) / 4 * 4;
  bytes_.append(coded.begin(), coded.end());
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return add_view(std::move(view));
}

int GlbBuffers::add_view(ordered_json view) {
  views_.push_back(std::move(view));
  return static_cast<int>(views_.size()) - 1;
}

int GlbBuffers::add_accessor(ordered_json accessor) {
  accessors_.push_back(std::move(accessor));
  return static_cast<int>(accessors_.size()) - 1;
}

ordered_json GlbBuffers::buffers() const {
  ordered_json buffers = {{{"byteLength", bytes_.size()}}};
  if (!is_meshopt_) return buffers;
  ordered_json fallback{{"byteLength", fallback_bytes_}};
  fallback["extensions"][kMeshopt]["fallback"] = true;
  buffers.push_back(std::move(fallback));
  return buffers;
}

}  // namespace terrane::tiler
