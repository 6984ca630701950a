#include "tiler/gltf/write_morphing_glb.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <vector>

namespace terrane::tiler {
namespace {

using Float3 = std::array<float, 3>;

Float3 y_up(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.z()), static_cast<float>(-v.y())};
}

Eigen::Vector3d middle_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d low = points.front(), high = low;
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (low + high) / 2;
}

/// Appends values as a buffer view and an accessor over all of it.
template <class T>
int add_accessor(tinygltf::Model& model, const T* values, std::size_t count, int target,
                 int component, int type) {
  auto& bytes = model.buffers.front().data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = count * sizeof(T);
  view.target = target;
  bytes.resize(bytes.size() + view.byteLength);
  std::memcpy(bytes.data() + view.byteOffset, values, view.byteLength);
  model.bufferViews.push_back(view);

  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count * sizeof(T) / (type == TINYGLTF_TYPE_VEC3 ? sizeof(Float3) : sizeof(T));
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int add_vectors(tinygltf::Model& model, const std::vector<Float3>& values) {
  const int added = add_accessor(model, values.data(), values.size(), TINYGLTF_TARGET_ARRAY_BUFFER,
                                 TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  auto& accessor = model.accessors.back();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(values, {}, [axis](const Float3& v) { return v[axis]; });
    accessor.minValues.push_back(low[axis]);
    accessor.maxValues.push_back(high[axis]);
  }
  return added;
}

void add_scene(tinygltf::Model& model, const Eigen::Vector3d& middle) {
  tinygltf::Node node;
  node.mesh = 0;
  node.translation = {middle.x(), middle.z(), -middle.y()};
  model.nodes.push_back(node);
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;
}

}  // namespace

std::string encode_morphing_glb(std::span<const Eigen::Vector3d> points,
                                std::span<const Eigen::Vector3d> targets,
                                std::span<const std::array<std::uint32_t, 3>> triangles) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "terrane";
  model.buffers.emplace_back();
  const Eigen::Vector3d middle = middle_of(points);
  std::vector<Float3> positions, morphs;
  for (const Eigen::Vector3d& p : points) positions.push_back(y_up(p - middle));
  for (std::size_t v = 0; v < targets.size(); ++v) morphs.push_back(y_up(targets[v] - points[v]));
  std::vector<std::uint32_t> indices;
  for (const auto& corners : triangles) {
    indices.insert(indices.end(), corners.begin(), corners.end());
  }

  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = add_vectors(model, positions);
  if (!morphs.empty()) primitive.targets = {{{"POSITION", add_vectors(model, morphs)}}};
  primitive.indices =
      add_accessor(model, indices.data(), indices.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
  tinygltf::Mesh mesh;
  mesh.primitives = {primitive};
  if (!morphs.empty()) mesh.weights = {0};
  model.meshes.push_back(mesh);
  add_scene(model, middle);

  std::ostringstream stream;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, /*prettyPrint=*/false,
                                              /*writeBinary=*/true);
  return std::move(stream).str();
}

}  // namespace terrane::tiler
