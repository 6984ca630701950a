#pragma once

#include "hierarchy/volume/interface_surface.h"
#include "hierarchy/volume/tetra_geometry.h"

namespace terrane::hierarchy::volume {

/// Upper bound of the distance from any point of a piece to a surface: of the approximation of an
/// interface, to the interface.
///
/// The distance to one triangle is convex: where all corners of a part of the piece are near the
/// same triangle, so is the part. Parts that are not are quartered, some times.
///
/// \param piece  may be empty: 0.
/// \param good_enough  a bound up to this one is not made tighter. A result above it can be that of
///                     a single corner.
double largest_distance(const ZeroSet& piece, const InterfaceSurface& surface, double good_enough);

}  // namespace terrane::hierarchy::volume
