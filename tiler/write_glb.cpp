#include "tiler/write_glb.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kQuantization = "KHR_mesh_quantization";

using Steps = std::array<std::int32_t, 3>;
/// Four and not three: meshopt codes vertices of whole words.
using Short3 = std::array<std::int16_t, 4>;
using Byte3 = std::array<std::int8_t, 4>;

/// What goes into the buffers, in the order of the vertex cache.
struct Attributes {
  LatticePoint origin;
  std::vector<Steps> positions;
  std::vector<Steps> morphs;
  std::vector<Byte3> normals;
  std::vector<std::uint32_t> indices;
};

LatticePoint middle_of(std::span<const LatticePoint> points) {
  LatticePoint low = points.front(), high = low;
  for (const LatticePoint& p : points) {
    low = {std::min(low.i, p.i), std::min(low.j, p.j), std::min(low.k, p.k)};
    high = {std::max(high.i, p.i), std::max(high.j, p.j), std::max(high.k, p.k)};
  }
  return {(low.i + high.i) / 2, (low.j + high.j) / 2, (low.k + high.k) / 2};
}

// the filter's mantissas have 24 bits, and floats hold every integer of that size
constexpr std::int64_t kMostSteps = (1 << 23) - 1;

std::int32_t step_of(std::int64_t value, const TileId& tile) {
  if (std::abs(value) > kMostSteps) {
    throw OutputError(fmt::format(
        "tile {}: spans more than 24 bits of lattice steps. This is a defect of terrane; please "
        "report it with the DEM's size and CRS",
        path_of(tile)));
  }
  return static_cast<std::int32_t>(value);
}

/// b - a in glTF's axes: x east, y up, z south.
Steps y_up(const LatticePoint& a, const LatticePoint& b, const TileId& tile) {
  return {step_of(b.i - a.i, tile), step_of(b.k - a.k, tile), step_of(a.j - b.j, tile)};
}

bool fits_16_bits(const std::vector<Steps>& values) {
  return std::ranges::all_of(values, [](const Steps& v) {
    return std::ranges::all_of(v, [](std::int32_t c) { return std::int16_t(c) == c; });
  });
}

/// Normals are divided by the node's scale when drawn: multiply first.
Byte3 normal_bytes(const Eigen::Vector3f& normal, const Eigen::Vector3d& step_m) {
  const Eigen::Vector3d n = normal.cast<double>().cwiseProduct(step_m).normalized() * 127;
  const auto byte = [](double v) { return static_cast<std::int8_t>(std::lround(v)); };
  return {byte(n.x()), byte(n.z()), byte(-n.y()), 0};
}

std::vector<std::uint32_t> cached_indices(const TileMesh& mesh, bool is_mirrored) {
  std::vector<std::uint32_t> indices;
  indices.reserve(mesh.triangles.size() * 3);
  for (auto [a, b, c] : mesh.triangles) {
    if (is_mirrored) std::swap(b, c);
    indices.insert(indices.end(), {a, b, c});
  }
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), mesh.points.size());
  return indices;
}

Attributes arrange(const TileId& tile, const TileMesh& mesh, std::span<const LatticePoint> targets,
                   const Eigen::Vector3d& step_m, bool is_mirrored) {
  Attributes result{.origin = middle_of(mesh.points)};
  result.indices = cached_indices(mesh, is_mirrored);
  std::vector<std::uint32_t> remap(mesh.points.size());
  const std::size_t count = meshopt_optimizeVertexFetchRemap(
      remap.data(), result.indices.data(), result.indices.size(), mesh.points.size());
  for (std::uint32_t& i : result.indices) i = remap[i];

  result.positions.resize(count);
  result.morphs.resize(count);
  result.normals.resize(count);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (remap[v] == ~std::uint32_t{0}) continue;
    result.positions[remap[v]] = y_up(result.origin, mesh.points[v], tile);
    result.morphs[remap[v]] = y_up(mesh.points[v], targets[v], tile);
    result.normals[remap[v]] = normal_bytes(mesh.normals[v], step_m);
  }
  return result;
}

/// Collects buffer views: the compressed bytes and what they describe.
class Buffers {
 public:
  template <class T>
  int add_vertices(const std::vector<T>& values, const char* filter = nullptr) {
    std::vector<unsigned char> coded(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
    coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), values.data(),
                                            values.size(), sizeof(T)));
    return add(coded, values.size(), sizeof(T), "ATTRIBUTES", true, filter);
  }

  /// Whole numbers: as 16 bits where they fit, else as floats. A float is sent as the exponential
  /// filter's word (exponent 0 and 24 bits of mantissa: the number itself), which codes as well as
  /// an integer.
  int add_steps(const std::vector<Steps>& values, bool is_short) {
    if (is_short) {
      std::vector<Short3> shorts;
      for (const Steps& v : values) {
        shorts.push_back({static_cast<std::int16_t>(v[0]), static_cast<std::int16_t>(v[1]),
                          static_cast<std::int16_t>(v[2]), 0});
      }
      return add_vertices(shorts);
    }
    std::vector<std::array<std::uint32_t, 3>> words;
    for (const Steps& v : values) {
      constexpr std::uint32_t kMantissa = 0xffffff;
      words.push_back({static_cast<std::uint32_t>(v[0]) & kMantissa,
                       static_cast<std::uint32_t>(v[1]) & kMantissa,
                       static_cast<std::uint32_t>(v[2]) & kMantissa});
    }
    return add_vertices(words, "EXPONENTIAL");
  }

  int add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices,
                  std::size_t bytes_per_index) {
    std::vector<unsigned char> coded(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    coded.resize(
        meshopt_encodeIndexBuffer(coded.data(), coded.size(), indices.data(), indices.size()));
    return add(coded, indices.size(), bytes_per_index, "TRIANGLES", false, nullptr);
  }

  nlohmann::ordered_json views() const { return views_; }
  std::size_t fallback_bytes() const { return fallback_; }
  std::string& bytes() { return bytes_; }

 private:
  int add(const std::vector<unsigned char>& coded, std::size_t count, std::size_t stride,
          const char* mode, bool is_vertices, const char* filter) {
    nlohmann::ordered_json view{{"buffer", 1}};
    view["byteOffset"] = fallback_;
    view["byteLength"] = count * stride;
    if (is_vertices) view["byteStride"] = stride;
    view["target"] =
        is_vertices ? TINYGLTF_TARGET_ARRAY_BUFFER : TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
    view["extensions"][kMeshopt] = {{"buffer", 0},
                                    {"byteOffset", bytes_.size()},
                                    {"byteLength", coded.size()},
                                    {"byteStride", stride},
                                    {"mode", mode},
                                    {"count", count}};
    if (filter != nullptr) view["extensions"][kMeshopt]["filter"] = filter;
    views_.push_back(std::move(view));
    fallback_ += (count * stride + 3) / 4 * 4;
    bytes_.append(coded.begin(), coded.end());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return static_cast<int>(views_.size()) - 1;
  }

  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  std::string bytes_;
  std::size_t fallback_ = 0;
};

int add_accessor(tinygltf::Model& model, int view, std::size_t count, int component, int type) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

/// An accessor of whole numbers, with its bounds.
int add_steps(tinygltf::Model& model, Buffers& buffers, const std::vector<Steps>& values) {
  const bool is_short = fits_16_bits(values);
  const int added = add_accessor(
      model, buffers.add_steps(values, is_short), values.size(),
      is_short ? TINYGLTF_COMPONENT_TYPE_SHORT : TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(values, {}, [axis](const Steps& v) { return v[axis]; });
    model.accessors[added].minValues.push_back(low[axis]);
    model.accessors[added].maxValues.push_back(high[axis]);
  }
  return added;
}

tinygltf::Value number(std::int64_t value) { return tinygltf::Value(static_cast<int>(value)); }

tinygltf::Value describe(const TileId& tile, const LatticePoint& origin) {
  tinygltf::Value::Object own;
  own["level"] = number(tile.level);
  own["x"] = number(tile.x);
  own["y"] = number(tile.y);
  own["origin"] =
      tinygltf::Value(tinygltf::Value::Array{number(origin.i), number(origin.j), number(origin.k)});
  tinygltf::Value::Object extras;
  extras["terrane"] = tinygltf::Value(own);
  return tinygltf::Value(extras);
}

void add_node(tinygltf::Model& model, const LatticePoint& origin, const Eigen::Vector3d& step_m) {
  tinygltf::Node node;
  node.mesh = 0;
  node.scale = {step_m.x(), step_m.z(), step_m.y()};
  node.translation = {static_cast<double>(origin.i) * step_m.x(),
                      static_cast<double>(origin.k) * step_m.z(),
                      static_cast<double>(-origin.j) * step_m.y()};
  model.nodes.push_back(node);
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;
}

void add_material(tinygltf::Model& model) {
  tinygltf::Material material;
  material.pbrMetallicRoughness.baseColorFactor = {0.62, 0.6, 0.55, 1};
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 1;
  model.materials.push_back(material);
}

tinygltf::Model model_of(const TileId& tile, const Attributes& attributes, Buffers& buffers,
                         const Eigen::Vector3d& step_m) {
  const std::size_t vertices = attributes.positions.size();
  const bool is_small = vertices <= 65535;
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "terrane";
  model.extensionsUsed = model.extensionsRequired = {kQuantization, kMeshopt};
  add_node(model, attributes.origin, step_m);
  add_material(model);

  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = 0;
  const int position = add_steps(model, buffers, attributes.positions);
  const int morph = add_steps(model, buffers, attributes.morphs);
  const int normal = add_accessor(model, buffers.add_vertices(attributes.normals), vertices,
                                  TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_TYPE_VEC3);
  model.accessors[normal].normalized = true;
  primitive.indices = add_accessor(
      model, buffers.add_indices(attributes.indices, vertices, is_small ? 2 : 4),
      attributes.indices.size(),
      is_small ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
      TINYGLTF_TYPE_SCALAR);
  primitive.attributes = {{"POSITION", position}, {"NORMAL", normal}, {"_MORPH", morph}};
  primitive.targets = {{{"POSITION", morph}}};

  tinygltf::Mesh mesh;
  mesh.primitives = {primitive};
  mesh.weights = {0};
  mesh.extras = describe(tile, attributes.origin);
  model.meshes.push_back(mesh);
  return model;
}

void append_word(std::string& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  char raw[4];
  std::memcpy(raw, &word, 4);
  bytes.append(raw, 4);
}

std::string pack(std::string json, const std::string& binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  append_word(glb, 2);
  append_word(glb, 12 + 8 + json.size() + 8 + binary.size());
  append_word(glb, json.size());
  glb += "JSON" + json;
  append_word(glb, binary.size());
  glb += std::string("BIN\0", 4) + binary;
  return glb;
}

}  // namespace

std::string encode_glb(const TileId& tile, const TileMesh& mesh,
                       std::span<const LatticePoint> targets, const Eigen::Vector3d& step_m,
                       bool is_mirrored) {
  const Attributes attributes = arrange(tile, mesh, targets, step_m, is_mirrored);
  Buffers buffers;
  const tinygltf::Model model = model_of(tile, attributes, buffers, step_m);
  std::ostringstream text;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, /*prettyPrint=*/false,
                                              /*writeBinary=*/false);

  // tinygltf 2.7 knows neither extensions of buffer views nor a buffer that is not stored
  auto json = nlohmann::ordered_json::parse(text.str());
  json["bufferViews"] = buffers.views();
  nlohmann::ordered_json fallback{{"byteLength", buffers.fallback_bytes()}};
  fallback["extensions"][kMeshopt]["fallback"] = true;
  json["buffers"] = {{{"byteLength", buffers.bytes().size()}}, fallback};
  return pack(json.dump(), buffers.bytes());
}

}  // namespace terrane::tiler
