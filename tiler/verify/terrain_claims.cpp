#include "tiler/verify/terrain_claims.h"

#include <fmt/format.h>

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>

namespace terrane::verify {
namespace {

class Claims {
 public:
  Claims(const TerrainFile& tile, const std::vector<Eigen::Vector3d>& ecef)
      : tile_(tile), ecef_(ecef) {}

  std::vector<FaultFound> run() {
    check_sphere();
    check_horizon();
    check_normals();
    return std::move(found_);
  }

 private:
  void note(TerrainFault fault, std::int64_t count, std::string what) {
    found_.push_back({fault, count, std::move(what)});
  }

  void check_sphere() {
    const Eigen::Vector3d centre(tile_.sphere_centre.data());
    const auto outside = std::ranges::count_if(ecef_, [&](const Eigen::Vector3d& at) {
      return !((at - centre).norm() <= tile_.sphere_radius_m);
    });
    if (outside == 0) return;
    note(TerrainFault::kSpheres, 1,
         fmt::format("{} vertices are outside its bounding sphere", outside));
  }

  /// From a distance, a point is over the horizon for cameras in a cap around it: one of the angle
  /// whose cosine is 1 / distance, wider for all points alike as the camera is nearer. So the cap
  /// of each vertex must lie in that of the occlusion point.
  void check_horizon() {
    const Eigen::Vector3d point(tile_.horizon.data());
    // where a vertex is seen from half-way round the Earth, no point will do: far out it must be
    constexpr double kFarOut = 100, kSlack_rad = 1e-7;
    const double cap = point.norm() > 1 ? std::acos(1 / point.norm()) : 0;
    double widest = 0;
    for (const Eigen::Vector3d& at : ecef_) {
      const Eigen::Vector3d scaled = at.cwiseQuotient(Eigen::Vector3d(
          GeographicLib::Constants::WGS84_a(), GeographicLib::Constants::WGS84_a(),
          GeographicLib::Constants::WGS84_a() * (1 - GeographicLib::Constants::WGS84_f())));
      const double cosine = scaled.normalized().dot(point.normalized());
      widest = std::max(widest, std::acos(std::clamp(cosine, -1.0, 1.0)) +
                                    std::acos(1 / std::max(1.0, scaled.norm())));
    }
    const bool is_sound =
        point.norm() >= kFarOut || (point.norm() >= 1 - 1e-9 && widest <= cap + kSlack_rad);
    if (is_sound) return;
    note(TerrainFault::kHorizon, 1,
         fmt::format("its occlusion point, {:.6f} radii out, is hidden while a vertex is seen",
                     point.norm()));
  }

  void check_normals() {
    if (tile_.normals.size() != ecef_.size()) {
      note(TerrainFault::kNormals, 1,
           fmt::format("has {} normals for {} vertices", tile_.normals.size(), ecef_.size()));
      return;
    }
    // floats, and bytes
    constexpr double kUnit = 0.01;
    std::int64_t wrong = 0;
    for (std::size_t v = 0; v < ecef_.size(); ++v) {
      wrong += !(tile_.normals[v].dot(ecef_[v]) > 0) ||
               !(std::abs(tile_.normals[v].norm() - 1) <= kUnit);
    }
    if (wrong == 0) return;
    note(TerrainFault::kNormals, wrong, fmt::format("{} normals point down", wrong));
  }

  const TerrainFile& tile_;
  const std::vector<Eigen::Vector3d>& ecef_;
  std::vector<FaultFound> found_;
};

}  // namespace

std::vector<FaultFound> examine_indices(const TerrainFile& tile) {
  const std::size_t vertices = tile.u.size();
  std::vector<FaultFound> found;
  const auto note = [&](std::int64_t count, std::string what) {
    found.push_back({TerrainFault::kIndices, count, std::move(what)});
  };
  if (!tile.has_sound_indices) note(1, "an index is beyond the high-water mark");
  std::vector<bool> is_used(vertices, false);
  for (const auto& corners : tile.triangles) {
    for (const std::uint32_t v : corners) {
      if (v >= vertices) {
        note(1, fmt::format("there is no vertex {}", v));
        return found;
      }
      is_used[v] = true;
    }
  }
  for (const auto& border : tile.border) {
    if (std::ranges::all_of(border, [&](std::uint32_t v) { return v < vertices; })) continue;
    note(1, "a border list names a vertex that is not there");
    return found;
  }
  const auto unused = std::ranges::count(is_used, false);
  if (unused > 0) note(unused, fmt::format("no triangle uses {} vertices", unused));
  return found;
}

std::vector<FaultFound> examine_claims(const TerrainFile& tile,
                                       const std::vector<Eigen::Vector3d>& ecef) {
  return Claims(tile, ecef).run();
}

}  // namespace terrane::verify
