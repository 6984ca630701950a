#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// A perspective camera, in the frame of a tree: relative to its lattice's origin.
struct Camera {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = -Eigen::Vector3d::UnitZ();  ///< unit
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();     ///< unit, at a right angle to forward
  double vertical_fov_deg = 45;                         ///< above 0, below 180
  double width_px = 1280, height_px = 720;

  /// \param up  need not be at a right angle to the view.
  /// \throws ConfigError if eye and target are one point, or up runs along the view.
  static Camera looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                           const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());
};

/// What is compared with the tolerance on the screen.
enum class ScreenMeasure : std::uint8_t {
  kError,           ///< the error: strict
  kSwitchDistance,  ///< the switch distance, as published: how long edges look
};

/// What makes detail necessary. A merge is refused if any of them wants it undone.
struct ViewCriteria {
  ScreenMeasure measure = ScreenMeasure::kError;
  double tolerance_px = 1;
  /// Outside the view frustum nothing is wanted.
  bool frustum = false;
  /// What faces away as a whole is not wanted.
  bool back_faces = false;
  /// Tolerance for what may hold a silhouette, if it is smaller.
  std::optional<double> silhouette_px;
  /// Where the highlight varies: longest switch distance on the screen.
  std::optional<double> highlight_px;
  /// Where the colour varies: likewise.
  std::optional<double> colour_px;
  double colour_contrast = 0.1;     ///< range of red, green or blue within a merge, 0 to 1
  double highlight_contrast = 0.1;  ///< of the highlight's brightness within a merge, 0 to 1
  double shininess = 20;            ///< exponent of the highlight
  Eigen::Vector3d to_light = Eigen::Vector3d(0.3, 0.4, 0.866);  ///< unit, from the surface
};

/// Judges merges for one frame.
///
/// Screen distances are in pixels of the flat picture, whatever the direction, for all that may
/// be in view; else in pixels at the middle of the picture. They are upper bounds over the
/// sphere of a merge: what is shown at a distance below the tolerance from where it is, is so
/// drawn.
/// \par Source
/// Xia and Varshney 1996, sections 3 and 5.1.
class ViewJudge {
 public:
  ViewJudge(const MergeTree& tree, const Camera& camera, const ViewCriteria& criteria);

  /// May merge i be made?
  bool allows(std::uint32_t i) const;
  /// May all of them, i and what has to be made before it? Never true where one of them may not.
  bool allows_all(std::uint32_t i) const;

 private:
  /// How a cone of normals stands to the directions from which the eye may see a sphere: `off` is
  /// between the middles of both, `spread` as much as both together stray from them.
  struct Facing {
    double cos_off, cos_spread, sin_spread;
    bool turns_away() const { return cos_spread > 0 && cos_off < -sin_spread; }
    bool may_be_silhouette() const {
      return !turns_away() && (cos_spread <= 0 || cos_off <= sin_spread);
    }
  };
  bool allows(const ViewRanges& merge, const ViewRanges::Ranges& ranges) const;
  static Facing facing(const Eigen::Vector3d& to_eye, double sin_eye_spread,
                       const Eigen::Vector3d& axis, const ViewRanges::Ranges& ranges);
  /// Pixels that a unit of length takes at most in a sphere; infinite if the camera is inside.
  double pixels_per_unit(double distance, double depth, double radius, bool is_in_view) const;
  bool may_be_in_view(const Eigen::Vector3d& to_centre, double depth, double radius) const;
  double highlight_contrast(const Eigen::Vector3d& to_eye, double sin_eye_spread,
                            const Eigen::Vector3d& axis, const ViewRanges::Ranges& ranges) const;

  const MergeTree& tree_;
  Camera camera_;
  ViewCriteria criteria_;
  Eigen::Vector3d up_;
  double pixels_per_tangent_, tan_x_, tan_y_;
  double side_x_, side_y_;  // 1 / cos of the half angles of view
  double largest_secant_;   // 1 / cos at the picture's corners
  bool needs_normals_;
};

}  // namespace terrane::hierarchy
