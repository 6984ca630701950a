#pragma once

#include <array>
#include <vector>

#include "hierarchy/volume/field.h"

namespace terrane::hierarchy::volume {

/// What the error of a field over a cell is taken over.
enum class DeviationRule {
  kEverywhere,   ///< all places: a bound of the trilinear function (default)
  kNativePoints  ///< the posts of the grid that lie in the cell: as published
};

/// A rectilinear grid of values for each material, trilinear in between, level beyond its ends.
class GridField : public Field {
 public:
  /// \param axes    places of the posts along x, y and z, rising; at least two each.
  /// \param values  for each material one value per post, x fastest, then y; an empty list for a
  ///                material takes that of the first.
  /// \throws InputError if a count does not fit, an axis does not rise, or a value is no number
  ///         (says which post).
  GridField(std::array<std::vector<double>, 3> axes, std::vector<std::vector<double>> values,
            DeviationRule rule = DeviationRule::kEverywhere);

  double value(const Eigen::Vector3d& p, MaterialId material) const override;
  double largest_deviation(const LinearCell& approximation, MaterialId material,
                           const MayHold& may_hold, double good_enough) const override;

  const std::array<std::vector<double>, 3>& axes() const { return axes_; }

 private:
  struct GridCell;

  std::size_t interval(int axis, double x) const;
  double post(MaterialId material, std::size_t i, std::size_t j, std::size_t k) const;
  double deviation_at_posts(const LinearCell& approximation, MaterialId material,
                            const MayHold& may_hold) const;
  double deviation_in_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                          const LinearCell& approximation, const Barycentric& cell,
                          MaterialId material, const MayHold& may_hold, double good_enough,
                          int depth) const;

  std::array<std::vector<double>, 3> axes_;
  std::vector<std::vector<double>> values_;
  DeviationRule rule_;
};

}  // namespace terrane::hierarchy::volume
