#include "hierarchy/volume/encode_cells.h"

#include <bit>
#include <cstdint>

#include "hierarchy/volume/leaf_numbering.h"

namespace terrane::hierarchy::volume {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void add(EncodedCells& to, const char* name, const char* type, std::size_t components,
         const std::vector<T>& values) {
  to.arrays.push_back({name, type, components, values.size() / components, to.bytes.size()});
  to.bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  to.bytes.resize((to.bytes.size() + 3) / 4 * 4);
}

void add_vertices(EncodedCells& to, const MaterialVolume& volume,
                  const std::vector<NodeId>& nodes) {
  const Box& box = volume.mesh().box();
  const Eigen::Vector3d middle = (box.low + box.high) / 2;
  std::vector<float> positions, distances, values;
  for (const NodeId node : nodes) {
    const Eigen::Vector3f p = (volume.mesh().position(node) - middle).cast<float>();
    positions.insert(positions.end(), {p.x(), p.y(), p.z()});
    for (std::uint8_t i = 0; i < volume.interface_count(); ++i) {
      distances.push_back(static_cast<float>(volume.distance(node, InterfaceId{i})));
    }
    for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
      for (std::uint8_t m = 0; m < volume.model().materials.size(); ++m) {
        values.push_back(static_cast<float>(volume.value(node, FieldId{f}, MaterialId{m})));
      }
    }
  }
  add(to, "positions", "float32", 3, positions);
  if (volume.interface_count() > 0) {
    add(to, "distances", "float32", volume.interface_count(), distances);
  }
  if (volume.field_count() > 0) {
    add(to, "values", "float32", volume.field_count() * volume.model().materials.size(), values);
  }
}

}  // namespace

EncodedCells encode_cells(const MaterialVolume& volume) {
  const std::vector<CellId> leaves = volume.mesh().leaves_in_tree_order();
  const LeafNumbering numbering = number_nodes(volume.mesh(), leaves);
  EncodedCells result;
  add_vertices(result, volume, numbering.nodes);
  std::vector<std::uint32_t> corners;
  std::vector<std::uint8_t> parting;
  for (const CellId leaf : leaves) {
    for (const NodeId node : volume.mesh().corners(leaf)) {
      corners.push_back(static_cast<std::uint32_t>(numbering.number[index(node)]));
    }
    parting.push_back(static_cast<std::uint8_t>(volume.interfaces_in(leaf)));
  }
  add(result, "corners", "uint32", 4, corners);
  add(result, "parting", "uint8", 1, parting);
  return result;
}

}  // namespace terrane::hierarchy::volume
