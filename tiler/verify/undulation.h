#pragma once

#include <functional>

#include "core/georeference.h"

namespace terrane::verify {

/// How high the surface that a DEM's heights are over lies above the ellipsoid, in metres.
using Undulation = std::function<double(const LonLat&)>;

}  // namespace terrane::verify
