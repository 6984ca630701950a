#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/mesh/grid_point.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// The triangles of one cell while points and edges are put into them. Few triangles, so that a
/// look at all of them is the fastest search. Every decision is exact.
class CellTriangulation {
 public:
  /// Two points that stay joined.
  using Edge = std::array<std::uint32_t, 2>;

  /// \param points     corners of the cell.
  /// \param triangles  one or two, counter-clockwise.
  CellTriangulation(std::vector<GridPoint> points, std::vector<Corners> triangles)
      : points_(std::move(points)), triangles_(std::move(triangles)) {}

  /// Does a point lie in a triangle or on the side of one?
  bool covers(GridPoint point) const;

  /// Adds a point; the triangle or edge that it lies on is split.
  /// \return its number; that of the point which is there already, if there is one.
  /// \pre covers(point).
  std::uint32_t insert(GridPoint point);

  /// Makes two points ends of an edge, or of several where others lie between them on the straight
  /// line; flips what is in the way. Where it crosses an earlier such edge, the two get a point in
  /// common at the crossing, rounded to the grid point.
  void join(std::uint32_t a, std::uint32_t b);

  /// Flips edges that are not joined until no triangle's circle holds the corner across, so that
  /// triangles are as fat as the points allow.
  void make_delaunay();

  std::span<const GridPoint> points() const { return points_; }
  std::span<const Corners> triangles() const { return triangles_; }
  /// The edges that join() made, smaller number first.
  std::span<const Edge> edges() const { return edges_; }

 private:
  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  bool is_joined(std::uint32_t a, std::uint32_t b) const;
  void split_edge(std::uint32_t from, std::uint32_t to, std::uint32_t at);
  bool crosses(Edge edge, std::uint32_t a, std::uint32_t b) const;
  std::vector<Edge> edges_across(std::uint32_t a, std::uint32_t b) const;
  bool flip_if_better(std::size_t i, std::uint32_t k);
  void flip_to(std::uint32_t a, std::uint32_t b, std::vector<Edge> crossing);
  void meet(Edge earlier, std::uint32_t a, std::uint32_t b);

  std::vector<GridPoint> points_;
  std::vector<Corners> triangles_;
  std::vector<Edge> edges_;
};

}  // namespace terrane::hierarchy
