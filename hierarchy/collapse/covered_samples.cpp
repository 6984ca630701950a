#include "hierarchy/collapse/covered_samples.h"

#include <algorithm>
#include <utility>

#include "hierarchy/collapse/triangle_plane.h"

namespace terrane::hierarchy {
namespace {

// samples_ may grow to so many times the samples before the gaps in it are closed: the more the
// faster, but the caches are small, and so is memory where there are millions
constexpr std::size_t kMostGaps = 2, kMostGapsIfFew = 4, kFew = 200'000;

// of so many samples one after the other under a triangle, the highest over it and the lowest are
// keen: half as many as there are for a triangle
constexpr std::size_t kKeenShare = 2;

// with fewer than so many it would not pay
constexpr std::size_t kFewestForKeen = 6;

FieldPoint plan_of(const TerrainVertex& vertex) {
  return {column_of(vertex.place.plan), row_of(vertex.place.plan), 0};
}

bool is_inner(const TerrainVertex& vertex) { return vertex.kind == VertexKind::kInterior; }

}  // namespace

CoveredSamples::CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                               std::span<const Corners> triangles, std::size_t triangle_capacity)
    : lists_(triangle_capacity) {
  const std::size_t all = field.is_reduced() ? field.kept.size() : field.heights_m.size();
  std::vector<bool> is_claimed(all, false);
  std::vector<CoveredSample> found;
  std::vector<std::uint32_t> owner;
  found.reserve(all);
  owner.reserve(all);
  // twice: what lies beside the outline goes to a triangle only when none has it for its own
  constexpr double kOnEdge_cells = 1e-7;
  for (const double slack_cells : {kOnEdge_cells, field.slack_cells}) {
    if (found.size() == all) break;
    const bool is_beside = slack_cells != kOnEdge_cells;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      if (is_beside && is_inner(vertices[a]) && is_inner(vertices[b]) && is_inner(vertices[c])) {
        continue;
      }
      for_each_sample(plan_of(vertices[a]), plan_of(vertices[b]), plan_of(vertices[c]), field,
                      slack_cells, [&](std::size_t number, const FieldSample& sample) {
                        if (is_claimed[number]) return true;
                        is_claimed[number] = true;
                        found.push_back({sample.column, sample.row, sample.height_m});
                        owner.push_back(t);
                        return true;
                      });
    }
  }
  std::size_t first = 0;
  for (const std::uint32_t t : owner) ++lists_[TriangleId{t}].count;
  for (List& list : lists_) {
    list.first = first;
    first += std::exchange(list.count, 0);
  }
  count_ = found.size();
  samples_.reserve(most_with_gaps());
  samples_.resize(count_);
  for (std::size_t s = 0; s < count_; ++s) {
    List& list = lists_[TriangleId{owner[s]}];
    samples_[list.first + list.count++] = found[s];
  }
  choose_keen(vertices, triangles);
}

void CoveredSamples::choose_keen(std::span<const TerrainVertex> vertices,
                                 std::span<const Corners> triangles) {
  const std::size_t chunk = count_ / std::max<std::size_t>(1, triangles.size()) / kKeenShare;
  if (chunk < kFewestForKeen) return;
  has_keen_ = true;
  std::vector<std::size_t> keen;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    List& list = lists_[TriangleId{t}];
    const auto [a, b, c] = triangles[t];
    const TrianglePlane plane(vertices[a].place, vertices[b].place, vertices[c].place);
    const std::span<CoveredSample> under = std::span(samples_).subspan(list.first, list.count);
    keen.clear();
    for (std::size_t first = 0; first < under.size(); first += chunk) {
      const auto part = under.subspan(first, std::min(chunk, under.size() - first));
      const auto [low, high] = std::ranges::minmax_element(
          part, {}, [&](const CoveredSample& sample) { return plane.error_m(sample); });
      const auto number = [&](const auto& it) {
        return first + static_cast<std::size_t>(it - part.begin());
      };
      keen.push_back(std::min(number(low), number(high)));
      if (low != high) keen.push_back(std::max(number(low), number(high)));
    }
    for (const std::size_t k : keen) std::swap(under[list.keen++], under[k]);
  }
}

void CoveredSamples::share_out(std::span<const TriangleId> triangles,
                               std::span<const CoveredSample> samples, std::size_t keen_count,
                               std::span<const std::uint32_t> sector) {
  for (const TriangleId t : triangles) clear(t);
  if (samples_.size() + samples.size() > most_with_gaps()) compact();
  for (std::size_t k = 0; k < samples.size(); ++k) ++lists_[triangles[sector[k]]].count;
  for (std::size_t k = 0; k < keen_count; ++k) ++lists_[triangles[sector[k]]].keen;
  std::size_t first = samples_.size();
  samples_.resize(first + samples.size());
  for (const TriangleId t : triangles) {
    lists_[t].first = first;
    first += std::exchange(lists_[t].count, 0);
  }
  // keen ones come first among all, so they do in each list
  for (std::size_t k = 0; k < samples.size(); ++k) {
    List& list = lists_[triangles[sector[k]]];
    samples_[list.first + list.count++] = samples[k];
  }
}

std::size_t CoveredSamples::most_with_gaps() const {
  return count_ * (count_ < kFew ? kMostGapsIfFew : kMostGaps);
}

void CoveredSamples::compact() {
  std::vector<CoveredSample> kept;
  kept.reserve(most_with_gaps());
  for (List& list : lists_) {
    const auto begin = samples_.begin() + static_cast<std::ptrdiff_t>(list.first);
    list.first = kept.size();
    kept.insert(kept.end(), begin, begin + list.count);
  }
  samples_ = std::move(kept);
}

}  // namespace terrane::hierarchy
