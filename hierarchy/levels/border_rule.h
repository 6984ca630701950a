#pragma once

#include <cstdint>
#include <optional>

#include "hierarchy/levels/level_mesh.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// How a triangle lies to the border of its mesh. Type 4 (two corners on the border, or on two
/// borders, and no edge) has no complete stencil and does not come this far.
enum class BorderType : std::uint8_t {
  kInside = 0,
  kEdge = 1,    ///< type 1: one edge on the border
  kVertex = 2,  ///< type 2: one corner on the border
  kCorner = 3,  ///< type 3: two edges on the border
};

/// Where on the border a triangle goes.
struct BorderRule {
  BorderType type = BorderType::kInside;
  /// Number of the stencil's core vertex that the triangle collapses onto; nothing: inside the
  /// triangle, or for type 1 over the middle of its border edge.
  std::optional<std::uint32_t> onto;
  std::uint32_t side = 0;  ///< type 1: the border edge runs from core vertex side to the next one
};

/// Finds a triangle's boundary type and what it may do.
///
/// Rules::kTightened: a corner of the border never goes. On a height field a corner is where the
/// border is not exactly straight in plan, or where two fans of triangles meet; on other meshes
/// where it turns by more than 30 degrees.
/// \return nothing if the border would leave its place, or the triangle is all the mesh.
/// \pre \p stencil is complete.
/// \par Source
/// Gieng et al. 1998, section 4.4.
std::optional<BorderRule> border_rule(const LevelMesh& level, const Stencil& stencil, Rules rules);

}  // namespace terrane::hierarchy
