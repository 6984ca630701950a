#pragma once

#include "core/height_statistics.h"
#include "core/progress.h"
#include "ingest/dem.h"

namespace terrane::ingest {

/// Reads every sample once, block by block, in bounded memory.
///
/// The fingerprint hashes the shape, the affine placement, the CRS's WKT and the bits of all
/// heights in metres (every "no data" alike). It does not depend on the blocks it was read in.
///
/// \throws InputError if no sample holds a height; if samples hold a value that usually means "no
///         data" but is not declared so (-32767, -32768, -9999, -3.4e38 and beyond): the message
///         has their number and the option to use; if the file cannot be read.
HeightStatistics scan_heights(const Dem& dem, Progress& progress);

}  // namespace terrane::ingest
