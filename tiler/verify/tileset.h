#pragma once

#include "tiler/verify/output.h"

namespace terrane::verify {

/// Reads tileset.json and all that it refers to - external tilesets, or subtrees - into the tiles
/// of \p output, whose tiling and levels are known.
///
/// What contradicts itself but can be read goes to output.contradictions.
/// \throws InputError that names the file if one is missing, damaged or outside the folder.
void read_tileset(Output& output);

}  // namespace terrane::verify
