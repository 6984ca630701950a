#include "model/build_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/errors.h"
#include "hierarchy/volume/material_fields.h"
#include "ingest/scan.h"
#include "model/formula_field.h"
#include "model/ground_surface.h"
#include "model/mesh_file.h"
#include "model/prism_surface.h"
#include "model/raster_field.h"
#include "model/rectilinear_field.h"

namespace terrane::model {
namespace {

using namespace hierarchy::volume;
using SurfacePtr = std::shared_ptr<const InterfaceSurface>;

PlanFrame frame_of(const BoxSettings& box) {
  if (!box.is_geographic) return {};
  return PlanFrame({(box.west + box.east) / 2, (box.south + box.north) / 2});
}

Box box_of(const BoxSettings& settings, const PlanFrame& frame) {
  Box box;
  box.low = {settings.west, settings.south, settings.bottom_m};
  box.high = {settings.east, settings.north, settings.top_m};
  if (!frame.is_on_earth()) return box;
  const double longitude = (settings.west + settings.east) / 2;
  const double latitude = (settings.south + settings.north) / 2;
  box.low.x() = frame.from_lon_lat({settings.west, latitude}).x;
  box.high.x() = frame.from_lon_lat({settings.east, latitude}).x;
  box.low.y() = frame.from_lon_lat({longitude, settings.south}).y;
  box.high.y() = frame.from_lon_lat({longitude, settings.north}).y;
  return box;
}

SurfaceMesh read_ground(const SurfaceSettings& settings, const PlanFrame& frame, const Box& box,
                        Progress& progress) {
  std::vector<std::unique_ptr<ingest::Dem>> dems;
  std::vector<const ingest::Dem*> order;
  for (const std::string& source : settings.dem) {
    ingest::OpenOptions options;
    if (!settings.nodata.empty()) options.nodata = settings.nodata;
    dems.push_back(ingest::open_dem({source}, options, progress));
    require_same_kind(dems.back()->name(), dems.back()->place(), frame);
    ingest::scan_heights(*dems.back(), progress);  // refuses undeclared voids
    order.push_back(dems.back().get());
  }
  return ground_surface(order, frame, box, progress);
}

SurfacePtr read_surface(const SurfaceSettings& settings, const PlanFrame& frame, const Box& box,
                        Progress& progress) {
  if (!settings.dem.empty()) {
    return std::make_shared<InterfaceSurface>(
        settings.name, read_ground(settings, frame, box, progress), SideRule::kVertical, box);
  }
  SurfaceMesh mesh = settings.mesh.empty()
                         ? prism_surface(settings.inside, ingest::read_polygons(settings.inside),
                                         settings.level_m, frame, box)
                         : read_mesh(settings.mesh);
  return std::make_shared<InterfaceSurface>(settings.name, std::move(mesh), SideRule::kNormals,
                                            box);
}

std::size_t find_surface(const ModelSettings& settings, const std::string& name,
                         const std::string& wanted_by) {
  for (std::size_t i = 0; i < settings.surfaces.size(); ++i) {
    if (settings.surfaces[i].name == name) return i;
  }
  throw ConfigError(
      fmt::format("{}: {} names a surface {} that is not there", settings.file, wanted_by, name));
}

/// How far the upper surface lies under a point of the lower one; below 0: over it.
double dip(const SurfaceSettings& settings, const InterfaceSurface& upper,
           const Eigen::Vector3d& p) {
  if (!settings.dem.empty()) return p.z() - upper.height(p.x(), p.y()).value_or(p.z());
  // inside the ring of a body of water, just under its level
  const Eigen::Vector3d under(p.x(), p.y(), settings.level_m - 1e-6);
  const bool is_inside = upper.signed_distance(under, DistanceRule::kExact) < 0;
  return is_inside ? p.z() - settings.level_m : -1;
}

void check_order(const ModelSettings& settings, const std::vector<SurfacePtr>& surfaces,
                 const Box& box) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const SurfaceSettings& upper = settings.surfaces[i];
    if (upper.over.empty()) continue;
    const std::size_t j = find_surface(settings, upper.over, "surface " + upper.name);
    const SurfaceSettings& lower = settings.surfaces[j];
    if (lower.dem.empty() || !upper.mesh.empty()) {
      throw ConfigError(
          fmt::format("{}: surface {}: over takes a surface of heights (dem), and only "
                      "dem and level_m lie over one",
                      settings.file, upper.name));
    }
    const double allowed = upper.tolerance_m + lower.tolerance_m;
    for (const Eigen::Vector3d& p : surfaces[j]->mesh().points) {
      const bool is_in_plan = p.x() >= box.low.x() && p.x() <= box.high.x() &&
                              p.y() >= box.low.y() && p.y() <= box.high.y();
      if (!is_in_plan) continue;
      const double under = dip(upper, *surfaces[i], p);
      if (under <= allowed) continue;
      throw InputError(
          fmt::format("{}: surface {} lies {:.1f} m under {} at x {:.0f} m, y {:.0f} m. "
                      "Mend the data, or leave 'over' out: then the first material "
                      "that fits is there",
                      settings.file, upper.name, under, lower.name, p.x(), p.y()));
    }
  }
}

std::vector<Side> parse_where(const ModelSettings& settings, const MaterialSettings& material) {
  std::vector<Side> sides;
  std::istringstream words(material.where);
  const std::string by = "material " + material.name;
  for (std::string word, name; words >> word;) {
    if (word == "and" && !sides.empty()) words >> word;
    if ((word != "below" && word != "above") || !(words >> name)) {
      throw ConfigError(fmt::format("{}: {}: '{}' is no place. Write it like 'below A and above B'",
                                    settings.file, by, material.where));
    }
    const auto i = static_cast<std::uint8_t>(find_surface(settings, name, by));
    sides.push_back({InterfaceId{i}, word == "below"});
  }
  return sides;
}

std::shared_ptr<const Field> read_field(const FieldSettings& field, const FieldSource& source,
                                        const PlanFrame& frame, const Box& box,
                                        Progress& progress) {
  if (!source.raster.empty()) return raster_field(field.name, source, frame, box, progress);
  if (!source.grid.empty()) return rectilinear_field(field.name, source, box, progress);
  return formula_field(field.name, source.formula, box, field.samples);
}

NamedField make_field(const ModelSettings& settings, const FieldSettings& field,
                      const PlanFrame& frame, const Box& box, Progress& progress) {
  std::vector<FieldSource> sources(settings.materials.size());
  for (const auto& [name, source] : field.sources) {
    const auto at = std::ranges::find(settings.materials, name, &MaterialSettings::name);
    if (at == settings.materials.end()) {
      throw ConfigError(fmt::format("{}: field {} names a material {} that is not there",
                                    settings.file, field.name, name));
    }
    sources[static_cast<std::size_t>(at - settings.materials.begin())] = source;
  }
  std::vector<std::shared_ptr<const Field>> fields;
  for (const FieldSource& source : sources) {
    fields.push_back(read_field(field, source, frame, box, progress));
  }
  return {field.name, field.unit, std::make_shared<MaterialFields>(std::move(fields))};
}

}  // namespace

Model build_model(const ModelSettings& settings, Progress& progress) {
  const PlanFrame frame = frame_of(settings.box);
  Model model;
  model.is_on_earth = frame.is_on_earth();
  if (model.is_on_earth) {
    const LonLat origin = frame.to_lon_lat({0, 0});
    model.longitude_deg = origin.longitude_deg;
    model.latitude_deg = origin.latitude_deg;
  }
  VolumeModel& volume = model.volume;
  volume.box = box_of(settings.box, frame);
  for (const SurfaceSettings& surface : settings.surfaces) {
    volume.interfaces.push_back(read_surface(surface, frame, volume.box, progress));
    model.tolerances.interfaces.push_back(surface.tolerance_m);
  }
  check_order(settings, volume.interfaces, volume.box);
  for (const MaterialSettings& material : settings.materials) {
    volume.materials.push_back({material.name, parse_where(settings, material), material.is_empty});
  }
  for (const FieldSettings& field : settings.fields) {
    volume.fields.push_back(make_field(settings, field, frame, volume.box, progress));
    model.tolerances.fields.push_back(field.tolerance);
  }
  return model;
}

}  // namespace terrane::model
