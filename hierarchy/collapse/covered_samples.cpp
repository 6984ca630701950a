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
  std::vector<std::uint32_t> number(field.heights_m.size(), kNone);
  const auto claim = [&](TriangleId t, std::int64_t column, std::int64_t row) {
    std::uint32_t& sample = number[static_cast<std::size_t>(row * field.columns + column)];
    const double height_m = field.row(row)[column];
    if (sample != kNone || std::isnan(height_m)) return;
    sample = static_cast<std::uint32_t>(samples_.size());
    samples_.push_back({static_cast<float>(column), static_cast<float>(row), kNone, height_m});
    add(t, sample);
  };
  // twice: what lies beside the outline goes to a triangle only when none has it for its own
  constexpr double kOnEdge_cells = 1e-7;
  for (const double slack_cells : {kOnEdge_cells, field.slack_cells}) {
    if (samples_.size() == field.heights_m.size()) break;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      for_each_span(plan_of(vertices[a]), plan_of(vertices[b]), plan_of(vertices[c]), field,
                    slack_cells, [&](std::int64_t row, std::int64_t begin, std::int64_t last) {
                      for (auto column = begin; column <= last; ++column) {
                        claim(TriangleId{t}, column, row);
                      }
                      return true;
                    });
    }
  }
}

}  // namespace terrane::hierarchy
