#include "hierarchy/volume/material.h"

#include <algorithm>

namespace terrane::hierarchy::volume {
namespace {

Mask bit(std::size_t k) { return Mask{1} << k; }

// Calls f with every choice of sides for the open interfaces.
template <class F>
void for_each_choice(Mask below, Mask open, F&& f) {
  Mask choice = 0;
  do {
    f((below & ~open) | choice);
    choice = (choice - open) & open;  // the next subset of open
  } while (choice != 0);
}

}  // namespace

MaterialId material_at(const std::vector<Material>& materials, Mask below) {
  for (std::size_t m = 0; m + 1 < materials.size(); ++m) {
    const bool fits = std::ranges::all_of(materials[m].where, [&](const Side& side) {
      return ((below & bit(index(side.interface))) != 0) == side.is_below;
    });
    if (fits) return MaterialId{static_cast<std::uint8_t>(m)};
  }
  return MaterialId{static_cast<std::uint8_t>(materials.size() - 1)};
}

Mask possible_materials(const std::vector<Material>& materials, Mask below, Mask open) {
  Mask found = 0;
  for_each_choice(below, open,
                  [&](Mask sides) { found |= bit(index(material_at(materials, sides))); });
  return found;
}

Mask parting_interfaces(const std::vector<Material>& materials, Mask below, Mask open) {
  Mask found = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    if ((open & bit(i)) == 0) continue;
    for_each_choice(below, open & ~bit(i), [&](Mask sides) {
      if (material_at(materials, sides & ~bit(i)) != material_at(materials, sides | bit(i))) {
        found |= bit(i);
      }
    });
  }
  return found;
}

}  // namespace terrane::hierarchy::volume
