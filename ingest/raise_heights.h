#pragma once

#include <memory>

#include "core/georeference.h"
#include "core/height_source.h"
#include "ingest/geoid.h"

namespace terrane::ingest {

/// Heights over a geoid as heights over the WGS84 ellipsoid.
///
/// The geoid is asked at samples at most about 1 km apart, always the same ones; between them it is
/// taken as linear along rows and columns, which EGM96 is to a centimetre or two.
///
/// \param place  of the heights; must outlive the result.
/// \pre place has a CRS.
std::unique_ptr<HeightSource> raise_heights(std::unique_ptr<HeightSource> heights,
                                            const Georeference& place,
                                            std::unique_ptr<Geoid> geoid);

}  // namespace terrane::ingest
