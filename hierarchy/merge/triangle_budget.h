#pragma once

#include <cstdint>

#include "hierarchy/merge/merge_front.h"

namespace terrane::hierarchy {

/// Finds the tolerance that shows a number of triangles, by feedback from frame to frame.
class TriangleBudget {
 public:
  /// \param triangles     1 or more.
  /// \param tolerance_px  to begin with.
  explicit TriangleBudget(std::uint32_t triangles, double tolerance_px = 1)
      : triangles_(triangles), tolerance_px_(tolerance_px) {}

  double tolerance_px() const { return tolerance_px_; }
  /// Corrects the tolerance by how many triangles it showed; they go roughly with its inverse.
  void correct(std::uint32_t shown);

 private:
  std::uint32_t triangles_;
  double tolerance_px_;
};

/// Shows the finest mesh of at most so many triangles, to 1 % of the tolerance; or the coarsest
/// that the view allows, which is full where the camera is within what it looks at.
///
/// For single pictures: it updates the front again and again.
/// \param criteria  its other thresholds keep their ratio to the tolerance.
/// \return the tolerance, in pixels.
double settle_on(std::uint32_t triangles, const MergeTree& tree, const Camera& camera,
                 const ViewCriteria& criteria, MergeFront& front);

/// The criteria with all their thresholds scaled, so that the tolerance is this.
ViewCriteria at_tolerance(ViewCriteria criteria, double tolerance_px);

}  // namespace terrane::hierarchy
