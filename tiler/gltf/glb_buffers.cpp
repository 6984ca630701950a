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

ordered_json described(const GlbValues& values, std::size_t count) {
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  ordered_json accessor{{"componentType", static_cast<int>(values.component)},
                        {"count", count},
                        {"type", kTypes[values.components]}};
  if (values.is_normalized) accessor["normalized"] = true;
  if (!values.low.empty()) accessor["min"] = values.low;
  if (!values.high.empty()) accessor["max"] = values.high;
  return accessor;
}

ordered_json described(std::size_t indices, std::size_t vertices) {
  return {{"componentType", are_short(vertices) ? kUnsignedShort : kUnsignedInt},
          {"count", indices},
          {"type", "SCALAR"}};
}

}  // namespace

int GlbBuffers::add_vertices(const GlbValues& values) {
  ordered_json accessor = described(values, values.count);
  int view = 0;
  if (is_meshopt_) {
    const bool is_filtered = !values.exponential.empty();
    const std::string& from = is_filtered ? values.exponential : values.bytes;
    std::vector<unsigned char> coded(meshopt_encodeVertexBufferBound(values.count, values.stride));
    coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), from.data(), values.count,
                                            values.stride));
    view = add_coded(coded, values.count, values.stride, "ATTRIBUTES",
                     is_filtered ? "EXPONENTIAL" : nullptr);
  } else {
    view = add_raw(values.bytes);
  }
  views_[view]["byteStride"] = values.stride;
  views_[view]["target"] = kArrayBuffer;
  accessor["bufferView"] = view;
  return add_accessor(accessor);
}

int GlbBuffers::add_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  const std::size_t width = are_short(vertices) ? 2 : 4;
  int view = 0;
  if (is_meshopt_) {
    std::vector<unsigned char> coded(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    coded.resize(
        meshopt_encodeIndexBuffer(coded.data(), coded.size(), indices.data(), indices.size()));
    view = add_coded(coded, indices.size(), width, "TRIANGLES", nullptr);
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
  ordered_json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  bytes_.append(bytes);
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return add_view(std::move(view));
}

int GlbBuffers::add_coded(const std::vector<unsigned char>& coded, std::size_t count,
                          std::size_t stride, const char* mode, const char* filter) {
  ordered_json view{{"buffer", 1}, {"byteOffset", fallback_bytes_}, {"byteLength", count * stride}};
  view["extensions"][kMeshopt] = {{"buffer", 0},
                                  {"byteOffset", bytes_.size()},
                                  {"byteLength", coded.size()},
                                  {"byteStride", stride},
                                  {"mode", mode},
                                  {"count", count}};
  if (filter != nullptr) view["extensions"][kMeshopt]["filter"] = filter;
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
