#pragma once

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/star.h"

namespace terrane::hierarchy {

/// How far the star around a place is, at most, from the samples of a field under it: from all of
/// them, whether the star holds them or not.
///
/// \param[out] worst  the sample that it is farthest from; left as it is if there is none.
/// \return metres, no less than it is; next to 0 where no sample is under the star.
/// \pre the polygon sees the place, and \p field has all samples behind it.
double worst_under_star(const Star& star, const Place& centre, const SampleField& field,
                        CoveredSample& worst);

}  // namespace terrane::hierarchy
