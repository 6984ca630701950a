#include "hierarchy/levels/write_surface.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace terrane::hierarchy {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

template <class T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

// OpenMesh writes floats: half a metre of rounding in the coordinates of a national grid
std::string encode_ply(const SurfaceMesh& mesh, std::span<const Eigen::Vector3d> targets) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment terrane\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n",
      mesh.points.size());
  if (!targets.empty()) {
    bytes += "property double target_x\nproperty double target_y\nproperty double target_z\n";
  }
  if (!mesh.colours.empty()) {
    bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                       mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    for (const double c : mesh.points[v]) append(bytes, c);
    if (!targets.empty()) {
      for (const double c : targets[v]) append(bytes, c);
    }
    if (!mesh.colours.empty()) append(bytes, mesh.colours[v]);
  }
  for (const Corners& corners : mesh.triangles) {
    bytes += '\3';
    for (const std::uint32_t v : corners) append(bytes, v);
  }
  return bytes;
}

std::string encode_obj(const SurfaceMesh& mesh) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# terrane\n");
  for (const Eigen::Vector3d& p : mesh.points) {
    fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return fmt::to_string(text);
}

}  // namespace terrane::hierarchy
