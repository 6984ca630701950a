#include "hierarchy/volume/section.h"

#include <algorithm>

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

std::array<double, 4> heights(const TetraCorners& corners, const Plane& plane) {
  std::array<double, 4> heights;
  for (int k = 0; k < 4; ++k) heights[k] = plane.normal.dot(corners[k]) - plane.offset;
  return heights;
}

TetraCorners place(const SubTetra& weights, const TetraCorners& cell) {
  TetraCorners at;
  for (int k = 0; k < 4; ++k) {
    at[k].setZero();
    for (int c = 0; c < 4; ++c) at[k] += weights(c, k) * cell[c];
  }
  return at;
}

bool is_cut(const std::array<double, 4>& heights) {
  const auto [low, high] = std::ranges::minmax(heights);
  return low < 0 && high >= 0;  // a face in the plane belongs to the cell below it
}

}  // namespace

std::vector<SectionTriangle> cut_section(const MaterialVolume& volume, const Plane& plane) {
  std::vector<SectionTriangle> triangles;
  for (const CellId leaf : volume.mesh().leaves_in_tree_order()) {
    const TetraCorners cell = volume.corners(leaf);
    if (!is_cut(heights(cell, plane))) continue;
    const Barycentric shape(cell);
    for (const Piece& piece : volume.pieces(leaf)) {
      const TetraCorners at = place(piece.weights, cell);
      if (!is_cut(heights(at, plane))) continue;
      const ZeroSet polygon = zero_set(at, heights(at, plane));
      for (int k = 1; k + 1 < polygon.size; ++k) {
        SectionTriangle triangle{{polygon.points[0], polygon.points[k], polygon.points[k + 1]},
                                 piece.material,
                                 leaf,
                                 {}};
        for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
          const Vector4d values = volume.values(leaf, FieldId{f}, piece.material);
          auto& at_points = triangle.values.emplace_back();
          for (int c = 0; c < 3; ++c) {
            at_points[c] = shape.weights(triangle.points[c]).dot(values);
          }
        }
        triangles.push_back(std::move(triangle));
      }
    }
  }
  return triangles;
}

std::vector<std::array<Vector3d, 2>> cut_mesh(const MaterialVolume& volume, const Plane& plane) {
  std::vector<std::array<Vector3d, 2>> lines;
  for (const CellId leaf : volume.mesh().leaves_in_tree_order()) {
    const TetraCorners cell = volume.corners(leaf);
    if (!is_cut(heights(cell, plane))) continue;
    const ZeroSet polygon = zero_set(cell, heights(cell, plane));
    for (int k = 0; k < polygon.size; ++k) {
      lines.push_back({polygon.points[k], polygon.points[(k + 1) % polygon.size]});
    }
  }
  return lines;
}

std::vector<std::array<Vector3d, 3>> interface_triangles(const MaterialVolume& volume,
                                                         InterfaceId interface) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const CellId leaf : volume.mesh().leaves_in_tree_order()) {
    const ZeroSet piece = volume.approximation(leaf, interface);
    for (int k = 1; k + 1 < piece.size; ++k) {
      triangles.push_back({piece.points[0], piece.points[k], piece.points[k + 1]});
    }
  }
  return triangles;
}

}  // namespace terrane::hierarchy::volume
