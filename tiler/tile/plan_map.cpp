#include "tiler/tile/plan_map.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace terrane::tiler {
namespace {

constexpr int kLargestDegree = 9;
constexpr int kSamplesPerSide = 24;
constexpr double kAllowedCells = 1e-4;

/// Where a polynomial is fitted or judged.
struct Probes {
  std::vector<LonLat> places;
  std::vector<PlanPosition> plan;
};

/// Longitudes on the same turn as the first.
void unwrap(std::vector<LonLat>& places) {
  for (LonLat& place : places) {
    const double turns = (place.longitude_deg - places.front().longitude_deg) / 360;
    place.longitude_deg -= 360 * std::round(turns);
  }
}

/// \param share_of  of k out of count: 0 to 1 along a side of the grid.
template <typename ShareOf>
Probes probe(const Georeference& place, GridShape shape, int count, ShareOf share_of) {
  std::vector<GridPosition> positions;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      positions.push_back({static_cast<double>(shape.columns - 1) * share_of(i, count),
                           static_cast<double>(shape.rows - 1) * share_of(j, count)});
    }
  }
  Probes probes{.places = place.to_lon_lat(positions), .plan = {}};
  unwrap(probes.places);
  for (const GridPosition& position : positions) probes.plan.push_back(place.to_plan(position));
  return probes;
}

/// Denser at the ends, so that a polynomial does not swing there.
double chebyshev_share(int k, int count) {
  return (1 - std::cos(std::numbers::pi * k / (count - 1))) / 2;
}

double even_share(int k, int count) { return static_cast<double>(k) / (count - 1); }

Eigen::VectorXd monomials(const PlanMap& map, LonLat at) {
  const double from_middle = at.longitude_deg - map.middle.longitude_deg;
  const double u = (from_middle - 360 * std::round(from_middle / 360)) / map.half.longitude_deg;
  const double v = (at.latitude_deg - map.middle.latitude_deg) / map.half.latitude_deg;
  Eigen::VectorXd result((map.degree + 1) * (map.degree + 2) / 2);
  Eigen::Index k = 0;
  for (int sum = 0; sum <= map.degree; ++sum) {
    for (int j = 0; j <= sum; ++j) result[k++] = std::pow(u, sum - j) * std::pow(v, j);
  }
  return result;
}

void set_domain(PlanMap& map, const std::vector<LonLat>& places) {
  const auto range = [&](double LonLat::*axis) {
    const auto [low, high] = std::ranges::minmax(places, {}, axis);
    return std::array{(low.*axis + high.*axis) / 2, (high.*axis - low.*axis) / 2};
  };
  const auto [longitude, half_longitude] = range(&LonLat::longitude_deg);
  const auto [latitude, half_latitude] = range(&LonLat::latitude_deg);
  map.middle = {longitude, latitude};
  map.half = {half_longitude, half_latitude};
}

double distance(PlanPosition a, PlanPosition b) { return std::hypot(a.x - b.x, a.y - b.y); }

PlanMap fit(int degree, const Probes& fitted, const Probes& judged) {
  PlanMap map{.degree = degree, .middle = {}, .half = {}, .x = {}, .y = {}};
  set_domain(map, fitted.places);
  const auto count = static_cast<Eigen::Index>(fitted.places.size());
  Eigen::MatrixXd terms(count, monomials(map, map.middle).size());
  Eigen::MatrixX2d values(count, 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    terms.row(k) = monomials(map, fitted.places[k]);
    values.row(k) << fitted.plan[k].x, fitted.plan[k].y;
  }
  const Eigen::MatrixX2d found = terms.householderQr().solve(values);
  map.x.assign(found.col(0).begin(), found.col(0).end());
  map.y.assign(found.col(1).begin(), found.col(1).end());
  for (std::size_t k = 0; k < judged.places.size(); ++k) {
    const double error = distance(map.at(judged.places[k]), judged.plan[k]);
    map.max_error = std::max(map.max_error, error);
  }
  return map;
}

}  // namespace

PlanPosition PlanMap::at(LonLat place) const {
  const Eigen::VectorXd terms = monomials(*this, place);
  return {terms.dot(Eigen::Map<const Eigen::VectorXd>(x.data(), terms.size())),
          terms.dot(Eigen::Map<const Eigen::VectorXd>(y.data(), terms.size()))};
}

std::optional<PlanMap> fit_plan_map(const Georeference& place, GridShape shape) {
  const Probes fitted = probe(place, shape, kSamplesPerSide, chebyshev_share);
  // a number without a common factor with the other's, so that few places are the same
  const Probes judged = probe(place, shape, 2 * kSamplesPerSide + 1, even_share);
  const double allowed =
      kAllowedCells * std::min(distance(place.to_plan({0, 0}), place.to_plan({1, 0})),
                               distance(place.to_plan({0, 0}), place.to_plan({0, 1})));
  const auto is_wgs84 = [&](std::size_t k) {
    const LonLat at = judged.places[k];
    const double turns = std::round((judged.plan[k].x - at.longitude_deg) / 360);
    return distance({at.longitude_deg + 360 * turns, at.latitude_deg}, judged.plan[k]) <= allowed;
  };
  std::size_t same = 0;
  while (same < judged.places.size() && is_wgs84(same)) ++same;
  if (same == judged.places.size()) return std::nullopt;
  PlanMap map = fit(1, fitted, judged);
  while (map.max_error > allowed && map.degree < kLargestDegree) {
    map = fit(map.degree + 1, fitted, judged);
  }
  return map;
}

}  // namespace terrane::tiler
