#pragma once

#include <filesystem>
#include <string>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::tiler {

enum class MeshFormat { kObj, kPly, kGlb };

/// By the file's extension: .obj, .ply or .glb, in small or capital letters.
/// \throws ConfigError that names the file and the known extensions, if it is none of them.
MeshFormat mesh_format_of(const std::filesystem::path& file);

/// Heights that the format holds exactly are multiples of 1 over this, in metres.
double height_steps_per_m(MeshFormat format);

/// Encodes a mesh over the grid of a DEM. Triangles are counter-clockwise seen from above.
///
/// - OBJ: text. x, y in the plane of the DEM's CRS (easting and northing, or longitude and
/// latitude;
///   sample centres), z metres; as many digits as a double needs, so that large coordinates
///   survive.
/// - PLY: the same numbers as binary doubles.
/// - glb: glTF 2.0 in local metres, x east, y up, z south, floats: the plane that touches the DEM's
///   map at its centre, so that straight lines of the grid stay straight. x and z are rounded to
///   2^-24 of the extent at most, heights are exact. Where the centre lies stands in the extras of
///   the node.
///
/// Feature lines are line elements (OBJ `l`, PLY `edge`, a second primitive of a glb).
/// \param shape  of the DEM that the mesh spans; plan is counted from its first sample.
/// \throws InputError if the centre of the DEM has no longitude and latitude (glb).
std::string encode_mesh(const hierarchy::TerrainMesh& mesh, MeshFormat format,
                        const Georeference& place, GridShape shape);

}  // namespace terrane::tiler
