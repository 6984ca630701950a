#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hierarchy/volume/closest_point.h"
#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::hierarchy::volume {

/// Triangles as they come from a file or a grid.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> points;                  ///< in the units of the model
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from above
};

/// How the distance of a point to an interface is measured.
enum class DistanceRule {
  kExact,         ///< to the nearest point of any triangle
  kNearestVertex  ///< to the nearest vertex, its normal gives the sign: as published
};

/// How the side of a point is told.
enum class SideRule {
  kNormals,  ///< by the normal at the nearest point: closed surfaces
  kVertical  ///< under or over the surface in plan: surfaces of heights
};

/// The point of a surface that is nearest to another point, and a triangle that it lies on: of
/// several the one with the smallest index.
struct NearestTriangle {
  ClosestPoint at;
  std::uint32_t triangle = 0;
};

/// A triangle mesh that separates materials: negative on one side (*below*: the side that normals
/// point away from), positive on the other (*above*).
///
/// It has no hole, or ends outside the model's box; so each point of the box has a side.
/// Thread-safe: nothing changes after construction.
class InterfaceSurface {
 public:
  /// Takes triangles over and makes sure that they have two sides in the box.
  ///
  /// \param name  goes into messages: the file, or what the user calls the surface.
  /// \throws InputError naming the surface and a place, if a coordinate is no number, there is no
  ///         triangle, an edge has more than two triangles or runs the same way through both
  ///         (orientation), the surface ends inside the box, intersects itself (kNormals), turns
  ///         over in plan (kVertical), or does not meet the box at all.
  InterfaceSurface(std::string name, SurfaceMesh mesh, SideRule side, const Box& box);

  /// Distance with a sign: below 0 on the side that normals point away from.
  double signed_distance(const Eigen::Vector3d& p, DistanceRule rule) const;

  /// The triangle point nearest to p.
  ClosestPoint nearest(const Eigen::Vector3d& p) const;
  NearestTriangle nearest_triangle(const Eigen::Vector3d& p) const;
  /// The vertex nearest to p; of several the one with the smallest index.
  std::uint32_t nearest_vertex(const Eigen::Vector3d& p) const;

  const std::string& name() const { return name_; }
  const SurfaceMesh& mesh() const { return mesh_; }
  std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const;

  /// Height of the surface at a place in plan, if it is there. \pre kVertical.
  std::optional<double> height(double x, double y) const;

 private:
  /// A node of the tree of boxes around triangles.
  struct TreeNode {
    Eigen::Vector3d low, high;
    std::uint32_t begin = 0, end = 0;  ///< triangles order_[begin, end)
    std::uint32_t right = 0;           ///< second child (the first is the next node); 0: a leaf
  };

  void check_numbers() const;
  void find_neighbours();
  void check_ends(const Box& box) const;
  void check_plan() const;
  void check_self_intersections() const;
  void compute_normals();
  std::uint32_t build_tree(std::uint32_t begin, std::uint32_t end,
                           const std::vector<Eigen::Vector3d>& centres);
  bool is_below(const Eigen::Vector3d& p, const NearestTriangle& nearest) const;
  bool is_under(const Eigen::Vector3d& p, const NearestTriangle& nearest) const;
  Eigen::Vector3d normal_at(const NearestTriangle& nearest) const;
  template <class Distance, class Visit>
  void visit_nearest_first(const Distance& squared_distance, const Visit& visit) const;
  template <class Overlaps, class Visit>
  void visit_all(const Overlaps& overlaps, const Visit& visit) const;
  std::string place(const Eigen::Vector3d& p) const;

  std::string name_;
  SurfaceMesh mesh_;
  SideRule side_;
  std::vector<std::array<std::uint32_t, 3>> across_;  ///< triangle over the edge from corner k on
  std::vector<Eigen::Vector3d> vertex_normals_;       ///< weighted by angle, of any length
  std::vector<std::uint32_t> order_;
  std::vector<TreeNode> tree_;
};

}  // namespace terrane::hierarchy::volume
