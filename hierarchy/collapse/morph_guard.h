#pragma once

#include <array>
#include <span>
#include <vector>

#include "hierarchy/collapse/moving_triangle.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/ids.h"

namespace terrane::hierarchy {

/// Keeps the blend between a level and the next one sound.
///
/// Every vertex of the finer level moves on a straight line to the vertex of the coarser mesh that
/// it was collapsed into. The guard knows these targets, and refuses a collapse after which a
/// triangle of the finer level would turn over at some t < 1, or leave the tolerance at any t
/// (moving_triangle.h).
class MorphGuard {
 public:
  /// \param finer      places of the finer level, one per vertex of the mesh to be collapsed.
  /// \param triangles  the finer level's.
  /// \param coarser    the mesh's vertices; read at every call, so it must outlive the guard.
  /// \param placer     of the coarser mesh; must outlive the guard.
  /// \param smallest_altitude_cells  that the triangles of either level have in plan; in between,
  ///                   it may be a quarter.
  MorphGuard(std::vector<Place> finer, std::vector<Corners> triangles,
             const std::vector<TerrainVertex>& coarser, const SampleField& field,
             const Placer& placer, double tolerance_m, double smallest_altitude_cells = 0);

  /// Tells that fine vertices have gone elsewhere already, without a check.
  /// \param target  for each fine vertex: itself, or a vertex that stays; empty: none has gone.
  void begin_at(std::span<const std::uint32_t> target);

  /// May the vertices of \p core all go to \p target?
  bool allows(std::span<const VertexId> core, const Place& target);

  /// Tells that they did, and are \p kept from now on.
  void join(std::span<const VertexId> core, VertexId kept);

  /// The coarse vertex that a fine one ends at.
  VertexId target_of(std::uint32_t fine) const { return target_[fine]; }

 private:
  /// A fine triangle on its way, were the place taken.
  struct Movement {
    std::uint32_t triangle;
    MovingTriangle moving;
  };

  void list_moved(std::span<const VertexId> core);
  bool refuses_at_a_look(std::uint32_t triangle, std::span<const VertexId> core,
                         const Place& target);
  bool do_all_stay_within();
  bool is_upright(const std::array<Place, 6>& places) const;

  std::vector<Place> finer_;
  std::vector<Corners> triangles_;
  const std::vector<TerrainVertex>& coarser_;
  const SampleField& field_;
  const Placer& placer_;
  double tolerance_m_, least_altitude_;

  std::vector<VertexId> target_;
  std::vector<std::uint32_t> next_member_;  // members of a coarse vertex: a ring through itself
  std::vector<std::uint32_t> first_incident_, incident_;
  bool has_large_triangles_;
  std::vector<std::uint32_t> checked_, moved_;
  std::vector<Movement> movements_;
  std::vector<std::uint32_t> refused_;  // stamp when a fine triangle last refused a place, or 0
  std::vector<FieldSample> left_;       // for the sake of that sample, if it has a height
  std::uint32_t stamp_ = 0;
};

}  // namespace terrane::hierarchy
