#pragma once

#include <map>

#include "tiler/verify/sample_block.h"
#include "tiler/verify/sample_tally.h"
#include "tiler/verify/tile_examination.h"
#include "tiler/verify/water_triangles.h"

namespace terrane::verify {

/// Judges the samples of one leaf block against the tiles above it, at every level and time.
/// Thread-safe.
///
/// \param open  examined tiles, with those above the block and their siblings.
BlockFindings judge_block(const SampleBlock& block, const Output& output, const WaterJudge& water,
                          const std::map<TileKey, TileFindings>& open);

}  // namespace terrane::verify
