#include "tiler/verify/water_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

namespace terrane::verify {
namespace {

constexpr std::int64_t kBlock = 64;
constexpr int kBands = 2000;
// what lengths by a sphere's radius may be off anywhere on the ellipsoid
constexpr double kLongerDegrees = 1.01;
constexpr double kDegree_m = 6371008.8 * std::numbers::pi / 180;

struct Box {
  double left = INFINITY, right = -INFINITY, bottom = INFINITY, top = -INFINITY;

  void add(const PlanPosition& p) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    bottom = std::min(bottom, p.y);
    top = std::max(top, p.y);
  }
  bool meets(const Box& other) const {
    return left <= other.right && other.left <= right && bottom <= other.top && other.bottom <= top;
  }
};

/// Metres of a unit of x and of y at some y.
struct Scale {
  double x_m, y_m;
};

/// One body of water, its shores sorted into bands of y.
class Area {
 public:
  Area(const WaterArea& area, bool is_in_degrees, double tolerance_m)
      : is_in_degrees_(is_in_degrees), tolerance_m_(tolerance_m) {
    for (const auto& shore : area.shores) {
      for (const PlanPosition& p : shore) box_.add(p);
    }
    const Scale scale = scale_at(box_.top);
    const double near_y = tolerance_m / scale.y_m;
    near_box_ = box_;
    near_box_.bottom -= near_y;
    near_box_.top += near_y;
    const double near_x =
        tolerance_m / std::min(scale_at(near_box_.top).x_m, scale_at(near_box_.bottom).x_m);
    near_box_.left -= near_x;
    near_box_.right += near_x;
    bands_.resize(kBands);
    for (const auto& shore : area.shores) {
      for (std::size_t i = 0; i < shore.size(); ++i) {
        const Side side{shore[i], shore[(i + 1) % shore.size()]};
        const int last = band_of(std::max(side.a.y, side.b.y) + near_y);
        for (int band = band_of(std::min(side.a.y, side.b.y) - near_y); band <= last; ++band) {
          bands_[static_cast<std::size_t>(band)].push_back(side);
        }
      }
    }
  }

  const Box& near_box() const { return near_box_; }

  enum class Answer { kInside, kOutside, kNearShore };

  Answer ask(const PlanPosition& p) const {
    if (!(p.x >= near_box_.left && p.x <= near_box_.right && p.y >= near_box_.bottom &&
          p.y <= near_box_.top)) {
      return Answer::kOutside;
    }
    const Scale scale = scale_at(p.y);
    bool is_inside = false;
    for (const Side& side : bands_[static_cast<std::size_t>(band_of(p.y))]) {
      if (distance_m(p, side, scale) <= tolerance_m_) return Answer::kNearShore;
      const auto& [a, b] = side;
      const bool crosses = (a.y <= p.y) != (b.y <= p.y);
      if (crosses && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) is_inside = !is_inside;
    }
    return is_inside ? Answer::kInside : Answer::kOutside;
  }

  std::optional<float> height_m;  ///< of the first sample that was found inside

 private:
  struct Side {
    PlanPosition a, b;
  };

  Scale scale_at(double y) const {
    if (!is_in_degrees_) return {1, 1};
    return {kDegree_m * std::cos(y * std::numbers::pi / 180) / kLongerDegrees,
            kDegree_m / kLongerDegrees};
  }

  int band_of(double y) const {
    const double share = (y - near_box_.bottom) / (near_box_.top - near_box_.bottom);
    return static_cast<int>(std::clamp(share * kBands, 0.0, kBands - 1.0));
  }

  static double distance_m(const PlanPosition& p, const Side& side, const Scale& scale) {
    const double dx = (side.b.x - side.a.x) * scale.x_m, dy = (side.b.y - side.a.y) * scale.y_m;
    const double px = (p.x - side.a.x) * scale.x_m, py = (p.y - side.a.y) * scale.y_m;
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
    return std::hypot(px - t * dx, py - t * dy);
  }

  bool is_in_degrees_;
  double tolerance_m_;
  Box box_, near_box_;
  std::vector<std::vector<Side>> bands_;
};

bool is_same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || a == b ||
         (std::isnan(a) && std::isnan(b));
}

class WaterCheck {
 public:
  WaterCheck(const Georeference& place, std::span<const WaterArea> areas, double tolerance_m)
      : place_(place), is_in_degrees_(!place.crs_wkt().empty()) {
    for (const WaterArea& area : areas) areas_.emplace_back(area, is_in_degrees_, tolerance_m);
  }

  void check(const HeightGrid& dem, const HeightGrid& reference) {
    const Window& window = dem.window;
    std::vector<GridPosition> positions;
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        positions.push_back({static_cast<double>(column), static_cast<double>(row)});
      }
    }
    const std::vector<PlanPosition> places = place_all(positions);
    Box box;
    for (const PlanPosition& p : places) box.add(p);
    std::vector<Area*> near;
    for (Area& area : areas_) {
      if (area.near_box().meets(box)) near.push_back(&area);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      judge(positions[i], places[i], near, dem.heights_m[i], reference.heights_m[i]);
    }
  }

  WaterFindings findings;

 private:
  std::vector<PlanPosition> place_all(const std::vector<GridPosition>& positions) const {
    std::vector<PlanPosition> places;
    if (is_in_degrees_) {
      for (const LonLat& at : place_.to_lon_lat(positions)) {
        places.push_back({at.longitude_deg, at.latitude_deg});
      }
      return places;
    }
    for (const GridPosition& position : positions) places.push_back(place_.to_plan(position));
    return places;
  }

  void judge(const GridPosition& position, const PlanPosition& place,
             const std::vector<Area*>& near, float dem_m, float reference_m) {
    Area* inside = nullptr;
    for (Area* area : near) {
      const Area::Answer answer = area->ask(place);
      if (answer == Area::Answer::kOutside) continue;
      if (answer == Area::Answer::kNearShore || inside != nullptr) return;
      inside = area;
    }
    if (inside == nullptr) {
      if (!is_same(dem_m, reference_m)) note(position, "on land", reference_m, dem_m);
      return;
    }
    ++findings.under_water;
    if (!inside->height_m) inside->height_m = reference_m;
    if (!is_same(*inside->height_m, reference_m)) {
      note(position, "in water", reference_m, *inside->height_m);
    }
  }

  void note(const GridPosition& at, const char* where, float found_m, float wanted_m) {
    ++findings.wrong;
    if (findings.wrong > 1) return;
    findings.problems.push_back(
        fmt::format("a sample {} at (column {}, row {}) counts as {} m and not as {} m", where,
                    at.column, at.row, found_m, wanted_m));
  }

  const Georeference& place_;
  bool is_in_degrees_;
  std::vector<Area> areas_;
};

}  // namespace

WaterFindings check_water(const HeightSource& dem, const HeightSource& reference,
                          const Georeference& place, std::span<const WaterArea> areas,
                          double tolerance_m) {
  WaterCheck check(place, areas, tolerance_m);
  const GridShape shape = dem.shape();
  for (std::int64_t row = 0; row < shape.rows; row += kBlock) {
    for (std::int64_t column = 0; column < shape.columns; column += kBlock) {
      const Window window{column, row, std::min(kBlock, shape.columns - column),
                          std::min(kBlock, shape.rows - row)};
      check.check(dem.read(window), reference.read(window));
    }
  }
  return std::move(check.findings);
}

}  // namespace terrane::verify
