#include "ingest/geographic_inverse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace terrane::ingest {
namespace {

using Points = std::vector<PlanPosition>;

/// A step too far is brought back to the neighbourhood of the grid, where its map is known.
double bounded(double value, double last) {
  return std::clamp(value, -0.05 * last - 1, 1.05 * last + 1);
}

}  // namespace

/// Longitude and latitude and their change per column and row.
struct GeographicInverse::Jet {
  double x, y, xc, yc, xr, yr;
};

GeographicInverse::GeographicInverse(const Georeference& place, GridShape shape)
    : place_(place), shape_(shape) {
  constexpr int kProbesPerSide = 17;
  std::vector<GridPosition> probes;
  for (int j = 0; j < kProbesPerSide; ++j) {
    for (int i = 0; i < kProbesPerSide; ++i) {
      probes.push_back(
          {last_column() * i / (kProbesPerSide - 1), last_row() * j / (kProbesPerSide - 1)});
    }
  }
  const std::vector<LonLat> at = place.to_lon_lat(probes);
  middle_deg_ = at[at.size() / 2].longitude_deg;
  area_ = {INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const LonLat& p : at) {
    const double x = unwrapped(p.longitude_deg);
    area_.west_deg = std::min(area_.west_deg, x);
    area_.east_deg = std::max(area_.east_deg, x);
    area_.south_deg = std::min(area_.south_deg, p.latitude_deg);
    area_.north_deg = std::max(area_.north_deg, p.latitude_deg);
  }
  const double margin_deg =
      0.02 * std::max(area_.east_deg - area_.west_deg, area_.north_deg - area_.south_deg);
  area_.west_deg -= margin_deg;
  area_.east_deg += margin_deg;
  area_.south_deg -= margin_deg;
  area_.north_deg += margin_deg;
}

double GeographicInverse::unwrapped(double longitude_deg) const {
  return middle_deg_ + std::remainder(longitude_deg - middle_deg_, 360.0);
}

std::string GeographicInverse::described() const {
  return fmt::format("longitudes {:.3f} to {:.3f}, latitudes {:.3f} to {:.3f}", area_.west_deg,
                     area_.east_deg, area_.south_deg, area_.north_deg);
}

Points GeographicInverse::to_grid(const Points& points) const {
  constexpr int kMostSteps = 20;
  constexpr double kExact_cells = 1e-7;
  std::vector<GridPosition> at(points.size(), {last_column() / 2, last_row() / 2});
  for (int step = 0; step < kMostSteps; ++step) {
    double largest_cells = 0;
    const std::vector<Jet> here = jets(at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Jet& jet = here[i];
      const double x = unwrapped(points[i].x) - jet.x, y = points[i].y - jet.y;
      const double scale = 1 / (jet.xc * jet.yr - jet.yc * jet.xr);
      const double columns = (x * jet.yr - y * jet.xr) * scale;
      const double rows = (y * jet.xc - x * jet.yc) * scale;
      at[i] = {bounded(at[i].column + columns, last_column()),
               bounded(at[i].row + rows, last_row())};
      largest_cells = std::max({largest_cells, std::abs(columns), std::abs(rows)});
    }
    if (largest_cells < kExact_cells) break;
  }
  Points result;
  for (const GridPosition& p : at) result.push_back({p.column, p.row});
  return result;
}

std::vector<GeographicInverse::Jet> GeographicInverse::jets(
    const std::vector<GridPosition>& at) const {
  constexpr double kHalf_cells = 0.5;
  std::vector<GridPosition> around;
  for (const GridPosition& p : at) {
    around.push_back(p);
    around.push_back({p.column + kHalf_cells, p.row});
    around.push_back({p.column - kHalf_cells, p.row});
    around.push_back({p.column, p.row + kHalf_cells});
    around.push_back({p.column, p.row - kHalf_cells});
  }
  const std::vector<LonLat> places = place_.to_lon_lat(around);
  std::vector<Jet> result;
  for (std::size_t i = 0; i < places.size(); i += 5) {
    const LonLat* p = &places[i];
    result.push_back({unwrapped(p[0].longitude_deg), p[0].latitude_deg,
                      std::remainder(p[1].longitude_deg - p[2].longitude_deg, 360.0),
                      p[1].latitude_deg - p[2].latitude_deg,
                      std::remainder(p[3].longitude_deg - p[4].longitude_deg, 360.0),
                      p[3].latitude_deg - p[4].latitude_deg});
  }
  return result;
}

}  // namespace terrane::ingest
