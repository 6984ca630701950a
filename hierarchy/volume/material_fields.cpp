#include "hierarchy/volume/material_fields.h"

namespace terrane::hierarchy::volume {

MaterialFields::MaterialFields(std::vector<std::shared_ptr<const Field>> of_material)
    : of_material_(std::move(of_material)) {}

double MaterialFields::value(const Eigen::Vector3d& p, MaterialId material) const {
  return of_material_[index(material)]->value(p, material);
}

double MaterialFields::largest_deviation(const LinearCell& approximation, MaterialId material,
                                         const MayHold& may_hold, double good_enough) const {
  return of_material_[index(material)]->largest_deviation(approximation, material, may_hold,
                                                          good_enough);
}

}  // namespace terrane::hierarchy::volume
