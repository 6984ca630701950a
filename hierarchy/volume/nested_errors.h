#pragma once

#include <vector>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

/// Errors of all cells of the tree, none smaller than one of its children's.
///
/// A leaf has its own errors. An inner cell's field error adds to the larger of its children's what
/// its own function misses at the vertex that split it: a bound on its distance to the data and to
/// every approximation in between. Its interface error is the largest below it and its own.
///
/// \par Source
/// Gregorski et al. 2003, section 7, equations (1) and (2).
class NestedErrors {
 public:
  /// Takes time proportional to the number of cells.
  explicit NestedErrors(const MaterialVolume& volume);

  double interface_error(CellId cell, InterfaceId interface) const {
    return interface_[index(cell) * interfaces_ + index(interface)];
  }
  double field_error(CellId cell, FieldId field) const {
    return field_[index(cell) * fields_ + index(field)];
  }

 private:
  void nest(const MaterialVolume& volume, CellId cell);

  std::size_t interfaces_, fields_;
  std::vector<double> interface_, field_;  ///< by cell
};

}  // namespace terrane::hierarchy::volume
