#include "hierarchy/merge/view_criteria.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

// of rounding in what is worked out here, far above what doubles need
constexpr double kMargin = 1 + 1e-9;

}  // namespace

Camera Camera::looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                          const Eigen::Vector3d& up) {
  Camera camera;
  const Eigen::Vector3d along = target - eye;
  const Eigen::Vector3d right = along.cross(up);
  if (!(right.norm() > 1e-12 * along.norm() * up.norm())) {
    throw ConfigError("camera: eye and target are one point, or up runs along the view. Move one");
  }
  camera.eye = eye;
  camera.forward = along.normalized();
  camera.right = right.normalized();
  return camera;
}

ViewJudge::ViewJudge(const MergeTree& tree, const Camera& camera, const ViewCriteria& criteria)
    : tree_(tree),
      camera_(camera),
      criteria_(criteria),
      up_(camera.right.cross(camera.forward)),
      tan_y_(std::tan(camera.vertical_fov_deg * kPi / 360)) {
  tan_x_ = tan_y_ * camera.width_px / camera.height_px;
  pixels_per_tangent_ = camera.height_px / (2 * tan_y_);
  side_x_ = std::hypot(1, tan_x_);
  side_y_ = std::hypot(1, tan_y_);
  largest_secant_ = std::sqrt(1 + tan_x_ * tan_x_ + tan_y_ * tan_y_);
  needs_normals_ = criteria.back_faces || criteria.silhouette_px || criteria.highlight_px;
}

bool ViewJudge::may_be_in_view(const Eigen::Vector3d& to_centre, double depth,
                               double radius) const {
  if (depth + radius <= 0) return false;
  const double x = std::abs(to_centre.dot(camera_.right)), y = std::abs(to_centre.dot(up_));
  return x - depth * tan_x_ <= radius * side_x_ && y - depth * tan_y_ <= radius * side_y_;
}

double ViewJudge::pixels_per_unit(double distance, double depth, double radius,
                                  bool is_in_view) const {
  if (!is_in_view) {
    return distance > radius ? pixels_per_tangent_ / (distance - radius) : kInfinity;
  }
  // a step e from a point at distance r and depth z to one at depth z' moves the picture by
  // at most K e r / (z z'); in the picture r / z is that of its corners at most
  const double nearest = depth - radius;
  if (nearest <= 0) return kInfinity;
  const double secant = std::min((distance + radius) / nearest, largest_secant_);
  return pixels_per_tangent_ * secant / nearest;
}

ViewJudge::Facing ViewJudge::facing(const Eigen::Vector3d& to_eye, double sin_eye_spread,
                                    const Eigen::Vector3d& axis, const ViewRanges::Ranges& ranges) {
  const double cos_off = to_eye.dot(axis);
  // inside the sphere the eye may be in any direction
  if (sin_eye_spread >= 1) return {cos_off, -1, 0};
  // cosine and sine of the sum of both angles, which is below 3 pi / 2
  const double cos_eye_spread = std::sqrt(1 - sin_eye_spread * sin_eye_spread);
  const double t = ranges.half_angle_tangent, unit = 1 / (1 + t * t);
  const double cos_angle = (1 - t * t) * unit, sin_angle = 2 * t * unit;
  return {cos_off, cos_angle * cos_eye_spread - sin_angle * sin_eye_spread,
          sin_angle * cos_eye_spread + cos_angle * sin_eye_spread};
}

/// Largest less smallest brightness of (N . H)^s over a cone of normals.
double ViewJudge::highlight_contrast(const Eigen::Vector3d& to_eye, double sin_eye_spread,
                                     const Eigen::Vector3d& axis,
                                     const ViewRanges::Ranges& ranges) const {
  const Eigen::Vector3d half = to_eye + criteria_.to_light;
  const double length = half.norm();
  if (length < 1e-6) return 1;
  // the half vector turns by no more than the direction to the eye does
  const Facing f = facing(half / length, sin_eye_spread, axis, ranges);
  const double sin_off = std::sqrt(std::max(0.0, 1 - f.cos_off * f.cos_off));
  const auto brightness = [&](double cosine) {
    return cosine <= 0 ? 0 : std::pow(cosine, criteria_.shininess);
  };
  const bool is_half_turn = f.cos_spread <= 0;  // the spread is a right angle or more
  const bool reaches_middle = (is_half_turn && f.sin_spread <= 0) || f.cos_off >= f.cos_spread;
  const double nearest =
      reaches_middle ? 1 : brightness(f.cos_off * f.cos_spread + sin_off * f.sin_spread);
  const double farthest =
      is_half_turn ? 0 : brightness(f.cos_off * f.cos_spread - sin_off * f.sin_spread);
  return nearest - farthest;
}

bool ViewJudge::allows(const ViewRanges& merge, const ViewRanges::Ranges& ranges) const {
  const auto vector = [](const std::array<float, 3>& v) {
    return Eigen::Vector3d(v[0], v[1], v[2]);
  };
  const Eigen::Vector3d to_centre = vector(merge.place) - camera_.eye;
  const double depth = to_centre.dot(camera_.forward);
  const bool is_in_view = may_be_in_view(to_centre, depth, ranges.radius);
  if (criteria_.frustum && !is_in_view) return true;

  const double distance = to_centre.norm();
  double tolerance = criteria_.tolerance_px;
  bool has_highlight = false;
  if (needs_normals_) {
    const Eigen::Vector3d to_eye = -to_centre / std::max(distance, 1e-300);
    const double sin_eye_spread = distance > ranges.radius ? ranges.radius / distance : 1;
    const Eigen::Vector3d axis = vector(merge.axis);
    const Facing f = facing(to_eye, sin_eye_spread, axis, ranges);
    if (criteria_.back_faces && f.turns_away()) return true;
    if (criteria_.silhouette_px && f.may_be_silhouette()) {
      tolerance = std::min(tolerance, *criteria_.silhouette_px);
    }
    has_highlight =
        criteria_.highlight_px &&
        highlight_contrast(to_eye, sin_eye_spread, axis, ranges) > criteria_.highlight_contrast;
  }
  const double scale = pixels_per_unit(distance, depth, ranges.radius, is_in_view) * kMargin;
  const auto shows = [&](double length, double limit) {
    return length > 0 && length * scale > limit;
  };
  const bool is_error = criteria_.measure == ScreenMeasure::kError;
  if (shows(is_error ? ranges.error : ranges.switched, tolerance)) return false;
  if (has_highlight && shows(ranges.switched, *criteria_.highlight_px)) return false;
  const bool varies = criteria_.colour_px && ranges.colour > criteria_.colour_contrast;
  return !varies || !shows(ranges.switched, *criteria_.colour_px);
}

bool ViewJudge::allows(std::uint32_t i) const {
  const ViewRanges& merge = tree_.view_ranges[i];
  return allows(merge, merge.own);
}

bool ViewJudge::allows_all(std::uint32_t i) const {
  const ViewRanges& merge = tree_.view_ranges[i];
  return allows(merge, merge.all);
}

}  // namespace terrane::hierarchy
