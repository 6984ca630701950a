#pragma once

#include <optional>
#include <vector>

#include "hierarchy/collapse/covered_samples.h"
#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/star.h"
#include "hierarchy/collapse/star_fit.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/collapse/triangle_shape.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// The mesh that places are chosen in, and what they are held against. All must outlive the choice.
struct PlaceSurroundings {
  const HalfedgeMesh& mesh;
  const std::vector<TerrainVertex>& vertices;
  const CoveredSamples& samples;
  const SampleField& field;
  const Placer& placer;
  const ShapeLimits& shape;
  MorphGuard* guard = nullptr;  ///< of the blend from the finer level, if there is one
};

/// How places are looked for.
struct PlaceSearch {
  double tolerance_m = 1;  ///< largest vertical distance to any sample
  /// Whether a core goes not only to one of its corners or its middle, but also in between.
  bool tries_more_places = false;
};

/// Chooses where the core of a stencil goes, or where a vertex moves: of a few places in plan, each
/// at its best height, the one with the least squared error among those that may be written.
///
/// A place may be written if, rounded as it will be, its star is well shaped (triangle_shape.h),
/// within the tolerance of every sample under it and lets the finer level blend soundly
/// (morph_guard.h). In water it has the water's height. Keeps its scratch space from call to call.
class PlaceChoice {
 public:
  explicit PlaceChoice(const PlaceSurroundings& surroundings) : all_(surroundings) {}

  void set_search(const PlaceSearch& search) { search_ = search; }

  /// The place for a core; refusal() says why if there is none.
  /// \pre the stencil is complete.
  std::optional<Place> for_core(const Stencil& stencil);

  /// The place of one of the core's corners, which keeps it, if the core may go there.
  std::optional<Place> onto_corner(const Stencil& stencil, VertexId onto);

  /// A place nearer to the samples for a vertex: 1 / \p parts_of_way of the way to one of its
  /// neighbours. None if it is best where it is.
  /// \param stencil  around the vertex alone.
  std::optional<Place> for_vertex(const Stencil& stencil, VertexId v, std::int32_t parts_of_way);

  /// Why no place was found for the last core.
  Collapsibility refusal() const { return refusal_; }

  /// Shares the samples under the star last chosen out to its triangles.
  void hand_over(CoveredSamples& samples) {
    samples.share_out(star_.triangles(), star_.samples(), star_.keen_count(),
                      judge_.sectors(star_));
  }

 private:
  /// A place worth trying.
  struct Candidate {
    GridPoint plan;
    double height_m = 0;  ///< what to take where no sample decides
    StarHeights heights;
    bool is_rejected = false;
  };

  void begin(const Stencil& stencil);
  void list_around_core();
  void list_more(Candidate middle);
  std::optional<Place> best_candidate();
  bool fit_candidates();
  bool fit(Candidate& candidate);
  Candidate* least_squared_error();
  std::optional<Place> written(const Candidate& candidate);
  double wished_height_m(const Candidate& candidate) const;
  bool is_sound(const Place& place) const;
  bool holds(const Place& place);
  bool blends(const Place& place);

  PlaceSurroundings all_;
  PlaceSearch search_;
  const Stencil* stencil_ = nullptr;
  const Place* here_ = nullptr;  // of the vertex that may move; null for a core
  float water_m_ = 0;            // of what is being moved; NaN on land
  std::vector<Candidate> candidates_;
  Star star_;
  StarJudge judge_;
  bool has_learnt_ = false;  // a sample, since a place was to be written
  Collapsibility refusal_ = Collapsibility::kYes;
};

}  // namespace terrane::hierarchy
