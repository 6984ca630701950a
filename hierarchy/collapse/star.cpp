#include "hierarchy/collapse/star.h"

#include <algorithm>

namespace terrane::hierarchy {

void Star::gather_few(const Stencil& stencil, const HalfedgeMesh& mesh,
                      std::span<const TerrainVertex> vertices, const CoveredSamples& samples) {
  origin_ = vertices[index(stencil.core[0])].place;
  gather_polygon(stencil, mesh, vertices);
  dying_count_ = 0;
  for (const HalfedgeId h : stencil.dying_span()) {
    dying_[dying_count_++] = HalfedgeMesh::triangle(h);
  }
  if (stencil.core_size == 3) {
    dying_[dying_count_++] = HalfedgeMesh::triangle(mesh.opposite(stencil.dying[0]));
  }
  sample_count_ = 0;
  if (samples.has_keen()) {
    for (const TriangleId t : dying()) add(samples.keen_under(t));
    for (const TriangleId t : triangles()) add(samples.keen_under(t));
    keen_count_ = sample_count_;
  } else {
    for (const TriangleId t : dying()) add(samples.others_under(t));
    keen_count_ = 0;
  }
  pad_samples();
}

void Star::gather_rest(const CoveredSamples& samples) {
  if (samples.has_keen()) {
    for (const TriangleId t : dying()) add(samples.others_under(t));
  }
  for (const TriangleId t : triangles()) add(samples.others_under(t));
  pad_samples();
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
  for (std::size_t k = last + 1; k <= last + kPadding; ++k) {
    corner_x_[k] = corner_x_[last];
    corner_y_[k] = corner_y_[last];
    corner_z_[k] = corner_z_[last];
  }
}

void Star::make_room_for_corners(std::size_t count) {
  if (count + kPadding <= corner_x_.size()) return;
  const std::size_t size = std::max<std::size_t>(64, 2 * (count + kPadding));
  corner_x_.resize(size);
  corner_y_.resize(size);
  corner_z_.resize(size);
  corners_.resize(size);
  triangles_.resize(size);
}

void Star::pad_samples() {
  if (sample_count_ == 0) return;
  for (std::size_t k = sample_count_; k % kPadding != 0; ++k) {
    sample_x_[k] = sample_x_[sample_count_ - 1];
    sample_y_[k] = sample_y_[sample_count_ - 1];
    sample_z_[k] = sample_z_[sample_count_ - 1];
  }
}

void Star::add(std::span<const CoveredSample> samples) {
  const double column = column_of(origin_.plan), row = row_of(origin_.plan);
  while (sample_count_ + samples.size() + kPadding > samples_.size()) make_room_for_samples();
  // locals: as members, every store would reload them
  const double height_m = origin_.height_m;
  CoveredSample* copy = samples_.data() + sample_count_;
  float* x = sample_x_.data() + sample_count_;
  float* y = sample_y_.data() + sample_count_;
  float* z = sample_z_.data() + sample_count_;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const CoveredSample sample = samples[k];
    copy[k] = sample;
    x[k] = static_cast<float>(sample.column - column);
    y[k] = static_cast<float>(row - sample.row);
    z[k] = static_cast<float>(sample.height_m - height_m);
  }
  sample_count_ += samples.size();
}

void Star::make_room_for_samples() {
  const std::size_t size = std::max<std::size_t>(256, 2 * samples_.size());
  samples_.resize(size);
  sample_x_.resize(size);
  sample_y_.resize(size);
  sample_z_.resize(size);
}

}  // namespace terrane::hierarchy
