#include "tiler/verify/terrain_glb_examination.h"

#include <fmt/format.h>

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tiler/verify/terrain_glb.h"

namespace terrane::verify {
namespace {

constexpr double kLast = 32767;
constexpr double kRad = std::numbers::pi / 180;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

class GlbExamination {
 public:
  GlbExamination(const TerrainFile& tile, const TerrainKey& key, const TerrainLayer& layer)
      : tile_(tile), key_(key), rounding_m_(layer.rounding_m(key.zoom)) {
    for (const TerrainFile::Side side : kTerrainSides) {
      listed_[side].insert(tile.border[side].begin(), tile.border[side].end());
    }
  }

  std::vector<FaultFound> run() {
    check_folds();
    check_cover();
    check_lists();
    check_heights();
    return std::move(found_);
  }

 private:
  void note(TerrainFault fault, std::int64_t count, std::string what) {
    found_.push_back({fault, count, std::move(what)});
  }

  /// Meridians meet there, so corners have no longitudes.
  bool is_at_a_pole(const std::array<std::uint32_t, 3>& corners) const {
    return std::ranges::any_of(kTerrainSides, [&](TerrainFile::Side side) {
      return is_pole(key_, side) && std::ranges::any_of(corners, [&](std::uint32_t v) {
               return listed_[side].contains(v);
             });
    });
  }

  /// Where rounding may have moved a vertex to, in steps along u and v.
  std::array<double, 2> rounding_steps(std::uint32_t v) const {
    const double latitude_deg = key_.south_deg() + tile_.v[v] / kLast * key_.side_deg();
    const double step_m = key_.side_deg() * kRad * GeographicLib::Constants::WGS84_a() / kLast;
    const double shrink = std::max(1e-12, std::cos(latitude_deg * kRad));
    return {rounding_m_ / (step_m * shrink), rounding_m_ / step_m};
  }

  /// In longitude and latitude, as quantized-mesh is judged, by more than rounding does.
  bool is_folded(const std::array<std::uint32_t, 3>& corners) const {
    const auto [a, b, c] = corners;
    const double east_b = tile_.u[b] - tile_.u[a], north_b = tile_.v[b] - tile_.v[a];
    const double east_c = tile_.u[c] - tile_.u[a], north_c = tile_.v[c] - tile_.v[a];
    double by_east = 0, by_north = 0;
    for (const std::uint32_t v : corners) {
      const auto [east, north] = rounding_steps(v);
      by_east = std::max(by_east, 2 * east), by_north = std::max(by_north, 2 * north);
    }
    const double rounding = by_east * (std::abs(north_b) + std::abs(north_c)) +
                            by_north * (std::abs(east_b) + std::abs(east_c));
    return a == b || b == c || c == a || east_b * north_c - east_c * north_b < -rounding;
  }

  void check_folds() {
    const auto folded = std::ranges::count_if(tile_.triangles, [&](const auto& corners) {
      return !is_at_a_pole(corners) && is_folded(corners);
    });
    if (folded == 0) return;
    note(TerrainFault::kFolded, folded,
         fmt::format("{} triangles face down or have no area", folded));
  }

  /// Edges that no other triangle has the other way round, and how often each is there.
  std::multiset<Edge> open_edges() const {
    std::multiset<Edge> open;
    for (const auto& corners : tile_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge{corners[k], corners[(k + 1) % 3]};
        const auto other = open.find({edge.second, edge.first});
        if (other == open.end()) {
          open.insert(edge);
        } else {
          open.erase(other);
        }
      }
    }
    return open;
  }

  void check_cover() {
    std::int64_t along = 0;
    const std::multiset<Edge> open = open_edges();
    for (const TerrainFile::Side side : kTerrainSides) {
      // as the clients walk: clockwise, against the triangles
      const std::vector<std::uint32_t>& list = tile_.border[side];
      for (std::size_t k = 1; k < list.size(); ++k) along += open.contains({list[k], list[k - 1]});
    }
    const auto wanted = static_cast<std::int64_t>(listed_[0].size() + listed_[1].size() +
                                                  listed_[2].size() + listed_[3].size() - 4);
    if (along == wanted && along == static_cast<std::int64_t>(open.size())) return;
    note(TerrainFault::kCover, 1,
         fmt::format("{} edges have one side only, and {} of the {} along its border lists do",
                     open.size(), along, wanted));
  }

  /// Listed vertices lie on their border, as near as rounding lets them.
  void check_lists() {
    for (const TerrainFile::Side side : kTerrainSides) {
      const auto beside = std::ranges::count_if(
          listed_[side], [&](std::uint32_t v) { return distance_m(v, side) > rounding_m_; });
      const bool is_twice = listed_[side].size() != tile_.border[side].size();
      if (beside == 0 && !is_twice && listed_[side].size() >= 2) continue;
      note(TerrainFault::kEdgeLists, 1,
           fmt::format("border list {} has {} vertices, {} of them not on the border",
                       static_cast<int>(side), tile_.border[side].size(), beside));
    }
  }

  /// From a vertex to a border, along the ground.
  double distance_m(std::uint32_t v, TerrainFile::Side side) const {
    const Eigen::Vector3d& at = tile_.glb_ecef_m[v];
    if (side == TerrainFile::kWest || side == TerrainFile::kEast) {
      const double deg = key_.west_deg() + (side == TerrainFile::kEast ? key_.side_deg() : 0);
      return std::abs(at.y() * std::cos(deg * kRad) - at.x() * std::sin(deg * kRad));
    }
    const double deg = key_.south_deg() + (side == TerrainFile::kNorth ? key_.side_deg() : 0);
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
    GeographicLib::Geocentric::WGS84().Reverse(at.x(), at.y(), at.z(), latitude_deg, longitude_deg,
                                               height_m);
    return std::abs(latitude_deg - deg) * kRad * at.norm();
  }

  void check_heights() {
    if (tile_.height_m.empty()) return;
    const auto [low, high] = std::ranges::minmax(tile_.height_m);
    if (std::abs(low - tile_.min_height_m) <= rounding_m_ &&
        std::abs(high - tile_.max_height_m) <= rounding_m_) {
      return;
    }
    note(TerrainFault::kHeights, 1,
         fmt::format("states heights of {:.3f} to {:.3f} m, its vertices have {:.3f} to {:.3f} m",
                     tile_.min_height_m, tile_.max_height_m, low, high));
  }

  const TerrainFile& tile_;
  const TerrainKey& key_;
  double rounding_m_;
  std::array<std::set<std::uint32_t>, 4> listed_;
  std::vector<FaultFound> found_;
};

}  // namespace

std::vector<FaultFound> examine_terrain_glb(const TerrainFile& tile, const TerrainKey& key,
                                            const TerrainLayer& layer) {
  return GlbExamination(tile, key, layer).run();
}

}  // namespace terrane::verify
