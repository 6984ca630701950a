#pragma once

#include <functional>

#include "tiler/welded/level_mesh.h"

namespace terrane::welded {

/// Keeps the part of a mesh where a function of the position is at least 0.
///
/// An edge is divided where the linear interpolation of the function is 0, at one vertex for all
/// its triangles: a mesh without gaps stays one. Vertices that are used no more are removed.
SurfaceMesh clip(const SurfaceMesh& mesh, const std::function<double(const Position&)>& inside);

}  // namespace terrane::welded
