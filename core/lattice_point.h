#pragma once

#include <compare>
#include <cstdint>

namespace terrane {

/// A written position: steps along east, north and up on the world lattice of its level.
struct LatticePoint {
  std::int64_t i = 0;
  std::int64_t j = 0;
  std::int64_t k = 0;

  auto operator<=>(const LatticePoint&) const = default;
};

}  // namespace terrane
