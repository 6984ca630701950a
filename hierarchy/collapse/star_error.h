#pragma once

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/star.h"

namespace terrane::hierarchy {

/// How far a star is, at most, from the samples under it.
struct StarError {
  double most_m = 0;         ///< no less than it is if it is over the tolerance
  CoveredSample worst = {};  ///< the sample that is, or as high or low as its slab lets it be
};

/// Of all samples behind a field, whether the star around a place holds them or not; or of their
/// slabs.
///
/// \param tolerance_m  up to which it does not matter how far.
/// \pre the polygon sees the place, and \p field is backed.
StarError error_of_star(const Star& star, const Place& centre, const SampleField& field,
                        double tolerance_m);

}  // namespace terrane::hierarchy
