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

bool ViewJudge::may_be_in_view(const Eigen::Vector3d& to_centre, double radius) const {
  const double depth = to_centre.dot(camera_.forward);
  if (depth + radius <= 0) return false;
  const double x = std::abs(to_centre.dot(camera_.right)), y = std::abs(to_centre.dot(up_));
  return x - depth * tan_x_ <= radius * side_x_ && y - depth * tan_y_ <= radius * side_y_;
}

double ViewJudge::pixels_per_unit(const Eigen::Vector3d& to_centre, double radius,
                                  bool is_in_view) const {
  const double distance = to_centre.norm();
  if (!is_in_view) {
    return distance > radius ? pixels_per_tangent_ / (distance - radius) : kInfinity;
  }
  // a step e from a point at distance r and depth z to one at depth z' moves the picture by
  // at most K e r / (z z'); in the picture r / z is that of its corners at most
  const double depth = to_centre.dot(camera_.forward) - radius;
  if (depth <= 0) return kInfinity;
  const double secant = std::min((distance + radius) / depth, largest_secant_);
  return pixels_per_tangent_ * secant / depth;
}

/// Largest less smallest brightness of (N . H)^s over a cone of normals.
double ViewJudge::highlight_contrast(const Eigen::Vector3d& to_eye, double eye_spread,
                                     const Eigen::Vector3d& axis, double angle) const {
  const Eigen::Vector3d half = to_eye + criteria_.to_light;
  const double length = half.norm();
  if (length < 1e-6) return 1;
  // the half vector turns by no more than the direction to the eye does
  const double off = std::acos(std::clamp(half.dot(axis) / length, -1.0, 1.0));
  const double spread = angle + eye_spread;
  const auto brightness = [&](double theta) {
    return theta >= kPi / 2 ? 0 : std::pow(std::cos(theta), criteria_.shininess);
  };
  return brightness(std::max(0.0, off - spread)) - brightness(off + spread);
}

bool ViewJudge::allows(std::uint32_t centre, const Ranges& ranges) const {
  const Eigen::Vector3d to_centre = tree_.place(centre).cast<double>() - camera_.eye;
  const bool is_in_view = may_be_in_view(to_centre, ranges.radius);
  if (criteria_.frustum && !is_in_view) return true;

  double tolerance = criteria_.tolerance_px;
  bool has_highlight = false;
  if (needs_normals_) {
    const double distance = to_centre.norm();
    // inside the sphere the eye may be in any direction
    const double eye_spread = distance > ranges.radius ? std::asin(ranges.radius / distance) : kPi;
    const Eigen::Vector3d axis = tree_.normals[centre].cast<double>();
    const Eigen::Vector3d to_eye = -to_centre / std::max(distance, 1e-300);
    const double off = std::acos(std::clamp(to_eye.dot(axis), -1.0, 1.0));
    const double spread = ranges.angle + eye_spread;
    if (criteria_.back_faces && off - spread > kPi / 2) return true;
    const bool may_be_silhouette = off - spread <= kPi / 2 && off + spread >= kPi / 2;
    if (criteria_.silhouette_px && may_be_silhouette) {
      tolerance = std::min(tolerance, *criteria_.silhouette_px);
    }
    has_highlight =
        criteria_.highlight_px &&
        highlight_contrast(to_eye, eye_spread, axis, ranges.angle) > criteria_.highlight_contrast;
  }
  const double scale = pixels_per_unit(to_centre, ranges.radius, is_in_view) * kMargin;
  const auto shows = [&](double length, double limit) {
    return length > 0 && length * scale > limit;
  };
  const bool is_error = criteria_.measure == ScreenMeasure::kError;
  if (shows(is_error ? ranges.error : ranges.switched, tolerance)) return false;
  return !has_highlight || !shows(ranges.switched, *criteria_.highlight_px);
}

bool ViewJudge::allows(std::uint32_t i) const {
  const MergeBounds& b = tree_.bounds[i];
  return allows(tree_.centre(i), {b.error, b.switched, b.radius, b.angle});
}

bool ViewJudge::allows_all(std::uint32_t i) const {
  const MergeBounds& b = tree_.bounds[i];
  return allows(tree_.centre(i), {b.all_error, b.all_switched, b.all_radius, b.all_angle});
}

}  // namespace terrane::hierarchy
