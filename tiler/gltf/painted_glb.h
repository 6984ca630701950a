#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace terrane::tiler {

/// A material of a glb: its name, and its colour in sRGB as "#rrggbb".
struct GlbPaint {
  std::string name;
  std::string colour;
};

/// Triangles in flat colours as a binary glTF 2.0: one node, a primitive for each paint that is
/// used, seen from both sides and without light (KHR_materials_unlit).
///
/// Positions are floats in metres, x east, y up, z south, about the middle of the triangles, whose
/// place is the node's translation. Corners at the very same place become one vertex of a paint,
/// triangles without area are left out. Without any triangle the scene is empty.
///
/// \param triangles  corners east, north, up in metres.
/// \param paint_of   for each triangle an index into \p paints.
/// \throws OutputError if it would be larger than 4 GiB.
std::string encode_painted_glb(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles,
                               const std::vector<std::uint8_t>& paint_of,
                               const std::vector<GlbPaint>& paints);

}  // namespace terrane::tiler
