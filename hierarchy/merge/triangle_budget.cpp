#include "hierarchy/merge/triangle_budget.h"

#include <algorithm>
#include <cmath>

namespace terrane::hierarchy {
namespace {

// below and above, every mesh is the finest or the coarsest one
constexpr double kLeastPx = 1e-6, kMostPx = 1e9;

}  // namespace

void TriangleBudget::correct(std::uint32_t shown) {
  const double ratio = (shown + 1.0) / (triangles_ + 1.0);
  // a little less than the inverse proportion asks for, or it would swing
  const double factor = std::clamp(std::pow(ratio, 0.8), 0.25, 4.0);
  tolerance_px_ = std::clamp(tolerance_px_ * factor, kLeastPx, kMostPx);
}

ViewCriteria at_tolerance(ViewCriteria criteria, double tolerance_px) {
  const double factor = tolerance_px / criteria.tolerance_px;
  criteria.tolerance_px = tolerance_px;
  if (criteria.silhouette_px) *criteria.silhouette_px *= factor;
  if (criteria.highlight_px) *criteria.highlight_px *= factor;
  if (criteria.colour_px) *criteria.colour_px *= factor;
  return criteria;
}

double settle_on(std::uint32_t triangles, const MergeTree& tree, const Camera& camera,
                 const ViewCriteria& criteria, MergeFront& front) {
  const auto fits = [&](double tolerance_px) {
    front.update(ViewJudge(tree, camera, at_tolerance(criteria, tolerance_px)));
    return front.display().triangle_count() <= triangles;
  };
  double low = kLeastPx, high = kMostPx;  // high fits, if anything does
  while (high > low * 1.01) {
    const double middle = std::sqrt(low * high);
    (fits(middle) ? high : low) = middle;
  }
  fits(high);
  return high;
}

}  // namespace terrane::hierarchy
