#include "ingest/datum_shift.h"

#include <proj.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace terrane::ingest {
namespace {

struct Free {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const {
    proj_operation_factory_context_destroy(factory);
  }
};
template <typename T>
using Owned = std::unique_ptr<T, Free>;

Owned<PJ_CONTEXT> quiet_offline_context() {
  Owned<PJ_CONTEXT> context(proj_context_create());
  proj_log_func(context.get(), nullptr, [](void*, int, const char*) {});
  // a grid that is fetched on one machine and not on the next would move the terrain
  proj_context_set_enable_network(context.get(), 0);
  return context;
}

constexpr double kNowhere = std::numeric_limits<double>::infinity();

double wrapped_deg(double longitude_deg) { return std::remainder(longitude_deg, 360.0); }

bool is_finite(const LonLat& place) {
  return std::isfinite(place.longitude_deg) && std::isfinite(place.latitude_deg);
}

// a geographic CRS passes any number on: metres taken for degrees must not become places, but a
// grid that starts at a pole may miss it by a rounding
LonLat checked(double longitude_deg, double latitude_deg) {
  if (std::abs(latitude_deg) > 90 + 1e-6 || !std::isfinite(longitude_deg))
    return {kNowhere, kNowhere};
  return {wrapped_deg(longitude_deg), std::clamp(latitude_deg, -90.0, 90.0)};
}

// smaller longitude in the east than in the west where it crosses the date line, as PROJ wants it
DatumShift::Area area_of(const std::vector<LonLat>& places) {
  const double middle_deg = std::find_if(places.begin(), places.end(), is_finite)->longitude_deg;
  DatumShift::Area area{360, 90, -360, -90};
  for (const LonLat& place : places) {
    if (!is_finite(place)) continue;
    const double east_deg = wrapped_deg(place.longitude_deg - middle_deg);
    area.west_deg = std::min(area.west_deg, east_deg);
    area.east_deg = std::max(area.east_deg, east_deg);
    area.south_deg = std::min(area.south_deg, place.latitude_deg);
    area.north_deg = std::max(area.north_deg, place.latitude_deg);
  }
  area.west_deg = wrapped_deg(area.west_deg + middle_deg);
  area.east_deg = wrapped_deg(area.east_deg + middle_deg);
  return area;
}

Owned<PJ_OBJ_LIST> list_operations(PJ_CONTEXT* context, const PJ* crs,
                                   const DatumShift::Area* area) {
  const Owned<PJ> wgs84(proj_create(context, "EPSG:4326"));
  const Owned<PJ_OPERATION_FACTORY_CONTEXT> factory(
      proj_create_operation_factory_context(context, nullptr));
  if (area) {
    proj_operation_factory_context_set_area_of_interest(
        context, factory.get(), area->west_deg, area->south_deg, area->east_deg, area->north_deg);
  }
  proj_operation_factory_context_set_spatial_criterion(context, factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  return Owned<PJ_OBJ_LIST>(proj_create_operations(context, crs, wgs84.get(), factory.get()));
}

}  // namespace

struct DatumShift::Operation {
  Owned<PJ_CONTEXT> context;  // before the object, which must not outlive it
  Owned<PJ> object;

  static Operation copy_of(const PJ& object) {
    Owned<PJ_CONTEXT> context = quiet_offline_context();
    Owned<PJ> copy(proj_clone(context.get(), &object));
    return {std::move(context), std::move(copy)};
  }

  std::vector<LonLat> apply(std::array<int, 2> axes,
                            std::span<const PlanPosition> positions) const {
    std::vector<LonLat> places;
    places.reserve(positions.size());
    for (const PlanPosition& position : positions) {
      PJ_COORD in = proj_coord(0, 0, 0, std::numeric_limits<double>::infinity());
      in.v[std::abs(axes[0]) - 1] = axes[0] < 0 ? -position.x : position.x;
      in.v[std::abs(axes[1]) - 1] = axes[1] < 0 ? -position.y : position.y;
      proj_errno_reset(object.get());
      const PJ_COORD out = proj_trans(object.get(), PJ_FWD, in);
      // EPSG:4326 has latitude first
      places.push_back(checked(out.v[1], out.v[0]));
    }
    return places;
  }
};

DatumShift::DatumShift(std::unique_ptr<Operation> operation, std::array<int, 2> axes)
    : axes_(axes),
      is_a_guess_(proj_coordoperation_has_ballpark_transformation(operation->context.get(),
                                                                  operation->object.get()) != 0),
      original_(std::move(operation)) {
  const char* name = proj_get_name(original_->object.get());
  if (name != nullptr) name_ = name;
}

DatumShift::~DatumShift() = default;

std::unique_ptr<DatumShift> DatumShift::find_in(const std::string& crs_wkt, std::array<int, 2> axes,
                                                std::span<const PlanPosition> probes,
                                                const Area* area) {
  const Owned<PJ_CONTEXT> context = quiet_offline_context();
  const Owned<PJ> crs(proj_create(context.get(), crs_wkt.c_str()));
  if (!crs) return nullptr;
  const Owned<PJ_OBJ_LIST> list = list_operations(context.get(), crs.get(), area);
  const int count = list ? proj_list_get_count(list.get()) : 0;
  std::unique_ptr<Operation> best;
  std::ptrdiff_t most_placed = 0;
  for (int i = 0; i < count && most_placed < std::ssize(probes); ++i) {
    const Owned<PJ> candidate(proj_list_get(context.get(), list.get(), i));
    if (!proj_coordoperation_is_instantiable(context.get(), candidate.get())) continue;
    auto operation = std::make_unique<Operation>(Operation::copy_of(*candidate));
    const std::vector<LonLat> places = operation->apply(axes, probes);
    const auto placed = std::count_if(places.begin(), places.end(), is_finite);
    if (placed <= most_placed) continue;
    most_placed = placed;
    best = std::move(operation);
  }
  if (!best) return nullptr;
  return std::unique_ptr<DatumShift>(new DatumShift(std::move(best), axes));
}

std::unique_ptr<DatumShift> DatumShift::find(const std::string& crs_wkt, std::array<int, 2> axes,
                                             std::span<const PlanPosition> probes) {
  // any operation tells roughly where on Earth the data set lies; the best one there is wanted
  const std::unique_ptr<DatumShift> rough = find_in(crs_wkt, axes, probes, nullptr);
  if (!rough) return nullptr;
  const Area area = area_of(rough->to_lon_lat(probes));
  return find_in(crs_wkt, axes, probes, &area);
}

std::unique_ptr<DatumShift::Operation> DatumShift::borrow() const {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return std::make_unique<Operation>(Operation::copy_of(*original_->object));
  std::unique_ptr<Operation> operation = std::move(idle_.back());
  idle_.pop_back();
  return operation;
}

void DatumShift::give_back(std::unique_ptr<Operation> operation) const {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(operation));
}

std::vector<LonLat> DatumShift::to_lon_lat(std::span<const PlanPosition> positions) const {
  std::unique_ptr<Operation> operation = borrow();
  std::vector<LonLat> places = operation->apply(axes_, positions);
  give_back(std::move(operation));
  return places;
}

}  // namespace terrane::ingest
