#pragma once

#include "tiler/simplify.h"

namespace terrane::tiler {

/// Cells along a tile of simplify_in_tiles(): wide, so that seams cost little, and of a size of
/// which every thread can hold one.
inline constexpr std::int64_t kSimplifyTileCells = 512;

/// The mesh of simplify() for a DEM of any size: tile by tile, with the seams of level 0
/// (seams/build_seam.h), on all threads, and welded. It has somewhat more triangles than if done
/// at once; which, depends on the heights and options alone.
///
/// Memory: some tiles at a time (about 330 bytes a sample), and the result.
/// \param tolerance_m  instead of that of \p options.
/// \pre check_size() of tiler/dem_size.h holds; options are in range.
/// \throws ConfigError if the tolerance is finer than the heights are written; InputError if the
/// DEM
///         cannot be read.
hierarchy::TerrainMesh simplify_in_tiles(const HeightSource& heights,
                                         const SimplifyOptions& options, double tolerance_m,
                                         Progress& progress);

}  // namespace terrane::tiler
