#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "hierarchy/levels/point_lattice.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// The place of an apex beyond the border: there is no neighbour triangle on that side.
inline constexpr std::uint32_t kOutside = ~std::uint32_t{0};

/// One triangle collapse, and its way back.
///
///             q2                  Forward: triangle (p0, p1, p2) and its neighbours
///            /  \                 (p_k+1, p_k, q_k) go; its three corners meet in one
///          p0 -- p2 -- q1         vertex, which keeps the id of p0.
///            \  /
///             p1                  Back: the triangles about p0 are dealt out
///         q0                      counter-clockwise: q0 to q1 belong to p1, q1 to q2 to p2,
///                                 q2 to q0 to p0.
/// (q0 is opposite to the side p0-p1, q1 to p1-p2, q2 to p2-p0.)
struct Collapse {
  std::array<std::uint32_t, 3> corners{};   ///< p0, p1, p2; p1 and p2 exist only before
  std::array<std::uint32_t, 3> apexes{};    ///< q0, q1, q2; kOutside beyond the border
  std::array<Eigen::Vector3i, 3> before{};  ///< places of the corners, in lattice steps
  Eigen::Vector3i after{0, 0, 0};           ///< the collapse point, in lattice steps

  bool operator==(const Collapse&) const = default;
};

/// The sequence M_0, M_1, ..., M_n: M_n and the collapses that lead to it.
///
/// Vertices are numbered so that M_i holds 0 ... vertex_count(i) - 1: those of M_n come first, and
/// every collapse, going back, appends its p1 and p2.
/// \par Source
/// Gieng et al. 1998, section 5.
struct LevelSequence {
  PointLattice lattice;
  std::vector<Eigen::Vector3i> coarsest_points;  ///< in lattice steps
  std::vector<Corners> coarsest_triangles;
  /// levels[i] leads from M_i to M_(i+1). The stencils of one level do not meet; going back they
  /// are undone in the order of the list.
  std::vector<std::vector<Collapse>> levels;

  std::uint32_t level_count() const { return static_cast<std::uint32_t>(levels.size()); }
};

/// Rebuilds the meshes of a sequence, from M_n back to M_0.
class LevelRebuilder {
 public:
  /// Starts at M_n. \param sequence  must outlive the rebuilder.
  explicit LevelRebuilder(const LevelSequence& sequence);

  std::uint32_t level() const { return level_; }
  /// Undoes the collapses that led to the current level: M_i becomes M_(i-1).
  /// \pre level() > 0.
  /// \throws InputError if a collapse does not fit the mesh: the sequence is damaged.
  void refine();
  void refine_to(std::uint32_t level);

  const std::vector<Eigen::Vector3i>& points() const { return points_; }
  const std::vector<Corners>& triangles() const { return triangles_; }
  /// The current mesh, in the unit of the input.
  SurfaceMesh mesh() const;

  /// Neighbours of a vertex counter-clockwise: from the first one after the outside if it is on the
  /// border, else from the one with the smallest number.
  std::vector<std::uint32_t> link(std::uint32_t vertex) const;
  /// Undoes one collapse: p0 becomes the triangle again.
  void split(const Collapse& collapse);

 private:
  struct LinkEdge {
    std::uint32_t from, to, triangle;
  };
  std::vector<LinkEdge> link_edges(std::uint32_t vertex) const;
  void deal_out(const Collapse& collapse);
  void add_triangle(const Corners& corners);
  void check(const Collapse& collapse) const;

  const LevelSequence& sequence_;
  std::uint32_t level_;
  std::vector<Eigen::Vector3i> points_;
  std::vector<Corners> triangles_;
  std::vector<std::vector<std::uint32_t>> incident_;  // triangles of each vertex
};

/// M_i(t): M_i with the corners of its collapsing triangles on their way to the collapse points.
///
/// M_i(0) = M_i; M_i(1) is M_(i+1) with the collapsed triangles as degenerate ones.
/// \param t  in [0, 1]; anything for the last level, which goes nowhere.
/// \throws ConfigError if there is no such level or t.
SurfaceMesh blended(const LevelSequence& sequence, std::uint32_t level, double t);

/// M_i and where each of its vertices comes to lie in M_(i + by) (or in M_n, if that is nearer).
struct MorphingMesh {
  SurfaceMesh mesh;
  std::vector<Eigen::Vector3d> targets;
};
/// \throws ConfigError if there is no such level.
MorphingMesh morphing(const LevelSequence& sequence, std::uint32_t level, std::uint32_t by);

}  // namespace terrane::hierarchy
