#pragma once

#include <filesystem>

#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// Reads a mesh from an OBJ, PLY, OFF or STL file (through OpenMesh), as it is.
///
/// Faces with more than three corners become fans of triangles. STL files repeat their vertices:
/// equal ones are joined. Colours of vertices are kept (white where one has none); normals and
/// textures are ignored.
/// \throws InputError if the file cannot be read, or holds no face.
SurfaceMesh read_surface(const std::filesystem::path& file);

/// Has the file's name an extension that read_surface() knows?
bool is_surface_file(const std::filesystem::path& file);

}  // namespace terrane::hierarchy
