#include "hierarchy/volume/nested_errors.h"

#include <algorithm>

namespace terrane::hierarchy::volume {

NestedErrors::NestedErrors(const MaterialVolume& volume)
    : interfaces_(volume.interface_count()),
      fields_(volume.field_count()),
      interface_(volume.mesh().cell_capacity() * interfaces_),
      field_(volume.mesh().cell_capacity() * fields_) {
  for (std::uint32_t root = 0; root < 6; ++root) nest(volume, CellId{root});
}

// The recursion is as deep as the tree: 90 levels at most.
void NestedErrors::nest(const MaterialVolume& volume, CellId cell) {
  const bool is_leaf = volume.mesh().is_leaf(cell);
  for (std::size_t i = 0; i < interfaces_; ++i) {
    const InterfaceId id{static_cast<std::uint8_t>(i)};
    interface_[index(cell) * interfaces_ + i] = volume.interface_error(cell, id);
  }
  for (std::size_t f = 0; f < fields_; ++f) {
    const FieldId id{static_cast<std::uint8_t>(f)};
    field_[index(cell) * fields_ + f] = is_leaf ? volume.field_error(cell, id) : 0;
  }
  if (is_leaf) return;
  for (const CellId child : volume.mesh().children(cell)) {
    nest(volume, child);
    for (std::size_t i = 0; i < interfaces_; ++i) {
      double& own = interface_[index(cell) * interfaces_ + i];
      own = std::max(own, interface_[index(child) * interfaces_ + i]);
    }
    for (std::size_t f = 0; f < fields_; ++f) {
      double& own = field_[index(cell) * fields_ + f];
      own = std::max(own, field_[index(child) * fields_ + f]);
    }
  }
  for (std::size_t f = 0; f < fields_; ++f) {
    field_[index(cell) * fields_ + f] +=
        volume.field_jump(cell, FieldId{static_cast<std::uint8_t>(f)});
  }
}

}  // namespace terrane::hierarchy::volume
