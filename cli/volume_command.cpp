#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "core/errors.h"
#include "hierarchy/volume/encode_cells.h"
#include "hierarchy/volume/encode_vtu.h"
#include "hierarchy/volume/material_sums.h"
#include "hierarchy/volume/section.h"
#include "model/build_model.h"
#include "model/encode_ply.h"
#include "model/section_svg.h"
#include "tiler/files/whole_file.h"
#include "tiler/gltf/painted_glb.h"
#include "viewer/server/viewer_files.h"

namespace terrane::cli {
namespace {

using namespace hierarchy::volume;
using nlohmann::ordered_json;

struct VolumeCommand {
  std::filesystem::path config;
  std::filesystem::path out;
  std::optional<double> tolerance_m;
  std::optional<std::size_t> most_cells;
  bool info = false;
};

ordered_json describe_cells(const MaterialVolume& volume, bool is_within) {
  std::size_t mixed = 0;
  int deepest = 0;
  volume.mesh().for_each_leaf([&](CellId leaf) {
    if (volume.interfaces_in(leaf) != 0) ++mixed;
    deepest = std::max(deepest, volume.mesh().level(leaf));
  });
  return {{"count", volume.mesh().leaf_count()},
          {"with_interfaces", mixed},
          {"vertices", volume.mesh().node_count()},
          {"deepest_level", deepest},
          {"are_within_tolerances", is_within}};
}

ordered_json describe_errors(const MaterialVolume& volume, const model::ModelSettings& settings,
                             const VolumeTolerances& tolerances) {
  ordered_json interfaces = ordered_json::array(), fields = ordered_json::array();
  for (std::uint8_t i = 0; i < volume.interface_count(); ++i) {
    double largest = 0;
    volume.mesh().for_each_leaf([&](CellId leaf) {
      largest = std::max(largest, volume.interface_error(leaf, InterfaceId{i}));
    });
    interfaces.push_back({{"name", settings.surfaces[i].name},
                          {"triangles", volume.model().interfaces[i]->mesh().triangles.size()},
                          {"tolerance_m", tolerances.interfaces[i]},
                          {"max_error_m", largest}});
  }
  for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
    double largest = 0;
    volume.mesh().for_each_leaf(
        [&](CellId leaf) { largest = std::max(largest, volume.field_error(leaf, FieldId{f})); });
    // JSON knows no infinity: without a tolerance there is none
    fields.push_back({{"name", settings.fields[f].name},
                      {"unit", settings.fields[f].unit},
                      {"max_error", largest}});
    if (std::isfinite(tolerances.fields[f])) fields.back()["tolerance"] = tolerances.fields[f];
  }
  return {{"surfaces", interfaces}, {"fields", fields}};
}

/// Sides that a material lies on: the first one whose sides all hold is there.
ordered_json describe_where(const MaterialVolume& volume, const Material& material) {
  ordered_json where = ordered_json::array();
  for (const Side& side : material.where) {
    where.push_back({{"surface", volume.model().interfaces[index(side.interface)]->name()},
                     {"side", side.is_below ? "below" : "above"}});
  }
  return where;
}

ordered_json describe_materials(const MaterialVolume& volume) {
  ordered_json materials = ordered_json::array();
  const std::vector<MaterialSum> sums = sum_materials(volume);
  for (std::size_t m = 0; m < sums.size(); ++m) {
    ordered_json integrals = ordered_json::object();
    for (std::size_t f = 0; f < volume.field_count(); ++f) {
      integrals[volume.model().fields[f].name] = sums[m].integral[f];
    }
    const Material& material = volume.model().materials[m];
    materials.push_back({{"name", material.name},
                         {"where", describe_where(volume, material)},
                         {"is_empty", material.is_empty},
                         {"volume_m3", sums[m].volume},
                         {"integrals", integrals}});
  }
  return materials;
}

ordered_json describe(const MaterialVolume& volume, const model::ModelSettings& settings,
                      const model::Model& model, bool is_within) {
  ordered_json json = {{"format", "terrane-volume/1"}, {"generator", "terrane " TERRANE_VERSION}};
  if (model.is_on_earth) {
    json["frame"] = {{"kind", "transverse-mercator"},
                     {"longitude_deg", model.longitude_deg},
                     {"latitude_deg", model.latitude_deg}};
  } else {
    json["frame"] = {{"kind", "local"}};
  }
  const Box& box = volume.mesh().box();
  json["box_m"] = {{"low", {box.low.x(), box.low.y(), box.low.z()}},
                   {"high", {box.high.x(), box.high.y(), box.high.z()}}};
  json["cells"] = describe_cells(volume, is_within);
  json.update(describe_errors(volume, settings, model.tolerances));
  json["materials"] = describe_materials(volume);
  return json;
}

ordered_json describe_arrays(const EncodedCells& cells) {
  ordered_json arrays = ordered_json::object();
  for (const PlacedArray& array : cells.arrays) {
    arrays[array.name] = {{"type", array.type},
                          {"components", array.components},
                          {"count", array.count},
                          {"offset", array.offset}};
  }
  return arrays;
}

void print(const ordered_json& json) {
  const auto& cells = json.at("cells");
  fmt::print(
      "{} tetrahedra, {} with interfaces, level {} at most{}\n",
      cells.at("count").get<std::size_t>(), cells.at("with_interfaces").get<std::size_t>(),
      cells.at("deepest_level").get<int>(),
      cells.at("are_within_tolerances").get<bool>() ? "" : "; stopped before all tolerances held");
  for (const auto& surface : json.at("surfaces")) {
    fmt::print("surface {}: {} triangles, error {:.3f} m of {:.3f} m\n",
               surface.at("name").get<std::string>(), surface.at("triangles").get<std::size_t>(),
               surface.at("max_error_m").get<double>(), surface.at("tolerance_m").get<double>());
  }
  for (const auto& field : json.at("fields")) {
    fmt::print("field {}: error {:.4g} {}\n", field.at("name").get<std::string>(),
               field.at("max_error").get<double>(), field.at("unit").get<std::string>());
  }
  for (const auto& material : json.at("materials")) {
    fmt::print("material {}: {:.6f} km3\n", material.at("name").get<std::string>(),
               material.at("volume_m3").get<double>() / 1e9);
  }
}

void write_sections(const MaterialVolume& volume, const model::ModelSettings& settings,
                    const std::filesystem::path& out) {
  std::vector<tiler::GlbPaint> paints;
  for (std::uint8_t m = 0; m < volume.model().materials.size(); ++m) {
    paints.push_back({volume.model().materials[m].name, model::material_colour(MaterialId{m})});
  }
  for (const model::SectionSettings& section : settings.sections) {
    const Plane plane{{section.normal[0], section.normal[1], section.normal[2]}, section.offset_m};
    std::vector<std::array<Eigen::Vector3d, 3>> triangles;
    std::vector<std::uint8_t> materials;
    for (const SectionTriangle& triangle : cut_section(volume, plane)) {
      triangles.push_back(triangle.points);
      materials.push_back(static_cast<std::uint8_t>(triangle.material));
    }
    tiler::write_whole_file(out / (section.name + ".ply"), model::encode_ply(triangles, materials));
    tiler::write_whole_file(out / (section.name + ".glb"),
                            tiler::encode_painted_glb(triangles, materials, paints));
    if (section.normal[0] == 0 && section.normal[1] == 0) continue;  // seen from above: no picture
    const double length = volume.mesh().box().size().head<2>().norm();
    const double stretch = std::max(1.0, 0.25 * length / volume.mesh().box().size().z());
    tiler::write_whole_file(out / (section.name + ".svg"),
                            model::section_svg(volume, {plane, stretch}));
  }
}

// volume.json comes last: where it is, all is there
void write(const MaterialVolume& volume, const model::ModelSettings& settings, ordered_json& json,
           const std::filesystem::path& out) {
  viewer::write_volume_page(out);
  const EncodedCells cells = encode_cells(volume);
  json["cells_bin"] = describe_arrays(cells);
  tiler::write_whole_file(out / "cells.bin", cells.bytes);
  tiler::write_whole_file(out / "cells.vtu", encode_cells_vtu(volume));
  tiler::write_whole_file(out / "materials.vtu", encode_materials_vtu(volume));
  for (std::uint8_t i = 0; i < volume.interface_count(); ++i) {
    tiler::write_whole_file(out / (settings.surfaces[i].name + ".ply"),
                            model::encode_ply(interface_triangles(volume, InterfaceId{i})));
  }
  write_sections(volume, settings, out);
  tiler::write_whole_file(out / "volume.json", json.dump(1) + "\n");
}

void run(const VolumeCommand& command, const CommonOptions& common) {
  if (command.info) {
    print(ordered_json::parse(tiler::read_whole_file(command.config / "volume.json")));
    return;
  }
  if (command.out.empty()) throw ConfigError("no folder to write to. Name one with -o");
  model::ModelSettings settings = model::read_model_file(command.config);
  if (command.tolerance_m) {
    for (auto& surface : settings.surfaces) surface.tolerance_m = *command.tolerance_m;
  }
  const auto progress = make_progress(common.quiet);
  model::Model model = model::build_model(settings, *progress);
  MaterialVolume volume(model.volume);
  const bool is_within =
      volume.refine(model.tolerances, command.most_cells.value_or(settings.most_cells));
  ordered_json json = describe(volume, settings, model, is_within);
  write(volume, settings, json, command.out);
  print(json);
}

}  // namespace

void add_volume_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<VolumeCommand>();
  CLI::App* volume = app.add_subcommand(
      "volume", "Fill the space between surfaces with tetrahedra of bounded error");
  volume
      ->add_option(
          "config", command->config,
          "TOML file with surfaces, materials, fields and tolerances; with --info a folder "
          "that this command has written")
      ->required();
  volume->add_option("-o,--out", command->out, "Folder to write to");
  volume
      ->add_option("--tolerance", command->tolerance_m,
                   "Largest error of every surface, in metres above 0 [as the file says]")
      ->check(CLI::PositiveNumber);
  volume
      ->add_option("--most-cells", command->most_cells,
                   "Stop at this number of tetrahedra, 6 or more, the worst errors mended "
                   "[as the file says, else 20000000]")
      ->check(CLI::Range(std::size_t{6}, std::size_t{1} << 30));
  volume->add_flag("--info", command->info, "Say what a folder holds, and write nothing");
  volume->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli
