#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace terrane::hierarchy::volume {

/// Number of an interface, a material, a field in its list.
enum class InterfaceId : std::uint8_t {};
enum class MaterialId : std::uint8_t {};
enum class FieldId : std::uint8_t {};

constexpr std::size_t index(InterfaceId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(MaterialId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(FieldId id) { return static_cast<std::size_t>(id); }

/// Several of up to 32 things, one bit each.
using Mask = std::uint32_t;

/// Which side of an interface a material lies on.
struct Side {
  InterfaceId interface {};
  bool is_below = true;
};

/// What fills a part of space.
struct Material {
  std::string name;
  std::vector<Side> where;  ///< all have to hold; empty: everywhere
  /// Holds nothing: its fields are constant and of no interest, so it costs no cells.
  bool is_empty = false;
};

/// The first material whose sides all hold.
/// \param below  bit i: the place is below interface i.
/// \pre some material fits: the last one lies everywhere.
MaterialId material_at(const std::vector<Material>& materials, Mask below);

/// Materials that a region can hold.
/// \param below  sides that are known; \param open  interfaces whose side is not.
Mask possible_materials(const std::vector<Material>& materials, Mask below, Mask open);

/// Of the open interfaces those that part two materials somewhere in such a region.
Mask parting_interfaces(const std::vector<Material>& materials, Mask below, Mask open);

}  // namespace terrane::hierarchy::volume
