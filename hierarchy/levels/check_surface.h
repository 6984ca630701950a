#pragma once

#include <string>

#include "core/progress.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// Makes a mesh fit for build_levels(), or refuses it.
///
/// Dropped, with a note: vertices that no triangle uses, triangles that repeat a corner, triangles
/// that are there twice. Said in a note, and kept: triangles without an area (they never collapse,
/// as they have no plane), several components (each is simplified like a mesh of its own).
/// \param name  what the mesh is called in messages.
/// \throws TopologyError, with the indices, if a vertex in use is not finite, an edge has more than
///         two triangles or two that run along it in the same direction, or no triangle is left.
SurfaceMesh check_surface(SurfaceMesh mesh, const std::string& name, Progress& progress);

}  // namespace terrane::hierarchy
