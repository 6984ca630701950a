#include "model/encode_ply.h"

#include <fmt/format.h>

#include <map>

namespace terrane::model {
namespace {

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

std::string encode_ply(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles,
                       const std::vector<std::uint8_t>& materials) {
  std::map<std::array<double, 3>, std::int32_t> numbers;
  std::string vertices, faces;
  std::size_t face_count = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::int32_t, 3> corner;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = triangles[t][k];
      const auto [at, is_new] =
          numbers.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::int32_t>(numbers.size()));
      corner[k] = at->second;
      if (!is_new) continue;
      for (const double coordinate : at->first) append(vertices, coordinate);
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    append(faces, std::uint8_t{3});
    for (const std::int32_t c : corner) append(faces, c);
    if (!materials.empty()) append(faces, materials[t]);
    ++face_count;
  }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
             "property double y\nproperty double z\nelement face {}\n"
             "property list uchar int vertex_indices\n{}end_header\n",
             numbers.size(), face_count, materials.empty() ? "" : "property uchar material\n") +
         vertices + faces;
}

}  // namespace terrane::model
