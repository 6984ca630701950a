#include "tiler/verify/water_shores.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace terrane::verify {
namespace {

constexpr double kMostBands = 2000;
// what lengths by a sphere's radius may be off anywhere on the ellipsoid
constexpr double kLongerDegrees = 1.01;
constexpr double kDegree_m = 6371008.8 * std::numbers::pi / 180;

}  // namespace

void PlanBox::add(const PlanPosition& p) {
  left = std::min(left, p.x);
  right = std::max(right, p.x);
  bottom = std::min(bottom, p.y);
  top = std::max(top, p.y);
}

bool PlanBox::meets(const PlanBox& other) const {
  return left <= other.right && other.left <= right && bottom <= other.top && other.bottom <= top;
}

WaterShore::WaterShore(const WaterArea& area, bool is_in_degrees, double farthest_m)
    : is_in_degrees_(is_in_degrees), farthest_m_(farthest_m) {
  for (const auto& shore : area.shores) {
    for (const PlanPosition& p : shore) near_box_.add(p);
  }
  const double near_y = farthest_m / scale_at(near_box_.top).y_m;
  near_box_.bottom -= near_y;
  near_box_.top += near_y;
  const double near_x =
      farthest_m / std::min(scale_at(near_box_.top).x_m, scale_at(near_box_.bottom).x_m);
  near_box_.left -= near_x;
  near_box_.right += near_x;
  // bands much narrower than what is near would hold every side many times
  const double bands = (near_box_.top - near_box_.bottom) / std::max(near_y, 1e-12);
  bands_.resize(static_cast<std::size_t>(std::clamp(bands, 1.0, kMostBands)));
  for (const auto& shore : area.shores) {
    for (std::size_t i = 0; i < shore.size(); ++i) {
      const Side side{shore[i], shore[(i + 1) % shore.size()]};
      const std::size_t last = band_of(std::max(side.a.y, side.b.y) + near_y);
      for (std::size_t band = band_of(std::min(side.a.y, side.b.y) - near_y); band <= last;
           ++band) {
        bands_[band].push_back(side);
      }
    }
  }
}

WaterShore::Answer WaterShore::ask(const PlanPosition& p) const {
  PlanBox here;
  here.add(p);
  if (!near_box_.meets(here)) return {};
  const Scale scale = scale_at(p.y);
  Answer answer;
  for (const Side& side : bands_[band_of(p.y)]) {
    answer.shore_m = std::min(answer.shore_m, distance_m(p, side, scale));
    const auto& [a, b] = side;
    const bool crosses = (a.y <= p.y) != (b.y <= p.y);
    if (crosses && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) {
      answer.is_inside = !answer.is_inside;
    }
  }
  if (answer.shore_m > farthest_m_) answer.shore_m = std::numeric_limits<double>::infinity();
  return answer;
}

WaterShore::Scale WaterShore::scale_at(double y) const {
  if (!is_in_degrees_) return {1, 1};
  return {kDegree_m * std::cos(y * std::numbers::pi / 180) / kLongerDegrees,
          kDegree_m / kLongerDegrees};
}

std::size_t WaterShore::band_of(double y) const {
  const auto count = static_cast<double>(bands_.size());
  const double share = (y - near_box_.bottom) / (near_box_.top - near_box_.bottom);
  return static_cast<std::size_t>(std::clamp(share * count, 0.0, count - 1));
}

double WaterShore::distance_m(const PlanPosition& p, const Side& side, const Scale& scale) {
  const double dx = (side.b.x - side.a.x) * scale.x_m, dy = (side.b.y - side.a.y) * scale.y_m;
  const double px = (p.x - side.a.x) * scale.x_m, py = (p.y - side.a.y) * scale.y_m;
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(px - t * dx, py - t * dy);
}

WaterShores::WaterShores(const Georeference& place, std::span<const WaterArea> areas,
                         double farthest_m)
    : place_(place), is_in_degrees_(!place.crs_wkt().empty()) {
  for (const WaterArea& area : areas) shores_.emplace_back(area, is_in_degrees_, farthest_m);
}

std::vector<WaterShores::Place> WaterShores::find(std::span<const GridPosition> positions) const {
  std::vector<Place> found(positions.size());
  if (shores_.empty()) return found;
  const std::vector<PlanPosition> plan = plan_of(positions);
  PlanBox box;
  for (const PlanPosition& p : plan) box.add(p);
  for (std::size_t k = 0; k < shores_.size(); ++k) {
    if (!shores_[k].near_box().meets(box)) continue;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      const auto [is_inside, shore_m] = shores_[k].ask(plan[i]);
      if (is_inside) found[i].inside_m = std::max(found[i].inside_m, shore_m);
      found[i].outside_m = is_inside ? 0 : std::min(found[i].outside_m, shore_m);
      if (is_inside || std::isfinite(shore_m)) found[i].near.push_back(k);
    }
  }
  return found;
}

std::vector<PlanPosition> WaterShores::plan_of(std::span<const GridPosition> positions) const {
  std::vector<PlanPosition> plan;
  if (is_in_degrees_) {
    for (const LonLat& at : place_.to_lon_lat(positions)) {
      plan.push_back({at.longitude_deg, at.latitude_deg});
    }
    return plan;
  }
  for (const GridPosition& position : positions) plan.push_back(place_.to_plan(position));
  return plan;
}

}  // namespace terrane::verify
