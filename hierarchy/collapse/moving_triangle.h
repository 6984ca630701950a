#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// A triangle whose corners move on straight lines, all in the same time t = 0 ... 1.
///
/// Under it, a sample sees a height that is a cubic over a quadratic in t: so whether it is ever
/// too far off is decided for all t at once, by the signs of Bernstein coefficients, and not at
/// some values of t.
class MovingTriangle {
 public:
  /// \param from, to  the corners at t = 0 and t = 1, counter-clockwise with rows downward; at
  ///                  t = 0 the triangle has an area in plan.
  /// \param slack_cells  samples this near to it at t = 0 count as under it.
  MovingTriangle(const std::array<FieldPoint, 3>& from, const std::array<FieldPoint, 3>& to,
                 double slack_cells);

  /// Is it within the tolerance of the sample at all t at which the sample is under it?
  ///
  /// What lasts less than 1 / 1024 of the time, as a sample leaves the triangle or comes under it,
  /// is left to the triangle on the other side of the edge.
  bool stays_within(const FieldSample& sample, double tolerance_m) const {
    return stays_within(sample, tolerance_m, slack_);
  }

  /// The same for all samples of a field, those behind it if it is backed.
  bool stays_within(const SampleField& field, double tolerance_m) const {
    return !find_left(field, tolerance_m);
  }

  /// A sample of a field that it does not stay within the tolerance of, of those behind it if it is
  /// backed; where there are slabs alone, a height that they let a sample have. None if it stays.
  std::optional<FieldSample> find_left(const SampleField& field, double tolerance_m) const;

  /// Does it move, and is too far from a sample that is under it, not only nearly so? If the
  /// sample is of a field, stays_within() does not hold for that then.
  bool surely_leaves(const FieldSample& sample, double tolerance_m) const {
    return from_ != to_ && !stays_within(sample, tolerance_m, 0);
  }

 private:
  class Sweep;

  bool stays_within(const FieldSample& sample, double tolerance_m, double slack) const;
  std::optional<FieldSample> find_left_of_all(std::span<const FieldPoint> hull,
                                              const SampleField& field, double tolerance_m) const;

  /// Twice the area between the sample and an edge, at times that do not matter here: affine.
  struct Affine {
    double constant, per_column, per_row;
    double at(double column, double row) const {
      return constant + column * per_column + row * per_row;
    }
  };

  /// Is a height within the tolerance of those of all corners at both ends? Then it is of all that
  /// lies between them.
  bool is_near_all_corners(double height_m, double tolerance_m) const;

  /// Corners that are in one place at t = 1: 0, 2 or 3.
  int meeting_corners() const;

  std::array<FieldPoint, 3> from_, to_;
  double lowest_m_ = std::numeric_limits<double>::infinity();  // of the corners at both ends
  double highest_m_ = -std::numeric_limits<double>::infinity();
  /// Bernstein coefficients of the area opposite corner k over a sample, see from_[0]
  std::array<std::array<Affine, 3>, 3> areas_;
  std::array<double, 3> whole_;  // those of the whole area
  double slack_;                 // as a share of the whole area
};

}  // namespace terrane::hierarchy
