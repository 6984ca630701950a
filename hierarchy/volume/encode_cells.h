#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

/// Where an array lies in a file, and what it holds.
struct PlacedArray {
  std::string name;
  std::string type;            ///< float32, uint32 or uint8
  std::size_t components = 1;  ///< values of one item, side by side
  std::size_t count = 0;       ///< items
  std::size_t offset = 0;      ///< bytes from the beginning; a multiple of 4
};

struct EncodedCells {
  std::string bytes;
  std::vector<PlacedArray> arrays;
};

/// The leaves as plain little-endian arrays, for a page that cuts them (docs/formats.md).
///
/// For each vertex its place from the middle of the box, its signed distances, and for each field
/// and material its value or ghost value; for each leaf its corners and the interfaces that part
/// two materials in it. Vertices and leaves in the tree's order: the same for the same cells.
EncodedCells encode_cells(const MaterialVolume& volume);

}  // namespace terrane::hierarchy::volume
