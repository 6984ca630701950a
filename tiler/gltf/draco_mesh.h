#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tiler/gltf/glb_arrays.h"

namespace terrane::tiler {

/// A primitive as KHR_draco_mesh_compression stores it.
struct DracoMesh {
  std::string bytes;
  std::size_t vertices = 0;  ///< may be more than went in: Draco splits some
  /// What the accessors describe, with names of glTF attributes; the place in the list is Draco's
  /// id of each.
  std::vector<std::pair<std::string, GlbValues>> attributes;
};

/// Compresses the triangles on land, or those in water. Positions and displacements come out to the
/// bit as they went in; normals and texture coordinates as floats, rounded to 8 and 14 bits.
///
/// \pre there are some, and they use every vertex.
/// \throws OutputError if Draco cannot encode it.
DracoMesh encode_draco(const GlbArrays& arrays, bool is_water);

}  // namespace terrane::tiler
