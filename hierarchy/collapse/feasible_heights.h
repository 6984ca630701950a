#pragma once

#include <limits>
#include <optional>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// The heights of a star's centre that keep it near the samples of a field, triangle by triangle,
/// in double precision. For the few stars of seams; StarJudge is for the many.
class FeasibleHeights {
 public:
  /// \param field  must outlive this.
  FeasibleHeights(const SampleField& field, double tolerance_m)
      : field_(field), tolerance_m_(tolerance_m) {}

  /// Takes in the samples under a triangle of the star; its height at \p centre does not count.
  /// \pre the triangle spans an area in plan.
  /// \return false if no height is left.
  bool add(const FieldPoint& centre, const FieldPoint& a, const FieldPoint& b);

  /// The height with the least squared error, moved away from the ends of the interval as in the
  /// collapse of tiles. None if no sample decides.
  /// \pre add() was true each time.
  std::optional<double> best_m() const;

 private:
  const SampleField& field_;
  double tolerance_m_;
  double lowest_m_ = -std::numeric_limits<double>::infinity();
  double highest_m_ = std::numeric_limits<double>::infinity();
  double weights_ = 0, weighted_m_ = 0;
};

}  // namespace terrane::hierarchy
