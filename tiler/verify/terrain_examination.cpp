#include "tiler/verify/terrain_examination.h"

#include <fmt/format.h>

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tiler/verify/json_file.h"

namespace terrane::verify {
namespace {

constexpr std::int32_t kLast = 32767;

const std::vector<std::int32_t>& across(const TerrainFile& tile, TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kEast ? tile.u : tile.v;
}
const std::vector<std::int32_t>& along(const TerrainFile& tile, TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kEast ? tile.v : tile.u;
}
std::int32_t place_of(TerrainFile::Side side) {
  return side == TerrainFile::kWest || side == TerrainFile::kSouth ? 0 : kLast;
}
constexpr TerrainFile::Side kSides[] = {TerrainFile::kWest, TerrainFile::kSouth, TerrainFile::kEast,
                                        TerrainFile::kNorth};

class Examination {
 public:
  Examination(const TerrainFile& tile, const TerrainKey& key, const TerrainLayer& layer)
      : tile_(tile), key_(key), layer_(layer) {}

  std::vector<FaultFound> run() {
    if (!check_indices()) return std::move(found_);
    check_triangles();
    check_border_lists();
    check_heights();
    ecef_ = ecef_of(tile_, key_);
    check_sphere();
    check_horizon();
    check_normals();
    check_water();
    check_metadata();
    return std::move(found_);
  }

 private:
  void note(TerrainFault fault, std::int64_t count, std::string what) {
    found_.push_back({fault, count, std::move(what)});
  }

  std::size_t vertices() const { return tile_.u.size(); }

  /// Nothing else can be judged if this fails.
  bool check_indices() {
    if (!tile_.has_sound_indices) {
      note(TerrainFault::kIndices, 1, "an index is beyond the high-water mark");
    }
    for (const auto* values : {&tile_.u, &tile_.v, &tile_.height}) {
      const auto outside = std::ranges::count_if(
          *values, [](std::int32_t value) { return value < 0 || value > kLast; });
      if (outside > 0) {
        note(TerrainFault::kIndices, outside,
             fmt::format("{} coordinates are not from 0 to 32767", outside));
      }
    }
    std::vector<bool> is_used(vertices(), false);
    for (const auto& corners : tile_.triangles) {
      for (const std::uint32_t v : corners) {
        if (v >= vertices()) {
          note(TerrainFault::kIndices, 1, fmt::format("there is no vertex {}", v));
          return false;
        }
        is_used[v] = true;
      }
    }
    for (const auto& border : tile_.border) {
      if (std::ranges::all_of(border, [&](std::uint32_t v) { return v < vertices(); })) continue;
      note(TerrainFault::kIndices, 1, "a border list names a vertex that is not there");
      return false;
    }
    const auto unused = std::ranges::count(is_used, false);
    if (unused > 0) {
      note(TerrainFault::kIndices, unused, fmt::format("no triangle uses {} vertices", unused));
    }
    return found_.empty();
  }

  std::int64_t area(const std::array<std::uint32_t, 3>& t) const {
    const auto x = [&](int k) { return std::int64_t{tile_.u[t[k]]}; };
    const auto y = [&](int k) { return std::int64_t{tile_.v[t[k]]}; };
    return (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0));
  }

  bool are_on_a_side(std::uint32_t a, std::uint32_t b) const {
    return std::ranges::any_of(kSides, [&](TerrainFile::Side side) {
      const auto& at = across(tile_, side);
      return at[a] == place_of(side) && at[b] == place_of(side);
    });
  }

  /// Upward triangles whose open edges all lie on the tile's sides wind round every place inside
  /// as often as the areas say: once, if their sum is the tile's.
  void check_triangles() {
    std::int64_t sum = 0, folded = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> open;
    for (const auto& corners : tile_.triangles) {
      const std::int64_t twice = area(corners);
      sum += twice;
      folded += twice <= 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
        const auto other = open.find({to, from});
        if (other == open.end()) {
          ++open[{from, to}];
        } else if (--other->second == 0) {
          open.erase(other);
        }
      }
    }
    if (folded > 0) {
      note(TerrainFault::kFolded, folded,
           fmt::format("{} triangles face down or have no area", folded));
    }
    const auto gaping = std::ranges::count_if(open, [&](const auto& edge) {
      return edge.second != 1 || !are_on_a_side(edge.first.first, edge.first.second);
    });
    if (gaping > 0) {
      note(TerrainFault::kCover, 1, fmt::format("{} edges inside have one side only", gaping));
    } else if (sum != 2 * std::int64_t{kLast} * kLast) {
      note(TerrainFault::kCover, 1,
           fmt::format("its triangles cover {:.6f} of it",
                       static_cast<double>(sum) / 2 / kLast / kLast));
    }
  }

  void check_border_lists() {
    for (const TerrainFile::Side side : kSides) {
      std::vector<std::uint32_t> wanted;
      for (std::uint32_t v = 0; v < vertices(); ++v) {
        if (across(tile_, side)[v] == place_of(side)) wanted.push_back(v);
      }
      std::vector<std::uint32_t> listed = tile_.border[side];
      std::ranges::sort(listed);
      if (listed == wanted) continue;
      note(TerrainFault::kEdgeLists, 1,
           fmt::format("border list {} has {} vertices, on the border are {}",
                       static_cast<int>(side), listed.size(), wanted.size()));
    }
  }

  void check_heights() {
    if (vertices() == 0) return;
    const auto [low, high] = std::ranges::minmax(tile_.height);
    const double range_m = double{tile_.max_height_m} - double{tile_.min_height_m};
    if (!(range_m >= 0) || low != 0) {
      note(TerrainFault::kHeights, 1,
           fmt::format("states heights of {} to {} m, and no vertex has the lowest",
                       tile_.min_height_m, tile_.max_height_m));
      return;
    }
    // coarser steps than need be: floats high up leave less choice
    const double farthest_m =
        std::max(std::abs(double{tile_.min_height_m}), std::abs(double{tile_.max_height_m}));
    const double used_m = range_m * high / kLast;
    if (range_m <= std::max(2.01 * used_m, 0.01 * farthest_m)) return;
    note(TerrainFault::kHeights, 1,
         fmt::format("states a highest of {} m, its vertices reach {:.3f} m", tile_.max_height_m,
                     tile_.min_height_m + used_m));
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

  Eigen::Vector3d decoded_normal(std::size_t v) const {
    const auto part = [&](std::size_t k) {
      return static_cast<double>(static_cast<unsigned char>((*tile_.normals)[2 * v + k])) / 255 *
                 2 -
             1;
    };
    double x = part(0), y = part(1);
    const double z = 1 - std::abs(x) - std::abs(y);
    if (z < 0) {
      const double folded_x = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
      y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
      x = folded_x;
    }
    return Eigen::Vector3d(x, y, z).normalized();
  }

  void check_normals() {
    if (!tile_.normals || tile_.normals->size() != 2 * vertices()) {
      note(TerrainFault::kNormals, 1, "its normals are not two bytes a vertex");
      return;
    }
    std::int64_t downward = 0;
    for (std::size_t v = 0; v < vertices(); ++v) {
      downward += decoded_normal(v).dot(ecef_[v].normalized()) <= 0;
    }
    if (downward > 0) {
      note(TerrainFault::kNormals, downward, fmt::format("{} normals point down", downward));
    }
  }

  void check_water() {
    constexpr std::size_t kMask = 256 * 256;
    const bool is_wanted =
        std::ranges::find(layer_.extensions, "watermask") != layer_.extensions.end();
    if (tile_.water.has_value() != is_wanted) {
      note(TerrainFault::kWater, 1,
           is_wanted ? "has no water mask" : "has a water mask that layer.json does not list");
      return;
    }
    if (!tile_.water) return;
    if (tile_.water->size() != 1 && tile_.water->size() != kMask) {
      note(TerrainFault::kWater, 1,
           fmt::format("its water mask has {} bytes", tile_.water->size()));
      return;
    }
    const auto odd = std::ranges::count_if(
        *tile_.water, [](char c) { return c != 0 && static_cast<unsigned char>(c) != 255; });
    if (odd > 0) {
      note(TerrainFault::kWater, 1,
           fmt::format("{} cells of its mask are neither land nor water", odd));
    }
  }

  /// The metadata list ranges of the zooms below, cut to the tile.
  void check_metadata() {
    constexpr int kEvery = 10;  // where CesiumJS asks
    if (!tile_.metadata) {
      if (key_.zoom % kEvery == 0 && key_.zoom < layer_.finest()) {
        note(TerrainFault::kMetadata, 1, "does not say which tiles are below it");
      }
      return;
    }
    try {
      const auto below = nlohmann::json::parse(*tile_.metadata).at("available");
      for (std::size_t k = 0; k < below.size(); ++k) {
        const int zoom = key_.zoom + 1 + static_cast<int>(k);
        if (!is_as_listed(ranges_of(below[k]), zoom)) {
          note(TerrainFault::kMetadata, 1,
               fmt::format("names other tiles of zoom {} than layer.json", zoom));
        }
      }
    } catch (const nlohmann::json::exception& error) {
      note(TerrainFault::kMetadata, 1, fmt::format("its metadata are damaged ({})", error.what()));
    }
  }

  bool is_as_listed(const ZoomRanges& ranges, int zoom) const {
    if (zoom > layer_.finest()) return ranges.empty();
    const int shift = zoom - key_.zoom;
    const TerrainRange square{key_.x << shift, key_.y << shift, ((key_.x + 1) << shift) - 1,
                              ((key_.y + 1) << shift) - 1};
    // rectangles that name the same tiles have the same corners and the same number of them
    std::int64_t named = 0, listed = 0;
    for (const TerrainRange& r : ranges) {
      named += (r.end_x - r.start_x + 1) * (r.end_y - r.start_y + 1);
      if (!layer_.has({zoom, r.start_x, r.start_y}) || !layer_.has({zoom, r.end_x, r.end_y}) ||
          !square.contains(r.start_x, r.start_y) || !square.contains(r.end_x, r.end_y)) {
        return false;
      }
    }
    for (const TerrainRange& r : layer_.available[static_cast<std::size_t>(zoom)]) {
      const std::int64_t columns =
          std::min(r.end_x, square.end_x) - std::max(r.start_x, square.start_x) + 1;
      const std::int64_t rows =
          std::min(r.end_y, square.end_y) - std::max(r.start_y, square.start_y) + 1;
      if (columns > 0 && rows > 0) listed += columns * rows;
    }
    return named == listed;
  }

  const TerrainFile& tile_;
  const TerrainKey& key_;
  const TerrainLayer& layer_;
  std::vector<Eigen::Vector3d> ecef_;
  std::vector<FaultFound> found_;
};

}  // namespace

std::vector<Eigen::Vector3d> ecef_of(const TerrainFile& tile, const TerrainKey& key) {
  std::vector<Eigen::Vector3d> ecef(tile.u.size());
  for (std::uint32_t v = 0; v < tile.u.size(); ++v) {
    const auto share = [](std::int32_t at) { return static_cast<double>(at) / kLast; };
    GeographicLib::Geocentric::WGS84().Forward(
        std::clamp(key.south_deg() + share(tile.v[v]) * key.side_deg(), -90.0, 90.0),
        key.west_deg() + share(tile.u[v]) * key.side_deg(), tile.height_m(v), ecef[v].x(),
        ecef[v].y(), ecef[v].z());
  }
  return ecef;
}

std::vector<FaultFound> examine_terrain(const TerrainFile& tile, const TerrainKey& key,
                                        const TerrainLayer& layer) {
  return Examination(tile, key, layer).run();
}

std::vector<BorderVertex> border_of(const TerrainFile& tile, TerrainFile::Side side) {
  std::vector<BorderVertex> border;
  for (std::uint32_t v = 0; v < tile.u.size(); ++v) {
    if (across(tile, side)[v] != place_of(side)) continue;
    border.emplace_back(along(tile, side)[v], std::llround(tile.height_m(v) * 1e6));
  }
  std::ranges::sort(border);
  return border;
}

}  // namespace terrane::verify
