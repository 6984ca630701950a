#include "hierarchy/levels/level_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/BVH>

#include "hierarchy/levels/build_levels.h"

namespace terrane::hierarchy {
namespace {

using Boxes = Eigen::KdBVH<double, 3, std::uint32_t>;

double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d side = b - a;
  const double length2 = side.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(side) / length2, 0.0, 1.0) : 0;
  return (p - a - t * side).squaredNorm();
}

/// Walks the boxes that are nearer than the nearest triangle so far.
class NearestTriangle {
 public:
  NearestTriangle(const SurfaceMesh& mesh, const Eigen::Vector3d& point) : mesh_(mesh), p_(point) {}

  bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    return box.squaredExteriorDistance(p_) < nearest2_;
  }
  bool intersectObject(std::uint32_t t) {
    const auto [a, b, c] = mesh_.triangles[t];
    nearest2_ = std::min(nearest2_,
                         squared_distance(p_, mesh_.points[a], mesh_.points[b], mesh_.points[c]));
    return false;
  }
  double squared() const { return nearest2_; }

 private:
  const SurfaceMesh& mesh_;
  Eigen::Vector3d p_;
  double nearest2_ = std::numeric_limits<double>::infinity();
};

Boxes boxes_of(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> numbers(mesh.triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(numbers.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    boxes.emplace_back(mesh.points[a]);
    boxes.back().extend(mesh.points[b]);
    boxes.back().extend(mesh.points[c]);
  }
  return {numbers.begin(), numbers.end(), boxes.begin(), boxes.end()};
}

/// The triangles at each vertex.
class Incidence {
 public:
  explicit Incidence(const SurfaceMesh& mesh)
      : begin_(mesh.points.size() + 1, 0), list_(mesh.triangles.size() * 3) {
    for (const Corners& corners : mesh.triangles) {
      for (const std::uint32_t v : corners) ++begin_[v + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) list_[next[v]++] = t;
    }
  }
  std::span<const std::uint32_t> of(std::uint32_t v) const {
    return {list_.data() + begin_[v], list_.data() + begin_[v + 1]};
  }

 private:
  std::vector<std::uint32_t> begin_, list_;
};

double plan_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  // over the triangle, the plane is nearest; else one of the sides
  const bool is_over = n.dot((b - a).cross(p - a)) > 0 && n.dot((c - b).cross(p - b)) > 0 &&
                       n.dot((a - c).cross(p - c)) > 0;
  if (is_over) {
    const double along = n.dot(p - a);
    return along * along / n.squaredNorm();
  }
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

std::vector<std::uint32_t> representatives(const LevelSequence& sequence, std::uint32_t level) {
  std::size_t count = sequence.coarsest_points.size();
  for (const auto& collapses : sequence.levels) count += 2 * collapses.size();
  std::vector<std::uint32_t> result(count);
  std::iota(result.begin(), result.end(), 0U);
  for (std::uint32_t i = level; i-- > 0;) {
    for (const Collapse& collapse : sequence.levels[i]) {
      result[collapse.corners[1]] = result[collapse.corners[2]] = result[collapse.corners[0]];
    }
  }
  return result;
}

/// Vertices of M_0 in square buckets of plan, about one a bucket.
class LevelErrorMeter::PlanGrid {
 public:
  explicit PlanGrid(const SurfaceMesh& finest) : points_(finest.points) {
    const auto [a, b, c] = finest.triangles.front();
    sign_ = plan_area(points_[a], points_[b], points_[c]) > 0 ? 1 : -1;
    for (const Eigen::Vector3d& p : points_) box_.extend(p.head<2>());
    const Eigen::Vector2d size = box_.sizes();
    cell_ = std::sqrt(size.x() * size.y() / static_cast<double>(points_.size()));
    columns_ = static_cast<std::size_t>(size.x() / cell_) + 1;
    rows_ = static_cast<std::size_t>(size.y() / cell_) + 1;
    buckets_.resize(columns_ * rows_);
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
      buckets_[row(points_[v].y()) * columns_ + column(points_[v].x())].push_back(v);
    }
  }

  LevelError::Vertical measure(const SurfaceMesh& mesh) const {
    std::vector<double> error(points_.size(), std::numeric_limits<double>::infinity());
    LevelError::Vertical result;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
      if (sign_ * plan_area(p, q, r) > 0) {
        drop_onto(p, q, r, error);
      } else {
        ++result.folded;
      }
    }
    double sum2 = 0;
    for (const double e : error) {
      if (std::isinf(e)) {
        ++result.uncovered;
        continue;
      }
      result.max = std::max(result.max, e);
      sum2 += e * e;
    }
    const auto covered = static_cast<double>(points_.size() - result.uncovered);
    result.rms = covered > 0 ? std::sqrt(sum2 / covered) : 0;
    return result;
  }

 private:
  std::size_t column(double x) const { return bucket(x - box_.min().x(), columns_); }
  std::size_t row(double y) const { return bucket(y - box_.min().y(), rows_); }
  std::size_t bucket(double offset, std::size_t count) const {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, offset / cell_)));
  }

  /// Lowers the error of the vertices over or under a triangle to their distance from it along z.
  void drop_onto(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                 std::vector<double>& error) const {
    const double area = plan_area(p, q, r);
    const auto [left, right] = std::minmax({p.x(), q.x(), r.x()});
    const auto [low, high] = std::minmax({p.y(), q.y(), r.y()});
    for (std::size_t j = row(low); j <= row(high); ++j) {
      for (std::size_t i = column(left); i <= column(right); ++i) {
        for (const std::uint32_t v : buckets_[j * columns_ + i]) {
          const Eigen::Vector3d& s = points_[v];
          const double wp = plan_area(q, r, s), wq = plan_area(r, p, s), wr = plan_area(p, q, s);
          if (sign_ * wp < 0 || sign_ * wq < 0 || sign_ * wr < 0) continue;
          const double z = (wp * p.z() + wq * q.z() + wr * r.z()) / area;
          error[v] = std::min(error[v], std::abs(z - s.z()));
        }
      }
    }
  }

  const std::vector<Eigen::Vector3d>& points_;
  double sign_ = 1;
  Eigen::AlignedBox2d box_;
  double cell_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::uint32_t>> buckets_;
};

LevelErrorMeter::LevelErrorMeter(const LevelSequence& sequence)
    : sequence_(sequence), finest_([&] {
        LevelRebuilder rebuilder(sequence);
        rebuilder.refine_to(0);
        return rebuilder.mesh();
      }()) {
  if (is_height_field(finest_)) plan_ = std::make_unique<PlanGrid>(finest_);
}

LevelErrorMeter::~LevelErrorMeter() = default;

LevelError LevelErrorMeter::measure(const SurfaceMesh& mesh, std::uint32_t level) const {
  LevelError error;
  add_distances(mesh, level, error);
  if (plan_) error.vertical = plan_->measure(mesh);
  return error;
}

void LevelErrorMeter::add_distances(const SurfaceMesh& mesh, std::uint32_t level,
                                    LevelError& error) const {
  const Boxes boxes = boxes_of(mesh);
  const Incidence incidence(mesh);
  const std::vector<std::uint32_t> near = representatives(sequence_, level);
  std::vector<double> squared(finest_.points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, squared.size(), 1024),
                    [&](const auto& part) {
                      for (std::size_t v = part.begin(); v < part.end(); ++v) {
                        NearestTriangle nearest(mesh, finest_.points[v]);
                        // the surface about the vertex that v went into is near: most boxes are
                        // then out at once
                        for (const std::uint32_t t : incidence.of(near[v]))
                          nearest.intersectObject(t);
                        Eigen::BVIntersect(boxes, nearest);
                        squared[v] = nearest.squared();
                      }
                    });
  double sum = 0;
  for (const double d2 : squared) {
    error.max = std::max(error.max, std::sqrt(d2));
    sum += d2;
  }
  error.rms = std::sqrt(sum / static_cast<double>(squared.size()));
}

}  // namespace terrane::hierarchy
