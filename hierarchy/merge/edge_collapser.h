#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/merge/build_merge_tree.h"
#include "hierarchy/merge/sample_lists.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// An edge collapse that was made; vertices have the numbers of the full mesh.
struct EdgeCollapse {
  std::uint32_t removed = 0, kept = 0;    ///< c and p
  std::array<std::uint32_t, 2> apexes{};  ///< as in Split; kOutside beyond the border
  std::uint32_t level = 1;
};

/// Collapses the edges of one mesh, pass by pass.
class EdgeCollapser {
 public:
  /// \param points  on a lattice, relative to its origin.
  /// \param step    of the lattice.
  EdgeCollapser(std::vector<Eigen::Vector3d> points, const std::vector<Corners>& triangles,
                double step, ErrorMeasure measure, const MergeTreeOptions& options);
  EdgeCollapser(const EdgeCollapser&) = delete;  // walker_ holds on to mesh_

  /// Collapses what it can.
  void run();

  const std::vector<EdgeCollapse>& collapses() const { return collapses_; }
  /// What is left.
  std::vector<Corners> triangles() const { return mesh_.triangles(); }
  /// The given vertex that a vertex is: where fans touch, one is split into several.
  std::uint32_t origin(std::uint32_t vertex) const { return mesh_.origin(VertexId{vertex}); }
  std::uint32_t vertex_count() const { return mesh_.vertex_count(); }

 private:
  struct Candidate {
    double cost;
    HalfedgeId edge;  ///< from the vertex that would go, to the one that would stay
  };

  std::uint32_t pass(std::uint32_t level);
  std::vector<Candidate> candidates();
  std::vector<Candidate> edges_by_length();
  std::vector<Candidate> vertices_by_error();
  bool try_collapse(const Candidate& candidate, std::uint32_t level);
  bool examine(HalfedgeId edge, double limit, double& error);
  bool is_allowed(HalfedgeId edge);
  void walk(HalfedgeId edge);
  bool is_sound(std::size_t i) const;
  bool is_straight() const;
  bool is_free(HalfedgeId edge) const;
  void mark(HalfedgeId edge);
  void collapse(HalfedgeId edge, std::uint32_t level);
  template <class Visit>
  void around(VertexId v, Visit visit) const;
  const Eigen::Vector3d& at(VertexId v) const { return points_[index(v)]; }

  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> normals_;  // of the full mesh
  HalfedgeMesh mesh_;
  StencilWalker walker_;
  Stencil stencil_;
  double least_altitude_;  // of a triangle in plan
  ErrorMeasure measure_;
  const MergeTreeOptions& options_;
  SampleLists lists_;
  std::vector<std::uint32_t> marked_;  // pass that a triangle was taken in
  std::uint32_t pass_ = 0, live_vertices_ = 0;
  std::vector<EdgeCollapse> collapses_;

  // the star of the vertex that would go, counter-clockwise from the one that would stay
  VertexId gone_{};
  std::vector<VertexId> ring_;
  std::vector<std::uint32_t> ring_triangles_;
  Eigen::Vector3d star_area_ = Eigen::Vector3d::Zero();
  std::vector<TrianglePlaces> fan_;           // that would come instead
  std::vector<std::uint32_t> fan_triangles_;  // their ids
  std::vector<std::uint32_t> samples_;        // under it
};

}  // namespace terrane::hierarchy
