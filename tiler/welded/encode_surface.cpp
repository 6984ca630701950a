#include "tiler/welded/encode_surface.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <iterator>

namespace terrane::welded {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as it lies");

std::string describe(const LevelMesh& mesh) {
  const Origin& origin = mesh.origin;
  const std::string place = origin.is_local
                                ? fmt::format("x {} y {} of the DEM", origin.x_m, origin.y_m)
                                : fmt::format("longitude {} latitude {} ellipsoidal height 0",
                                              origin.longitude_deg, origin.latitude_deg);
  return fmt::format(
      "terrane level {}, error at most {} m; x east, y north, z up in metres from {}", mesh.level,
      mesh.max_error_m, place);
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

std::string encode_obj(const LevelMesh& mesh) {
  std::string text = fmt::format("# {}\n", describe(mesh));
  auto end = std::back_inserter(text);
  for (const auto& [x, y, z] : mesh.surface.positions) {
    fmt::format_to(end, "v {} {} {}\n", x, y, z);
  }
  for (const auto& [a, b, c] : mesh.surface.triangles) {
    fmt::format_to(end, "f {} {} {}\n", std::uint64_t{a} + 1, std::uint64_t{b} + 1,
                   std::uint64_t{c} + 1);
  }
  return text;
}

std::string encode_ply(const LevelMesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      describe(mesh), mesh.surface.positions.size(), mesh.surface.triangles.size());
  for (const Position& position : mesh.surface.positions) append(bytes, position);
  for (const Triangle& triangle : mesh.surface.triangles) {
    append(bytes, std::uint8_t{3});
    append(bytes, triangle);
  }
  return bytes;
}

}  // namespace terrane::welded
