// Signed distances and values of the vertices: sections 5.1 and 6.1 of Gregorski et al. 2003.
#include <cmath>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

using Eigen::Vector3d;

/// For each material the place on an interface that its ghost values come from.
struct MaterialVolume::GhostPlaces {
  struct Place {
    Vector3d at = Vector3d::Zero();
    double squared_distance = std::numeric_limits<double>::infinity();
  };
  Place nearest;  ///< of all: for materials that no interface around borders
  std::vector<Place> of_material;

  void offer(Place& place, const Vector3d& at, double squared_distance) const {
    if (squared_distance < place.squared_distance) place = {at, squared_distance};
  }
};

Mask MaterialVolume::exact_below(const Vector3d& p) const {
  Mask below = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    if (model_.interfaces[i]->signed_distance(p, options_.distance) < 0) below |= Mask{1} << i;
  }
  return below;
}

MaterialId MaterialVolume::true_material(const Vector3d& p) const {
  return volume::material_at(model_.materials, exact_below(p));
}

MaterialVolume::GhostPlaces MaterialVolume::ghost_places(const Vector3d& p, Mask interfaces,
                                                         Mask below) const {
  GhostPlaces places;
  places.of_material.resize(model_.materials.size());
  for (std::size_t i = 0; i < interface_count(); ++i) {
    const Mask bit = Mask{1} << i;
    if ((interfaces & bit) == 0) continue;
    const InterfaceSurface& surface = *model_.interfaces[i];
    // among large triangles the nearest vertex stays far away however small the cells become, and
    // the value there with it
    const Vector3d at = options_.distance == DistanceRule::kNearestVertex
                            ? surface.mesh().points[surface.nearest_vertex(p)]
                            : surface.nearest(p).point;
    const double distance = (at - p).squaredNorm();
    // on the far side of this interface, on its own side of the others
    Mask there = (below & bit) ^ bit;
    for (std::size_t j = 0; j < interface_count(); ++j) {
      const Mask other = Mask{1} << j;
      if (j == i) continue;
      const bool is_below = (interfaces & other) == 0
                                ? (below & other) != 0
                                : model_.interfaces[j]->signed_distance(at, options_.distance) < 0;
      if (is_below) there |= other;
    }
    const MaterialId far = volume::material_at(model_.materials, there);
    places.offer(places.of_material[index(far)], at, distance);
    places.offer(places.nearest, at, distance);
  }
  for (auto& place : places.of_material) {
    if (std::isinf(place.squared_distance)) place = places.nearest;
  }
  return places;
}

// Where no interface is around the edge, what it needs of other materials' values and of distances
// is only that they go on being linear: nobody reads them.
void MaterialVolume::compute_node(NodeId node, Mask interfaces, const std::array<NodeId, 2>* ends) {
  const Vector3d p = mesh_.position(node);
  Mask below = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    const InterfaceId id{static_cast<std::uint8_t>(i)};
    const bool is_around = (interfaces >> i & 1) != 0;
    const double d = is_around ? model_.interfaces[i]->signed_distance(p, options_.distance)
                               : (distance((*ends)[0], id) + distance((*ends)[1], id)) / 2;
    distances_[index(node) * interface_count() + i] = d;
    if (d < 0) below |= Mask{1} << i;
  }
  const MaterialId own = volume::material_at(model_.materials, below);
  const bool is_pure = interfaces == 0;
  const GhostPlaces places =
      is_pure || field_count() == 0 ? GhostPlaces{} : ghost_places(p, interfaces, below);
  const std::size_t materials = model_.materials.size();
  for (std::size_t f = 0; f < field_count(); ++f) {
    const Field& field = *model_.fields[f].field;
    for (std::size_t m = 0; m < materials; ++m) {
      const MaterialId material{static_cast<std::uint8_t>(m)};
      const FieldId id{static_cast<std::uint8_t>(f)};
      double& value_here = values_[(index(node) * field_count() + f) * materials + m];
      if (material == own || model_.materials[m].is_empty) {
        value_here = field.value(p, material);
      } else if (is_pure && ends != nullptr) {
        value_here = (value((*ends)[0], id, material) + value((*ends)[1], id, material)) / 2;
      } else {
        value_here = field.value(is_pure ? p : places.of_material[m].at, material);
      }
    }
  }
}

}  // namespace terrane::hierarchy::volume
