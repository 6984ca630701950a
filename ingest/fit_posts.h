#pragma once

#include "core/geodetic_grid.h"
#include "ingest/dem_samples.h"

class GDALRasterBand;

namespace terrane::ingest {

/// Moves posts up and down, as little as possible, until the surface between them (post_surface.h)
/// is nearer than \p wanted_m to the samples that it was made from. Interpolation alone cuts off
/// summits and fills in valleys between the posts.
///
/// Ends after a few passes; where posts are farther apart than samples, it may not get so far.
///
/// \param band   the posts' heights, none NaN near the samples.
/// \param posts  that the band holds; once round the Earth, the last column is the first one.
/// \throws InputError if the band cannot be read or written.
/// \par Source
/// Projections onto convex sets: Kaczmarz 1937; for bounds on both sides, Gordon et al. 1970
/// (ART3).
void fit_posts(GDALRasterBand& band, const Window& posts, const DemSamples& samples, int zoom,
               double wanted_m);

}  // namespace terrane::ingest
