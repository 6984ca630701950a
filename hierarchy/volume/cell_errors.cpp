// Errors of cells: sections 5.1 and 7 of Gregorski et al. 2003, made strict.
#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

#include "hierarchy/volume/material_volume.h"
#include "hierarchy/volume/piece_distance.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// A coarse cell holds nearly all triangles; that it is over its tolerance is seen from a few.
constexpr int kTrianglesBeforeAnEarlyVerdict = 64;

Mask bit(std::size_t i) { return Mask{1} << i; }

double longest_edge(const TetraCorners& c) {
  double squared = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) squared = std::max(squared, (c[i] - c[j]).squaredNorm());
  }
  return std::sqrt(squared);
}

/// No point of a cell is nearer.
double distance_to_box_of(const TetraCorners& c, const Vector3d& p) {
  const Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]).cwiseMin(c[3]);
  const Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]).cwiseMax(c[3]);
  return (low - p).cwiseMax(p - high).cwiseMax(0).norm();
}

double nearest(const std::vector<ZeroSet>& sets, const Vector3d& p) {
  double distance = kUnbounded;
  for (const ZeroSet& set : sets) distance = std::min(distance, set.distance(p));
  return distance;
}

}  // namespace

InterfaceId MaterialVolume::interface_of(std::uint32_t triangle) const {
  std::uint8_t i = 0;
  while (i + 1u < interface_count() && first_triangle_[i + 1] <= triangle) ++i;
  return InterfaceId{i};
}

std::array<Vector3d, 3> MaterialVolume::triangle(std::uint32_t id) const {
  const std::size_t i = index(interface_of(id));
  return model_.interfaces[i]->corners(id - first_triangle_[i]);
}

TetraCorners MaterialVolume::corners(CellId leaf) const {
  TetraCorners corners;
  std::ranges::transform(mesh_.corners(leaf), corners.begin(),
                         [&](NodeId node) { return mesh_.position(node); });
  return corners;
}

Eigen::Vector4d MaterialVolume::distances(CellId leaf, InterfaceId interface) const {
  Eigen::Vector4d d;
  for (int k = 0; k < 4; ++k) d[k] = distance(mesh_.corners(leaf)[k], interface);
  return d;
}

Eigen::Vector4d MaterialVolume::values(CellId leaf, FieldId field, MaterialId material) const {
  Eigen::Vector4d v;
  for (int k = 0; k < 4; ++k) v[k] = value(mesh_.corners(leaf)[k], field, material);
  return v;
}

ZeroSet MaterialVolume::approximation(CellId leaf, InterfaceId interface) const {
  if ((parting_[index(leaf)] & bit(index(interface))) == 0) return {};
  const Eigen::Vector4d d = distances(leaf, interface);
  if (d.minCoeff() > 0 || d.maxCoeff() < 0) return {};
  return zero_set(corners(leaf), {d[0], d[1], d[2], d[3]});
}

// Interfaces that all corners are below of; `open` gets those that corners are on both sides of.
Mask MaterialVolume::vertex_sides(CellId leaf, Mask& open) const {
  Mask below = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    const Eigen::Vector4d d = distances(leaf, InterfaceId{static_cast<std::uint8_t>(i)});
    if (d.maxCoeff() < 0) {
      below |= bit(i);
    } else if (d.minCoeff() < 0) {
      open |= bit(i);
    }
  }
  return below;
}

Mask MaterialVolume::interfaces_of_triangles(CellId leaf) const {
  Mask found = 0;
  for (const std::uint32_t t : triangles_[index(leaf)]) found |= bit(index(interface_of(t)));
  return found;
}

void MaterialVolume::drop_triangles_outside(CellId cell, const Barycentric& shape) {
  auto& list = triangles_[index(cell)];
  std::erase_if(list, [&](std::uint32_t t) { return clip(triangle(t), shape).size == 0; });
  list.shrink_to_fit();
}

// Needs the values of the cell's vertices. The neighbours' vertices are there, too.
void MaterialVolume::evaluate(CellId cell) {
  const Barycentric shape(corners(cell));
  drop_triangles_outside(cell, shape);
  Mask open = interfaces_of_triangles(cell);
  const Mask below = vertex_sides(cell, open);
  possible_[index(cell)] = possible_materials(model_.materials, below, open);
  parting_[index(cell)] = parting_interfaces(model_.materials, below, open);
  leans_on_neighbours_[index(cell)] = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    const InterfaceId id{static_cast<std::uint8_t>(i)};
    double& error = errors_[index(cell) * error_count() + i];
    if ((parting_[index(cell)] & bit(i)) == 0) {
      error = 0;  // the same material on both sides
    } else if (options_.interface_error == InterfaceErrorRule::kVertices) {
      error = published_error(cell, id, shape);
    } else {
      error = strict_error(cell, id, shape);
    }
  }
  for (std::size_t f = 0; f < field_count(); ++f) {
    errors_[index(cell) * error_count() + interface_count() + f] =
        deviation(cell, FieldId{static_cast<std::uint8_t>(f)});
  }
}

// The distance to a convex piece is convex, so over the part of a triangle in this cell it is
// largest at a corner of that part. Where the piece in this cell is too far away, those in the
// cells around count as well: then the error holds until they change.
double MaterialVolume::strict_error(CellId cell, InterfaceId interface, const Barycentric& shape) {
  const double tolerance = tolerances_.interfaces[index(interface)];
  const ZeroSet own = approximation(cell, interface);
  std::vector<ZeroSet> around;
  double largest = 0;
  int looked_at = 0;
  for (const std::uint32_t t : triangles_[index(cell)]) {
    if (interface_of(t) != interface) continue;
    const SmallPolygon part = clip(triangle(t), shape);
    for (int k = 0; k < part.size; ++k) {
      double distance = own.is_empty() ? kUnbounded : own.distance(part.points[k]);
      if (distance > tolerance || own.is_empty()) {
        leans_on_neighbours_[index(cell)] = 1;
        distance = std::min(distance, distance_around(cell, interface, part.points[k], around));
      }
      largest = std::max(largest, distance);
    }
    if (++looked_at >= kTrianglesBeforeAnEarlyVerdict && largest > tolerance) break;
  }
  if (std::isinf(largest)) return std::max(2 * tolerance, longest_edge(corners(cell)));
  if (largest > tolerance) return largest;
  // and the way back: no piece strays from the interface
  return std::max(largest, largest_distance(own, *model_.interfaces[index(interface)], tolerance));
}

double MaterialVolume::published_error(CellId cell, InterfaceId interface,
                                       const Barycentric& shape) const {
  const Eigen::Vector4d d = distances(cell, interface);
  Vector3d slope = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) slope += d[k] * shape.gradient(k);
  if (slope.isZero(0)) return kUnbounded;
  double largest = 0;
  for (const std::uint32_t t : triangles_[index(cell)]) {
    if (interface_of(t) != interface) continue;
    for (const Vector3d& vertex : triangle(t)) {
      const Eigen::Vector4d w = shape.weights(vertex);
      if (w.minCoeff() >= 0) largest = std::max(largest, std::abs(w.dot(d)) / slope.norm());
    }
  }
  return largest;
}

// Distance of a place to the approximation as far as the tolerance, looked for in this leaf and
// from neighbour to neighbour, the nearest first. A tip of the interface can miss the vertices of
// all cells around it, at any size of cells; what it grows from is not far.
double MaterialVolume::distance_around(CellId cell, InterfaceId interface, const Vector3d& p,
                                       std::vector<ZeroSet>& known) {
  const double tolerance = tolerances_.interfaces[index(interface)];
  double best = nearest(known, p);
  if (best <= tolerance) return best;
  struct Open {
    double distance;
    CellId cell;
    bool operator<(const Open& other) const {
      return distance != other.distance ? distance > other.distance : cell > other.cell;
    }
  };
  std::priority_queue<Open> open;
  ++search_;
  seen_[index(cell)] = search_;
  open.push({0, cell});
  while (!open.empty() && open.top().distance <= tolerance) {
    const CellId here = open.top().cell;
    open.pop();
    const Eigen::Vector4d d = distances(here, interface);
    if (d.minCoeff() <= 0 && d.maxCoeff() >= 0) {
      const ZeroSet piece = zero_set(corners(here), {d[0], d[1], d[2], d[3]});
      best = std::min(best, piece.distance(p));
      if (best <= tolerance) {
        known.push_back(piece);
        return best;
      }
    }
    for (const CellId next : mesh_.neighbours(here)) {
      if (next == kNoCell || seen_[index(next)] == search_) continue;
      seen_[index(next)] = search_;
      open.push({distance_to_box_of(corners(next), p), next});
    }
  }
  return best;
}

double MaterialVolume::deviation(CellId cell, FieldId field) const {
  const double tolerance = tolerances_.fields[index(field)];
  const Mask possible = possible_[index(cell)];
  const Mask around = interfaces_of_triangles(cell);
  Mask open = 0;
  const Mask below = vertex_sides(cell, open);
  double largest = 0;
  for (std::size_t m = 0; m < model_.materials.size(); ++m) {
    const MaterialId material{static_cast<std::uint8_t>(m)};
    if ((possible & bit(m)) == 0 || model_.materials[m].is_empty) continue;
    MayHold may_hold;
    if (std::popcount(possible) > 1 && around != 0) {
      may_hold = [&, m](const Vector3d& centre, double radius) {
        Mask here = below & ~around, unsure = 0;
        for (std::size_t i = 0; i < interface_count(); ++i) {
          if ((around & bit(i)) == 0) continue;
          const InterfaceSurface& surface = *model_.interfaces[i];
          if (surface.nearest(centre).squared_distance <= radius * radius) {
            unsure |= bit(i);  // the side is not worth finding out
          } else if (surface.signed_distance(centre, options_.distance) < 0) {
            here |= bit(i);
          }
        }
        return (possible_materials(model_.materials, here, unsure) & bit(m)) != 0;
      };
    }
    largest = std::max(largest, model_.fields[index(field)].field->largest_deviation(
                                    {corners(cell), values(cell, field, material)}, material,
                                    may_hold, tolerance));
  }
  return largest;
}

}  // namespace terrane::hierarchy::volume
