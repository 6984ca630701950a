#pragma once

#include <filesystem>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/report.h"
#include "tiler/verify/water_shores.h"

namespace terrane::verify {

struct VerifyOptions {
  int jobs = 0;  ///< threads; 0: one per core. The report does not depend on it.
  /// The water of the DEM: what tiles hold as water has to lie there, at its height, and no land.
  std::vector<WaterArea> water = {};
};

/// Checks what `terrane build` wrote against the DEM that it was built from.
///
/// Reads the files and the DEM only and shares no code with the builder. Heights are compared in
/// the world frame along the vertical of each sample. Memory does not grow with the DEM beyond two
/// bytes per sample on the border of a leaf tile and the entries of tileset.json.
///
/// \param folder   the OUT of `terrane build`.
/// \param heights  the DEM; the caller has compared its fingerprint.
/// \throws InputError if a file is missing or damaged (names it), or if the DEM has another shape.
VerifyReport verify(const std::filesystem::path& folder, const HeightSource& heights,
                    const Georeference& place, const VerifyOptions& options, Progress& progress);

}  // namespace terrane::verify
