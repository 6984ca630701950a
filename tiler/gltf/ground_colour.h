#pragma once

#include "core/height_statistics.h"
#include "tiler/gltf/glb_values.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tile_format.h"

namespace terrane::tiler {

/// The colour of a vertex (linear red, green, blue, and an alpha of 255), a function of height or
/// slope alone, so that neighbours agree.
///
/// \param heights  their range is that of the hypsometric colours.
Colour4 colour_of(Colour colour, const Ground& ground, const HeightStatistics& heights);

}  // namespace terrane::tiler
