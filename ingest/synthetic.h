#pragma once

#include <memory>
#include <string>

#include "ingest/dem.h"

namespace terrane::ingest {

/// Whether a source names a synthetic DEM: "synthetic:SHAPE?key=value&key=value".
bool is_synthetic(const std::string& source);

/// Opens a DEM that is computed, the same bits on every machine, with plain local metres for CRS.
///
/// | shape | heights |
/// |---|---|
/// | caldera | a ring of mountains over fractal hills; inside, a flat lake with an island |
/// | plane | 0.1 * metres east + 0.05 * metres north of sample (0, 0) |
/// | flat | height (100 m) |
///
/// | key | meaning |
/// |---|---|
/// | size | columns and rows, 2 to 100000 (513) |
/// | columns, rows | each on its own, instead of size |
/// | spacing | metres between samples, above 0 (10) |
/// | seed | any whole number from 0: other hills (caldera), other holes (1) |
/// | holes | number of round holes of "no data" (0) |
///
/// \throws InputError for an unknown shape or key, or a value out of range.
std::unique_ptr<Dem> open_synthetic_dem(const std::string& source);

}  // namespace terrane::ingest
