#pragma once

#include <string>
#include <vector>

#include "tiler/welded/level_mesh.h"

namespace terrane::welded {

/// Wavefront OBJ: text, x east, y north, z up in metres, every digit; the origin in a comment.
std::string encode_obj(const LevelMesh& mesh);

/// Stanford PLY: the same numbers as binary little-endian doubles.
std::string encode_ply(const LevelMesh& mesh);

/// Binary glTF 2.0, y up, with normals; uncompressed, no required extensions. Positions are floats
/// about the middle of the mesh, whose place is the node's translation.
///
/// \param levels  finest first. One mesh and node each; with several, the first node's MSFT_lod
/// names
///                the others, with MSFT_screencoverage for 2 pixels of error on 1,080 lines.
/// \pre levels is not empty
/// \throws OutputError if it would be larger than 4 GiB, the most a glb can be.
std::string encode_glb(const std::vector<LevelMesh>& levels);

}  // namespace terrane::welded
