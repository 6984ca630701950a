#pragma once

#include <array>
#include <vector>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

/// A plane: the places p with normal . p = offset.
struct Plane {
  Eigen::Vector3d normal;  ///< of any length but 0
  double offset = 0;
};

/// A triangle of a cross-section, of one material.
struct SectionTriangle {
  std::array<Eigen::Vector3d, 3> points;
  MaterialId material{};
  CellId cell{};                              ///< the leaf that it lies in
  std::vector<std::array<double, 3>> values;  ///< of each field at the points
};

/// Cuts the approximation with a plane. Cells in the order of the tree.
std::vector<SectionTriangle> cut_section(const MaterialVolume& volume, const Plane& plane);

/// The lines in which a plane cuts the faces of the cells: the mesh, to be drawn over a section.
std::vector<std::array<Eigen::Vector3d, 2>> cut_mesh(const MaterialVolume& volume,
                                                     const Plane& plane);

/// Triangles of the approximation of an interface, where it parts materials.
std::vector<std::array<Eigen::Vector3d, 3>> interface_triangles(const MaterialVolume& volume,
                                                                InterfaceId interface);

}  // namespace terrane::hierarchy::volume
