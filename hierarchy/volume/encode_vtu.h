#pragma once

#include <string>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

/// The leaves as a VTK unstructured grid (XML, raw appended data, little endian): docs/formats.md.
///
/// Points hold signed distances and, for each field and material, values and ghost values; cells
/// hold their level, their material (-1: several) and their errors. In the order of the tree.
std::string encode_cells_vtu(const MaterialVolume& volume);

/// The pieces of one material each, cut along the approximations of the interfaces.
///
/// Points hold the fields of the piece's material, cells its number. Pieces share no points, since
/// fields jump between them.
std::string encode_materials_vtu(const MaterialVolume& volume);

}  // namespace terrane::hierarchy::volume
