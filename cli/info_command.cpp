#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "archive/archive.h"
#include "cli/commands.h"
#include "cli/dem_options.h"
#include "cli/terminal_progress.h"
#include "core/errors.h"
#include "ingest/scan.h"
#include "tiler/files/whole_file.h"

namespace terrane::cli {
namespace {

struct InfoCommand {
  DemOptions dem;  ///< or, as the only "DEM", an output folder
};

void print_row(std::string_view name, const std::string& value) {
  fmt::print("{:<16}{}\n", name, value);
}

/// Terrain tiles of the geodetic scheme.
void describe_terrain(const nlohmann::json& json) {
  print_row("written by", json.at("generator").get<std::string>());
  print_row("tiles", json.value("tiles", "quantized-mesh"));
  print_row("terrain", json.at("source").get<std::string>());
  print_row("resampling", fmt::format("at most {:.2f} m off the DEM's samples, RMS {:.2f} m",
                                      json.at("resampling").at("max_error_m").get<double>(),
                                      json.at("resampling").at("rms_error_m").get<double>()));
  fmt::print("\n{:>5} {:>12} {:>12} {:>14} {:>7} {:>10} {:>9}\n", "zoom", "tolerance m",
             "max error m", "held to", "tiles", "triangles", "MB");
  for (const auto& zoom : json.at("zooms")) {
    fmt::print("{:>5} {:>12.3f} {:>12.3f} {:>14} {:>7} {:>10} {:>9.2f}\n",
               zoom.at("zoom").get<int>(), zoom.at("tolerance_m").get<double>(),
               zoom.at("max_error_m").get<double>(), zoom.at("held_to").get<std::string>(),
               zoom.at("tiles").get<std::int64_t>(), zoom.at("triangles").get<std::int64_t>(),
               zoom.at("bytes").get<double>() / 1e6);
  }
}

/// The middle of the data set, for a map.
std::string place_of(const nlohmann::json& frame) {
  if (frame.at("kind") == "local") {
    return fmt::format("not on the Earth; middle at x {:.1f}, y {:.1f} m",
                       frame.at("x").get<double>(), frame.at("y").get<double>());
  }
  const auto latitude_deg = frame.at("latitude_deg").get<double>();
  const auto longitude_deg = frame.at("longitude_deg").get<double>();
  return fmt::format("{:.5f} {}, {:.5f} {}", std::abs(latitude_deg), latitude_deg < 0 ? 'S' : 'N',
                     std::abs(longitude_deg), longitude_deg < 0 ? 'W' : 'E');
}

/// The first name in a WKT is that of the CRS.
std::string crs_name_of(const nlohmann::json& dem) {
  const auto wkt = dem.at("crs_wkt").get<std::string>();
  const std::size_t begin = wkt.find('"');
  const std::size_t end = wkt.find('"', begin + 1);
  if (end == std::string::npos) return {};
  const std::string name = wkt.substr(begin + 1, end - begin - 1);
  return name == "unnamed" || name == "unknown" ? "" : name;
}

void describe_each_level(const nlohmann::json& levels) {
  std::int64_t tiles = 0, triangles = 0;
  double bytes = 0;
  fmt::print("\n{:>5} {:>12} {:>12} {:>12} {:>7} {:>10} {:>9}\n", "level", "tolerance m",
             "max error m", "rms error m", "tiles", "triangles", "MB");
  for (const auto& level : levels) {
    tiles += level.at("tiles").get<std::int64_t>();
    triangles += level.at("triangles").get<std::int64_t>();
    bytes += level.at("bytes").get<double>();
    fmt::print("{:>5} {:>12.3f} {:>12.3f} {:>12.3f} {:>7} {:>10} {:>9.2f}\n",
               level.at("level").get<int>(), level.at("tolerance_m").get<double>(),
               level.at("max_error_m").get<double>(), level.at("rms_error_m").get<double>(),
               level.at("tiles").get<std::int64_t>(), level.at("triangles").get<std::int64_t>(),
               level.at("bytes").get<double>() / 1e6);
  }
  fmt::print("{:>5} {:>38} {:>7} {:>10} {:>9.2f}\n", "all", "", tiles, triangles, bytes / 1e6);
}

/// Pictures of heights.
void describe_raster(const nlohmann::json& json) {
  print_row("written by", json.at("generator").get<std::string>());
  print_row("pictures", fmt::format("{}, {} px a tile", json.at("encoding").get<std::string>(),
                                    json.at("tile_px").get<int>()));
  print_row("heights", json.at("source").get<std::string>());
  fmt::print("\n{:>5} {:>7} {:>9}\n", "zoom", "tiles", "MB");
  for (const auto& zoom : json.at("zooms")) {
    fmt::print("{:>5} {:>7} {:>9.2f}\n", zoom.at("zoom").get<int>(),
               zoom.at("tiles").get<std::int64_t>(), zoom.at("bytes").get<double>() / 1e6);
  }
}

void describe_levels(const nlohmann::json& json) {
  const auto& dem = json.at("dem");
  print_row("written by", json.at("generator").get<std::string>());
  print_row("DEM", fmt::format(
                       "{} x {} samples, {} with data, {:.2f} to {:.2f} m",
                       dem.at("columns").get<std::int64_t>(), dem.at("rows").get<std::int64_t>(),
                       dem.at("samples_with_data").get<std::int64_t>(),
                       dem.at("min_height_m").get<double>(), dem.at("max_height_m").get<double>()));
  print_row("place", place_of(json.at("frame")));
  if (const std::string crs = crs_name_of(dem); !crs.empty()) print_row("CRS", crs);
  describe_each_level(json.at("levels"));
}

/// terrane.json of a folder or an archive; a damaged one is the input's fault.
void describe_summary(const std::string& text, const std::filesystem::path& out) {
  try {
    const auto json = nlohmann::json::parse(text);
    const auto format = json.at("format").get<std::string>();
    format == "terrane-geodetic/1" ? describe_terrain(json)
    : format == "terrane-raster/1" ? describe_raster(json)
                                   : describe_levels(json);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: its terrane.json is damaged ({}). Run 'terrane build' again",
                                 out.string(), error.what()));
  }
}

void describe_folder(const std::filesystem::path& out) {
  print_row("output", out.string());
  describe_summary(tiler::read_whole_file(out / "terrane.json"), out);
}

void describe_archive(const std::filesystem::path& file) {
  const auto archive = archive::open_archive(file);
  const archive::ArchiveFacts facts = archive->facts();
  print_row("archive", file.string());
  print_row("format", facts.format);
  print_row("size", fmt::format("{:.2f} MB, {} files, {} different contents",
                                static_cast<double>(archive->file().bytes()) / 1e6, facts.files,
                                facts.contents));
  if (!facts.tiles.empty()) print_row("tiles", facts.tiles);
  if (const auto summary = archive->read("terrane.json")) describe_summary(*summary, file);
}

void describe_dem(const InfoCommand& command, const CommonOptions& common) {
  ingest::OpenOptions options;
  apply(command.dem, options);
  const auto progress = make_progress(common.quiet);
  const auto dem = ingest::open_dem(command.dem.dem, options, *progress);
  const HeightStatistics heights = ingest::scan_heights(*dem, *progress);
  const ingest::DemDescription& about = dem->description();
  const GridShape shape = dem->heights().shape();
  const double samples = static_cast<double>(shape.columns) * static_cast<double>(shape.rows);

  print_row("DEM", dem->name());
  print_row("format", about.format);
  print_row("samples", fmt::format("{} x {}", shape.columns, shape.rows));
  print_row("spacing", fmt::format("{:.9g} x {:.9g} {}", about.column_spacing, about.row_spacing,
                                   about.crs_unit));
  print_row("CRS", about.crs_name.empty() ? "none: local metres" : about.crs_name);
  if (!about.datum_shift.empty()) print_row("to WGS84", about.datum_shift);
  print_row("heights over", about.vertical_crs.empty() ? "not said" : about.vertical_crs);
  print_row("band", fmt::format("{} of {}, {}", about.band, about.band_count, about.data_type));
  print_row("heights in",
            fmt::format("{} (from {})", name_of(about.vertical_unit), about.vertical_unit_origin));
  print_row("no data",
            about.nodata_origin.empty()
                ? "not declared"
                : fmt::format("{} (from {})", fmt::join(about.nodata, ", "), about.nodata_origin));
  print_row("with data",
            fmt::format("{} samples, {:.2f} %", heights.samples_with_data,
                        100 * static_cast<double>(heights.samples_with_data) / samples));
  print_row("heights",
            fmt::format("{:.2f} to {:.2f} m", heights.min_height_m, heights.max_height_m));
}

void run(const InfoCommand& command, const CommonOptions& common) {
  const std::filesystem::path first = command.dem.dem.front();
  const bool is_alone = command.dem.dem.size() == 1;
  if (is_alone && std::filesystem::exists(first / "terrane.json")) {
    describe_folder(first);
  } else if (is_alone && archive::is_archive_name(first)) {
    describe_archive(first);
  } else if (is_alone && std::filesystem::exists(first / ".work" / "key")) {
    throw InputError(fmt::format(
        "{}: its build is not finished. Run the same 'terrane build' again, it goes on there",
        first.string()));
  } else {
    describe_dem(command, common);
  }
}

}  // namespace

void add_info_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<InfoCommand>();
  CLI::App* info = app.add_subcommand("info", "Describe a DEM, or what was built from one");
  add_dem_options(*info, command->dem)
      ->required()
      ->description("DEM, several that make a mosaic, an output folder, or its archive");
  info->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli
