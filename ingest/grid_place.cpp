#include "ingest/grid_place.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {
namespace {

constexpr Geotransform kUnplaced = {0, 1, 0, 0, 0, -1};

// 17 x 17: dense enough to notice that a datum grid ends inside the data set
constexpr int kProbesPerSide = 17;

std::vector<PlanPosition> probes_of(const GridPlace& place, GridShape shape) {
  std::vector<PlanPosition> probes;
  for (int j = 0; j < kProbesPerSide; ++j) {
    for (int i = 0; i < kProbesPerSide; ++i) {
      const double column = static_cast<double>(shape.columns - 1) * i / (kProbesPerSide - 1);
      const double row = static_cast<double>(shape.rows - 1) * j / (kProbesPerSide - 1);
      probes.push_back(place.to_plan({column, row}));
    }
  }
  return probes;
}

std::string wkt_of(const OGRSpatialReference& crs) {
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  crs.exportToWkt(&text, options);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

std::array<int, 2> axes_of(const OGRSpatialReference& crs) {
  const std::vector<int>& mapping = crs.GetDataAxisToSRSAxisMapping();
  return mapping.size() < 2 ? std::array{1, 2} : std::array{mapping[0], mapping[1]};
}

void describe(DemDescription& description, const Geotransform& t, const OGRSpatialReference& crs,
              const DatumShift* datum_shift) {
  description.column_spacing = std::hypot(t[1], t[4]);
  description.row_spacing = std::hypot(t[2], t[5]);
  if (datum_shift == nullptr) return;
  const char* unit = "";
  if (crs.IsGeographic()) {
    crs.GetAngularUnits(&unit);
  } else {
    crs.GetLinearUnits(&unit);
  }
  description.crs_unit = unit;
  description.crs_name = crs.GetName() == nullptr ? "" : crs.GetName();
  description.datum_shift = datum_shift->name();
}

// an engineering CRS knows its unit but not its place: keep the unit
Geotransform in_metres(Geotransform t, const OGRSpatialReference& crs) {
  if (!crs.IsLocal()) return t;
  const double length_m = crs.GetLinearUnits();
  for (double& coefficient : t) coefficient *= length_m;
  return t;
}

bool could_be_degrees(const Geotransform& t) {
  return std::abs(t[1]) < 0.1 && std::abs(t[5]) < 0.1 && std::abs(t[0]) <= 360 &&
         std::abs(t[3]) <= 91;
}

void note_missing_crs(const std::string& name, const Geotransform& t, bool had_one,
                      Progress& progress) {
  progress.note(fmt::format("{}: {}; its plan is taken as local metres. {}", name,
                            had_one ? "its CRS gives it no place on Earth" : "says no CRS",
                            could_be_degrees(t)
                                ? "The coordinates look like degrees: try --crs EPSG:4326"
                                : "Name it with --crs if you know it"));
}

}  // namespace

GridPlace::GridPlace(std::string name, const Geotransform& corner_transform, std::string crs_wkt,
                     std::unique_ptr<DatumShift> datum_shift)
    : name_(std::move(name)),
      transform_(corner_transform),
      crs_wkt_(std::move(crs_wkt)),
      datum_shift_(std::move(datum_shift)) {}

PlanPosition GridPlace::to_plan(GridPosition position) const {
  const double column = position.column + 0.5;
  const double row = position.row + 0.5;
  const Geotransform& t = transform_;
  return {t[0] + t[1] * column + t[2] * row, t[3] + t[4] * column + t[5] * row};
}

std::vector<LonLat> GridPlace::to_lon_lat(std::span<const GridPosition> positions) const {
  assert(datum_shift_ != nullptr);
  std::vector<PlanPosition> plan;
  plan.reserve(positions.size());
  for (const GridPosition& position : positions) plan.push_back(to_plan(position));
  std::vector<LonLat> places = datum_shift_->to_lon_lat(plan);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::isfinite(places[i].longitude_deg) && std::isfinite(places[i].latitude_deg)) continue;
    throw InputError(
        fmt::format("{}: column {}, row {} has no longitude and latitude in its CRS. "
                    "Name the right CRS with --crs, or cut the DEM",
                    name_, positions[i].column, positions[i].row));
  }
  return places;
}

std::unique_ptr<Georeference> place_grid(const std::string& name, GridShape shape,
                                         const std::optional<Geotransform>& geotransform,
                                         OGRSpatialReference crs, const std::string& asked_crs,
                                         DemDescription& description, Progress& progress) {
  const GdalScope gdal;
  if (!geotransform) {
    if (!asked_crs.empty()) {
      throw InputError(
          fmt::format("{}: has no geotransform, so --crs {} cannot place it. Add one "
                      "with gdal_edit.py -a_ullr, or leave --crs away",
                      name, asked_crs));
    }
    progress.note(fmt::format("{}: has no geotransform; cells of 1 x 1 m are assumed", name));
    describe(description, kUnplaced, crs, nullptr);
    return std::make_unique<GridPlace>(name, kUnplaced, "", nullptr);
  }
  const bool has_crs = !crs.IsEmpty();
  if (has_crs && !crs.IsLocal()) {
    const std::array<int, 2> axes = axes_of(crs);
    crs.StripVertical();
    crs.DemoteTo2D(nullptr);
    const std::string wkt = wkt_of(crs);
    const GridPlace plan(name, *geotransform, "", nullptr);
    if (auto shift = DatumShift::find(wkt, axes, probes_of(plan, shape))) {
      if (shift->is_a_guess()) {
        progress.note(
            fmt::format("{}: no datum shift from '{}' to WGS 84 is known; places may be "
                        "some 100 m wrong",
                        name, crs.GetName()));
      }
      describe(description, *geotransform, crs, shift.get());
      return std::make_unique<GridPlace>(name, *geotransform, wkt, std::move(shift));
    }
  }
  if (!asked_crs.empty()) {
    throw InputError(
        fmt::format("{}: the CRS {} cannot place it: its corners have no longitude and "
                    "latitude there. Name the right CRS with --crs",
                    name, asked_crs));
  }
  note_missing_crs(name, *geotransform, has_crs, progress);
  const Geotransform t = in_metres(*geotransform, crs);
  describe(description, t, crs, nullptr);
  return std::make_unique<GridPlace>(name, t, "", nullptr);
}

}  // namespace terrane::ingest
