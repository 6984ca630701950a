#include "hierarchy/collapse/covered_samples.h"

namespace terrane::hierarchy {
namespace {

FieldPoint plan_of(const TerrainVertex& vertex) {
  return {column_of(vertex.place.plan), row_of(vertex.place.plan), 0};
}

}  // namespace

CoveredSamples::CoveredSamples(const SampleField& field, std::span<const TerrainVertex> vertices,
                               std::span<const Corners> triangles, std::size_t triangle_capacity)
    : first_(triangle_capacity, kNone) {
  const std::size_t all = std::max(field.heights_m.size(), field.kept.size());
  std::vector<bool> is_claimed(all, false);
  // twice: what lies beside the outline goes to a triangle only when none has it for its own
  constexpr double kOnEdge_cells = 1e-7;
  for (const double slack_cells : {kOnEdge_cells, field.slack_cells}) {
    if (samples_.size() == all) break;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      for_each_sample(plan_of(vertices[a]), plan_of(vertices[b]), plan_of(vertices[c]), field,
                      slack_cells, [&](std::size_t number, const FieldSample& sample) {
                        if (!is_claimed[number]) claim(TriangleId{t}, sample);
                        is_claimed[number] = true;
                        return true;
                      });
    }
  }
}

void CoveredSamples::claim(TriangleId t, const FieldSample& sample) {
  samples_.push_back({sample.column, sample.row, kNone, sample.height_m});
  add(t, static_cast<std::uint32_t>(samples_.size() - 1));
}

}  // namespace terrane::hierarchy
