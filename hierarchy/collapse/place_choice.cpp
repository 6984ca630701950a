#include "hierarchy/collapse/place_choice.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/star_error.h"

namespace terrane::hierarchy {
namespace {

// a share that was best on St. Helens from 1 to 20 m (docs/benchmarks.md, Choices)
constexpr float kIntervalMargin = 0.2F;

// how far from its middle a core looks for more places: 1/4 of the way to each neighbour
constexpr std::int32_t kPartsBesideMiddle = 4;

// samples that a place is held against one after the other, if it first was not
constexpr int kMostLearnt = 4;

/// 1 / \p parts of the way, rounded to the lattice.
GridPoint part_of_way(GridPoint from, GridPoint to, std::int32_t parts) {
  return {from.x + (to.x - from.x) / parts, from.y + (to.y - from.y) / parts};
}

}  // namespace

std::optional<Place> PlaceChoice::for_core(const Stencil& stencil) {
  begin(stencil);
  water_m_ = all_.vertices[index(stencil.core[0])].water_m;
  list_around_core();
  return best_candidate();
}

std::optional<Place> PlaceChoice::onto_corner(const Stencil& stencil, VertexId onto) {
  begin(stencil);
  star_.gather_rest(all_.samples);
  const Place& place = all_.vertices[index(onto)].place;
  candidates_.assign(1, {place.plan, place.height_m});
  if (!fit(candidates_[0]) || !is_sound(place)) return std::nullopt;
  refusal_ = Collapsibility::kOverTolerance;
  if (!holds(place) || !blends(place)) return std::nullopt;
  return place;
}

std::optional<Place> PlaceChoice::for_vertex(const Stencil& stencil, VertexId v,
                                             std::int32_t parts_of_way) {
  begin(stencil);
  const Place here = all_.vertices[index(v)].place;
  here_ = &here;
  water_m_ = all_.vertices[index(v)].water_m;
  candidates_.clear();
  candidates_.push_back({here.plan, here.height_m});
  for (const VertexId to : stencil.polygon) {
    const GridPoint there = all_.vertices[index(to)].place.plan;
    candidates_.push_back({part_of_way(here.plan, there, parts_of_way), here.height_m});
  }
  const std::optional<Place> place = best_candidate();
  here_ = nullptr;
  return place && place->lattice == here.lattice ? std::nullopt : place;
}

void PlaceChoice::begin(const Stencil& stencil) {
  stencil_ = &stencil;
  star_.gather_few(stencil, all_.mesh, all_.vertices, all_.samples);
  judge_.begin();
  refusal_ = Collapsibility::kNotStarShaped;
}

/// The corners of the core, and its middle.
void PlaceChoice::list_around_core() {
  candidates_.clear();
  std::int64_t x = 0, y = 0;
  double height_m = 0;
  for (const VertexId v : stencil_->core_span()) {
    const Place& place = all_.vertices[index(v)].place;
    x += place.plan.x;
    y += place.plan.y;
    height_m += place.height_m;
    candidates_.push_back({place.plan, place.height_m});
  }
  const std::int64_t n = stencil_->core_size;
  candidates_.push_back({{static_cast<std::int32_t>(x / n), static_cast<std::int32_t>(y / n)},
                         height_m / static_cast<double>(n)});
  if (search_.tries_more_places) list_more(candidates_.back());
}

/// Halfway from the middle to two corners, and places around it.
void PlaceChoice::list_more(Candidate middle) {
  for (std::size_t end = 0; end < 2; ++end) {
    const Candidate there = candidates_[end];
    candidates_.push_back(
        {part_of_way(middle.plan, there.plan, 2), (middle.height_m + there.height_m) / 2});
  }
  for (const VertexId to : stencil_->polygon) {
    const GridPoint there = all_.vertices[index(to)].place.plan;
    candidates_.push_back({part_of_way(middle.plan, there, kPartsBesideMiddle), middle.height_m});
  }
}

/// The place of the candidate with the least squared error among those that may be written; where
/// there are keen samples, with the least at those.
std::optional<Place> PlaceChoice::best_candidate() {
  if (star_.sample_count() > 0) {
    if (!fit_candidates()) return std::nullopt;
  }
  star_.gather_rest(all_.samples);
  const bool is_judged_by_keen = star_.keen_count() > 0;
  if (!is_judged_by_keen) fit_candidates();
  while (Candidate* best = least_squared_error()) {
    bool is_worth_it = !is_judged_by_keen || fit(*best);
    for (int times = 0; is_worth_it && times < kMostLearnt; ++times) {
      has_learnt_ = false;
      if (const std::optional<Place> place = written(*best)) return place;
      is_worth_it = has_learnt_ && fit(*best);
    }
    best->is_rejected = true;
  }
  return std::nullopt;
}

/// Rejects the candidates that no height keeps near the samples gathered so far.
/// \return whether one is left.
bool PlaceChoice::fit_candidates() {
  bool is_any_left = false;
  for (Candidate& candidate : candidates_) {
    if (!candidate.is_rejected) candidate.is_rejected = !fit(candidate);
    is_any_left = is_any_left || !candidate.is_rejected;
  }
  return is_any_left;
}

bool PlaceChoice::fit(Candidate& candidate) {
  const StarVerdict verdict =
      judge_.fit(star_, star_.centre(candidate.plan), static_cast<float>(search_.tolerance_m),
                 static_cast<float>(all_.shape.smallest_altitude_cells), candidate.heights,
                 static_cast<std::size_t>(&candidate - candidates_.data()));
  if (verdict != StarVerdict::kNotStarShaped) refusal_ = Collapsibility::kOverTolerance;
  return verdict == StarVerdict::kFeasible;
}

PlaceChoice::Candidate* PlaceChoice::least_squared_error() {
  Candidate* best = nullptr;
  for (Candidate& candidate : candidates_) {
    if (candidate.is_rejected) continue;
    if (best && candidate.heights.squared_error >= best->heights.squared_error) continue;
    best = &candidate;
  }
  return best;
}

/// The place that will be written for a candidate, if it holds what the wished place promised.
std::optional<Place> PlaceChoice::written(const Candidate& candidate) {
  const double height_m = std::isnan(water_m_) ? wished_height_m(candidate)
                                               : all_.placer.over_datum_m(candidate.plan, water_m_);
  const Place place = all_.placer.place(candidate.plan, height_m);
  // as the mesh is, it is all that it has to be
  if (here_ && place.lattice == here_->lattice) return place;
  if (!is_sound(place)) return std::nullopt;
  if (!holds(place) || !blends(place)) return std::nullopt;
  return place;
}

double PlaceChoice::wished_height_m(const Candidate& candidate) const {
  const auto& [lowest, highest, best, squared_error] = candidate.heights;
  if (!std::isfinite(highest - lowest)) return candidate.height_m;
  const float margin = kIntervalMargin * (highest - lowest);
  return star_.origin().height_m + std::clamp(best, lowest + margin, highest - margin);
}

/// Is no triangle of the star turned over, too thin or too steep?
bool PlaceChoice::is_sound(const Place& place) const {
  for (std::size_t k = 0; k < star_.sector_count(); ++k) {
    if (!is_well_shaped(place, star_.corner(k), star_.corner(k + 1), all_.shape, all_.placer)) {
      return false;
    }
  }
  return true;
}

/// Is the star around a place near all samples, those that the reference leaves out as well? The
/// worst of these is learnt.
bool PlaceChoice::holds(const Place& place) {
  if (!judge_.holds(star_, place, search_.tolerance_m)) return false;
  if (!all_.field.is_backed()) return true;
  const StarError error = error_of_star(star_, place, all_.field, search_.tolerance_m);
  if (error.most_m <= search_.tolerance_m) return true;
  star_.learn(error.worst);
  has_learnt_ = true;
  return false;
}

/// Can the finer level's vertices that are in the core go to this place?
bool PlaceChoice::blends(const Place& place) {
  if (!all_.guard || all_.guard->allows(stencil_->core_span(), place)) return true;
  refusal_ = Collapsibility::kMorph;
  return false;
}

}  // namespace terrane::hierarchy
