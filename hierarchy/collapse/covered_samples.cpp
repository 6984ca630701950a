#include "hierarchy/collapse/covered_samples.h"

#include <utility>

namespace terrane::hierarchy {
namespace {

// numbers_ may hold so many times the samples before the gaps in it are closed
constexpr std::size_t kMostGaps = 3;

FieldPoint plan_of(const TerrainVertex& vertex) {
  return {column_of(vertex.place.plan), row_of(vertex.place.plan), 0};
}

}  // namespace

CoveredSamples::CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                               std::span<const Corners> triangles, std::size_t triangle_capacity)
    : lists_(triangle_capacity) {
  const std::size_t all = std::max(field.heights_m.size(), field.kept.size());
  std::vector<bool> is_claimed(all, false);
  std::vector<std::uint32_t> owner;
  samples_.reserve(all);
  owner.reserve(all);
  // twice: what lies beside the outline goes to a triangle only when none has it for its own
  constexpr double kOnEdge_cells = 1e-7;
  for (const double slack_cells : {kOnEdge_cells, field.slack_cells}) {
    if (samples_.size() == all) break;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      for_each_sample(plan_of(vertices[a]), plan_of(vertices[b]), plan_of(vertices[c]), field,
                      slack_cells, [&](std::size_t number, const FieldSample& sample) {
                        if (is_claimed[number]) return true;
                        is_claimed[number] = true;
                        samples_.push_back({sample.column, sample.row, sample.height_m});
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
  numbers_.resize(samples_.size());
  for (std::uint32_t s = 0; s < owner.size(); ++s) {
    List& list = lists_[TriangleId{owner[s]}];
    numbers_[list.first + list.count++] = s;
  }
}

void CoveredSamples::share_out(std::span<const TriangleId> triangles,
                               std::span<const std::uint32_t> samples,
                               std::span<const std::uint32_t> sector) {
  for (const TriangleId t : triangles) clear(t);
  if (numbers_.size() + samples.size() > kMostGaps * samples_.size()) compact();
  for (std::size_t k = 0; k < samples.size(); ++k) ++lists_[triangles[sector[k]]].count;
  std::size_t first = numbers_.size();
  numbers_.resize(first + samples.size());
  for (const TriangleId t : triangles) {
    lists_[t].first = first;
    first += std::exchange(lists_[t].count, 0);
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    List& list = lists_[triangles[sector[k]]];
    numbers_[list.first + list.count++] = samples[k];
  }
}

void CoveredSamples::compact() {
  std::vector<std::uint32_t> kept;
  kept.reserve(kMostGaps * samples_.size());
  for (List& list : lists_) {
    const auto begin = numbers_.begin() + static_cast<std::ptrdiff_t>(list.first);
    list.first = kept.size();
    kept.insert(kept.end(), begin, begin + list.count);
  }
  numbers_ = std::move(kept);
}

}  // namespace terrane::hierarchy
