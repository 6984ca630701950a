#include "tiler/verify/terrain_surface.h"

#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tiler/verify/terrain_examination.h"

namespace terrane::verify {
namespace {

constexpr double kLast = 32767;

}  // namespace

int TerrainSurface::cell_of(double along) {
  return std::clamp(static_cast<int>(along * kCells / kLast), 0, kCells - 1);
}

TerrainSurface::TerrainSurface(const TerrainFile& tile, const TerrainKey& key)
    : key_(key), triangles_(tile.triangles), in_cell_(kCells * kCells) {
  const std::vector<Eigen::Vector3d> ecef = ecef_of(tile, key);
  for (std::size_t v = 0; v < ecef.size(); ++v) {
    corners_.push_back({tile.u[v], tile.v[v], ecef[v]});
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto [a, b, c] = triangles_[t];
    const auto [left, right] = std::minmax({corners_[a].u, corners_[b].u, corners_[c].u});
    const auto [low, high] = std::minmax({corners_[a].v, corners_[b].v, corners_[c].v});
    // a cell more all around, for chords that bulge
    for (int y = std::max(0, cell_of(low) - 1); y <= std::min(kCells - 1, cell_of(high) + 1); ++y) {
      for (int x = std::max(0, cell_of(left) - 1); x <= std::min(kCells - 1, cell_of(right) + 1);
           ++x) {
        in_cell_[static_cast<std::size_t>(y * kCells + x)].push_back(t);
      }
    }
  }
}

std::optional<TerrainSurface::Meeting> TerrainSurface::meet(const Triangle& triangle,
                                                            const Eigen::Vector3d& base,
                                                            const Eigen::Vector3d& up) const {
  const Eigen::Vector3d& a = corners_[triangle[0]].at;
  const Eigen::Vector3d ab = corners_[triangle[1]].at - a, ac = corners_[triangle[2]].at - a;
  Eigen::Matrix3d sides;
  sides << ab, ac, -up;
  // two corners in a pole are one place
  constexpr double kNoArea = 1e-9;
  if (!(std::abs(sides.determinant()) > kNoArea * ab.norm() * ac.norm())) return std::nullopt;
  const Eigen::Vector3d shares = sides.partialPivLu().solve(base - a);
  return Meeting{shares.z(),
                 std::max({0.0, -shares.x(), -shares.y(), shares.x() + shares.y() - 1})};
}

bool TerrainSurface::is_over(const Triangle& triangle, double u, double v) const {
  constexpr double kSlack = 1e-6;  // in steps times steps
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& a = corners_[triangle[k]];
    const Corner& b = corners_[triangle[(k + 1) % 3]];
    if ((b.u - a.u) * (v - a.v) - (u - a.u) * (b.v - a.v) < -kSlack) return false;
  }
  return true;
}

std::optional<double> TerrainSurface::height_m(const LonLat& place) const {
  const double east =
      std::remainder(place.longitude_deg - key_.west_deg() - key_.side_deg() / 2, 360.0);
  const double u = (east / key_.side_deg() + 0.5) * kLast;
  const double v = (place.latitude_deg - key_.south_deg()) / key_.side_deg() * kLast;
  Eigen::Vector3d base;
  std::vector<double> rotation(9);
  GeographicLib::Geocentric::WGS84().Forward(place.latitude_deg, place.longitude_deg, 0, base.x(),
                                             base.y(), base.z(), rotation);
  const Eigen::Vector3d up(rotation[2], rotation[5], rotation[8]);
  const auto& near = in_cell_[static_cast<std::size_t>(cell_of(v) * kCells + cell_of(u))];
  constexpr double kOnEdge = 1e-9;
  std::optional<double> beside;
  for (const std::uint32_t t : near) {
    if (!is_over(triangles_[t], u, v)) continue;
    const auto meeting = meet(triangles_[t], base, up);
    if (!meeting) continue;
    if (meeting->outside <= kOnEdge) return meeting->height_m;
    beside = meeting->height_m;
  }
  // under a triangle whose edge bulges
  for (const std::uint32_t t : near) {
    const auto meeting = meet(triangles_[t], base, up);
    if (meeting && meeting->outside <= kOnEdge) return meeting->height_m;
  }
  return beside;
}

}  // namespace terrane::verify
