#pragma once

#include <filesystem>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/terrain_report.h"
#include "tiler/verify/undulation.h"
#include "tiler/verify/verify.h"

namespace terrane::verify {

/// Checks what `terrane build --scheme geodetic` wrote against the DEM that it was built from.
///
/// Reads the files and the DEM only and shares no code with the builder. A damaged tile is a fault
/// in the report and does not end it.
///
/// \param folder      the OUT of `terrane build`, with quantized-mesh tiles or 3D Tiles terrain.
/// \param heights     the DEM; the caller has compared its fingerprint.
/// \param undulation  what was added to its heights.
/// \throws InputError if a listing (layer.json, or tileset.json and subtrees) or terrane.json is
///         missing or damaged (names it).
TerrainReport verify_terrain(const std::filesystem::path& folder, const HeightSource& heights,
                             const Georeference& place, const Undulation& undulation,
                             const VerifyOptions& options, Progress& progress);

}  // namespace terrane::verify
