#include "hierarchy/volume/material_sums.h"

#include <Eigen/LU>
#include <cmath>

namespace terrane::hierarchy::volume {

std::vector<MaterialSum> sum_materials(const MaterialVolume& volume) {
  std::vector<MaterialSum> sums(volume.model().materials.size());
  for (MaterialSum& sum : sums) sum.integral.resize(volume.field_count());
  for (const CellId leaf : volume.mesh().leaves_in_tree_order()) {
    const double cell = Barycentric(volume.corners(leaf)).volume();
    for (const Piece& piece : volume.pieces(leaf)) {
      MaterialSum& sum = sums[index(piece.material)];
      const double part = cell * std::abs(piece.weights.determinant());
      sum.volume += part;
      for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
        // the mean of a linear function over a tetrahedron is that of its corners
        const Eigen::Vector4d values =
            piece.weights.transpose() * volume.values(leaf, FieldId{f}, piece.material);
        sum.integral[f] += part * values.mean();
      }
    }
  }
  return sums;
}

}  // namespace terrane::hierarchy::volume
