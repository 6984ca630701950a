#include "hierarchy/collapse/star.h"

#include <algorithm>

namespace terrane::hierarchy {

void Star::gather(const Stencil& stencil, const HalfedgeMesh& mesh,
                  std::span<const TerrainVertex> vertices, const CoveredSamples& samples) {
  origin_ = vertices[index(stencil.core[0])].place;
  gather_polygon(stencil, mesh, vertices);
  gather_samples(stencil, mesh, samples);
}

void Star::gather_polygon(const Stencil& stencil, const HalfedgeMesh& mesh,
                          std::span<const TerrainVertex> vertices) {
  const auto& polygon = stencil.polygon;
  const std::size_t count = polygon.size();
  std::size_t ghost = 0;
  while (ghost < count && !mesh.is_ghost(polygon[ghost])) ++ghost;
  is_closed_ = ghost == count;
  sector_count_ = is_closed_ ? count : count - 2;
  make_room_for_corners(sector_count_ + 1);

  std::size_t i = is_closed_ ? 0 : (ghost + 1) % count;
  for (std::size_t k = 0; k <= sector_count_; ++k) {
    const Place& place = vertices[index(polygon[i])].place;
    const Centre at = centre(place.plan);
    corner_x_[k] = at.x;
    corner_y_[k] = at.y;
    corner_z_[k] = static_cast<float>(place.height_m - origin_.height_m);
    corners_[k] = &place;
    triangles_[k] = HalfedgeMesh::triangle(stencil.spokes[i]);
    if (++i == count) i = 0;
  }
  const std::size_t last = sector_count_;
  for (std::size_t k = last + 1; k <= last + kLanes; ++k) {
    corner_x_[k] = corner_x_[last];
    corner_y_[k] = corner_y_[last];
    corner_z_[k] = corner_z_[last];
  }
}

void Star::make_room_for_corners(std::size_t count) {
  if (count + kLanes <= corner_x_.size()) return;
  const std::size_t size = std::max<std::size_t>(64, 2 * (count + kLanes));
  corner_x_.resize(size);
  corner_y_.resize(size);
  corner_z_.resize(size);
  corners_.resize(size);
  triangles_.resize(size);
}

Star::Centre Star::centre(GridPoint plan) const {
  constexpr float kCellsPerUnit = 1.0F / kUnitsPerCell;
  return {static_cast<float>(plan.x - origin_.plan.x) * kCellsPerUnit,
          static_cast<float>(plan.y - origin_.plan.y) * kCellsPerUnit};
}

void Star::gather_samples(const Stencil& stencil, const HalfedgeMesh& mesh,
                          const CoveredSamples& samples) {
  sample_count_ = 0;
  // the triangles that die first: their samples are near the new centre and refuse most
  for (const HalfedgeId h : stencil.dying_span()) {
    gather_samples(HalfedgeMesh::triangle(h), samples);
  }
  if (stencil.core_size == 3) {
    gather_samples(HalfedgeMesh::triangle(mesh.opposite(stencil.dying[0])), samples);
  }
  for (std::size_t k = 0; k < sector_count_; ++k) gather_samples(triangles_[k], samples);
  if (sample_count_ == 0) return;
  for (std::size_t k = sample_count_; k % kLanes != 0; ++k) {
    sample_x_[k] = sample_x_[sample_count_ - 1];
    sample_y_[k] = sample_y_[sample_count_ - 1];
    sample_z_[k] = sample_z_[sample_count_ - 1];
  }
}

void Star::gather_samples(TriangleId triangle, const CoveredSamples& samples) {
  const double column = column_of(origin_.plan), row = row_of(origin_.plan);
  const std::span<const std::uint32_t> under = samples.under(triangle);
  while (sample_count_ + under.size() + kLanes > samples_.size()) make_room_for_samples();
  std::size_t k = sample_count_;
  for (const std::uint32_t s : under) {
    const CoveredSample& sample = samples[s];
    samples_[k] = s;
    sample_x_[k] = static_cast<float>(sample.column - column);
    sample_y_[k] = static_cast<float>(row - sample.row);
    sample_z_[k] = static_cast<float>(sample.height_m - origin_.height_m);
    ++k;
  }
  sample_count_ = k;
}

void Star::make_room_for_samples() {
  const std::size_t size = std::max<std::size_t>(256, 2 * samples_.size());
  samples_.resize(size);
  sample_x_.resize(size);
  sample_y_.resize(size);
  sample_z_.resize(size);
}

}  // namespace terrane::hierarchy
