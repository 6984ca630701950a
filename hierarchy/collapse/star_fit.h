#pragma once

#include <optional>
#include <span>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// One side of the boundary polygon that a star is built on, counter-clockwise.
struct StarSide {
  FieldPoint from;
  FieldPoint to;
};

/// The best height for the centre of a star.
struct StarHeight {
  double height_m = 0;  ///< least squares, moved into the feasible interval
  double lowest_m = 0;  ///< the feasible interval
  double highest_m = 0;
  double squared_error_m2 = 0;  ///< sum over the samples under the star, at height_m
};

/// Finds the heights of the centre for which the star stays within the tolerance of every sample
/// under it, and the best of them.
///
/// \param column, row  plan of the centre, in cells.
/// \param fallback_m   height to take where no sample lies under the star.
/// \return nothing if there is no such height.
std::optional<StarHeight> fit_star(double column, double row, std::span<const StarSide> sides,
                                   const SampleField& field, double tolerance_m, double fallback_m);

/// Is the triangle within the tolerance of every sample under it?
bool is_within(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
               const SampleField& field, double tolerance_m);

}  // namespace terrane::hierarchy
