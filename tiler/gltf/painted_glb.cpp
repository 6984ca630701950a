#include "tiler/gltf/painted_glb.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "tiler/gltf/glb_buffers.h"
#include "tiler/gltf/pack_glb.h"

namespace terrane::tiler {
namespace {

using Eigen::Vector3d;
using nlohmann::ordered_json;
using Float3 = std::array<float, 3>;
using Triangles = std::vector<std::array<Vector3d, 3>>;

Vector3d middle_of(const Triangles& triangles) {
  Vector3d low = triangles.front()[0], high = low;
  for (const auto& triangle : triangles) {
    for (const Vector3d& p : triangle) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  return (low + high) / 2;
}

/// glTF's colours are linear.
ordered_json linear(const std::string& colour) {
  ordered_json factor = ordered_json::array();
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::stoi(colour.substr(1 + 2 * k, 2), nullptr, 16) / 255.0;
    factor.push_back(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  factor.push_back(1);
  return factor;
}

ordered_json material_of(const GlbPaint& paint) {
  return {
      {"name", paint.name},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", linear(paint.colour)}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
      {"doubleSided", true},
      {"extensions", {{"KHR_materials_unlit", ordered_json::object()}}}};
}

/// The triangles of one paint, corners joined.
class Primitive {
 public:
  void add(const std::array<Vector3d, 3>& triangle, const Vector3d& middle) {
    std::array<std::uint32_t, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p = triangle[k] - middle;
      corner[k] = number_of(
          {static_cast<float>(p.x()), static_cast<float>(p.z()), static_cast<float>(-p.y())});
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) return;
    indices_.insert(indices_.end(), corner.begin(), corner.end());
  }

  bool is_empty() const { return indices_.empty(); }

  ordered_json write(GlbBuffers& buffers, std::size_t material) const {
    GlbValues values{.count = vertices_.size(), .stride = sizeof(Float3)};
    values.low.assign(3, vertices_.front()[0]);
    values.bytes.resize(vertices_.size() * sizeof(Float3));
    std::memcpy(values.bytes.data(), vertices_.data(), values.bytes.size());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::ranges::minmax(vertices_, {}, [k](const Float3& v) { return v[k]; });
      values.low[k] = low[k];
      values.high.push_back(high[k]);
    }
    const int positions = buffers.add_vertices(values);
    return {{"attributes", {{"POSITION", positions}}},
            {"indices", buffers.add_triangles(indices_, vertices_.size())},
            {"material", material}};
  }

 private:
  std::uint32_t number_of(const Float3& p) {
    const auto [at, is_new] = numbers_.try_emplace(p, static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) vertices_.push_back(p);
    return at->second;
  }

  std::map<Float3, std::uint32_t> numbers_;
  std::vector<Float3> vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

std::string encode_painted_glb(const Triangles& triangles,
                               const std::vector<std::uint8_t>& paint_of,
                               const std::vector<GlbPaint>& paints) {
  ordered_json json{{"asset", {{"version", "2.0"}, {"generator", TERRANE_GENERATOR}}}};
  const Vector3d middle = triangles.empty() ? Vector3d::Zero() : middle_of(triangles);
  std::vector<Primitive> primitives(paints.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    primitives[paint_of[t]].add(triangles[t], middle);
  }
  GlbBuffers buffers(false);
  ordered_json list = ordered_json::array(), materials = ordered_json::array();
  for (std::size_t k = 0; k < paints.size(); ++k) {
    if (primitives[k].is_empty()) continue;
    list.push_back(primitives[k].write(buffers, materials.size()));
    materials.push_back(material_of(paints[k]));
  }
  json["scene"] = 0;
  if (list.empty()) {
    json["scenes"] = {ordered_json::object()};
    return pack_glb(json.dump(), {});
  }
  json["extensionsUsed"] = {"KHR_materials_unlit"};
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}, {"translation", {middle.x(), middle.z(), -middle.y()}}}};
  json["meshes"] = {{{"primitives", list}}};
  json["materials"] = materials;
  json["accessors"] = buffers.accessors();
  json["bufferViews"] = buffers.views();
  json["buffers"] = buffers.buffers();
  return pack_glb(json.dump(), buffers.bytes());
}

}  // namespace terrane::tiler
