#pragma once

#include <filesystem>
#include <string>

#include "hierarchy/volume/interface_surface.h"

namespace terrane::model {

/// Reads a triangle mesh (OBJ, PLY, OFF, STL): coordinates are metres of the model.
/// \throws InputError if the file cannot be read, or holds no triangles.
hierarchy::volume::SurfaceMesh read_mesh(const std::filesystem::path& file);

}  // namespace terrane::model
