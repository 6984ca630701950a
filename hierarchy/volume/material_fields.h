#pragma once

#include <memory>
#include <vector>

#include "hierarchy/volume/field.h"

namespace terrane::hierarchy::volume {

/// A quantity whose values in each material come from a field of its own: formula, raster, grid.
class MaterialFields : public Field {
 public:
  /// \pre one field for each material of the model.
  explicit MaterialFields(std::vector<std::shared_ptr<const Field>> of_material);

  double value(const Eigen::Vector3d& p, MaterialId material) const override;
  double largest_deviation(const LinearCell& approximation, MaterialId material,
                           const MayHold& may_hold, double good_enough) const override;

 private:
  std::vector<std::shared_ptr<const Field>> of_material_;
};

}  // namespace terrane::hierarchy::volume
