#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/picture_set.h"

namespace terrane::verify {

/// What the DEM says of the finest zoom.
struct PictureErrors {
  std::int64_t pixels = 0;
  double max_m = 0, square_sum_m2 = 0;
  std::int64_t off = 0;     ///< outside what the samples around them allow
  std::string worst_place;  ///< of those, the farthest: tile, pixel and heights; empty: none
};

/// Compares each pixel of the finest zoom whose middle lies in a cell of the DEM that has its four
/// heights: with the bilinear height there, and with the lowest and the highest sample around it.
/// Any mean with weights from 0 to 1 lies between those.
///
/// In memory are the tiles around one strip of the DEM.
PictureErrors measure_pictures(const PictureSet& set, const HeightSource& heights,
                               const Georeference& place, Progress& progress);

}  // namespace terrane::verify
