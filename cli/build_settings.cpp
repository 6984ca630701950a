#include "cli/build_settings.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <functional>
#include <map>
#include <sstream>

#include "cli/tile_options.h"
#include "core/errors.h"
#include "tiler/files/whole_file.h"

namespace terrane::cli {
namespace {

/// One value of a file, with what an error about it has to say.
struct Setting {
  const std::filesystem::path& file;
  std::string key;
  const toml::node& node;

  [[noreturn]] void refuse(std::string_view wanted) const {
    throw ConfigError(
        fmt::format("{}:{}: {} must be {}", file.string(), node.source().begin.line, key, wanted));
  }

  template <class T>
  T as(std::string_view wanted) const {
    const auto value = node.value_exact<T>();
    if (!value) refuse(wanted);
    return *value;
  }

  std::string text() const { return as<std::string>("a string"); }
  bool truth() const { return as<bool>("true or false"); }
  int whole_number() const { return static_cast<int>(as<std::int64_t>("a whole number")); }
  double real_number() const {
    const auto value = node.value<double>();
    if (!value || !node.is_number()) refuse("a number");
    return *value;
  }

  std::vector<std::string> texts() const {
    if (node.is_string()) return {text()};
    std::vector<std::string> result;
    if (!node.is_array()) refuse("a list of strings");
    for (const toml::node& item : *node.as_array()) {
      if (!item.is_string()) refuse("a list of strings");
      result.push_back(**item.as_string());
    }
    return result;
  }

  std::string number_or_text() const {
    if (node.is_string()) return text();
    if (node.is_integer()) return fmt::format("{}", **node.as_integer());
    return fmt::format("{}", real_number());
  }
};

/// A setting of [tiles] that is a word, through the same checks as on the command line.
template <std::optional<std::string> TileOptions::*kOption>
void read_word(const Setting& setting, BuildSettings& settings) {
  TileOptions options;
  options.*kOption = setting.number_or_text();
  apply(options, settings.build.format);
}

using Reader = std::function<void(const Setting&, BuildSettings&)>;

// every key of a settings file; config/ explains them
const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> known = {
      {"ingest.dem", [](const Setting& s, BuildSettings& to) { to.dem = s.texts(); }},
      {"ingest.band",
       [](const Setting& s, BuildSettings& to) { to.ingest.band = s.whole_number(); }},
      {"ingest.nodata",
       [](const Setting& s, BuildSettings& to) { to.ingest.nodata = s.number_or_text(); }},
      {"ingest.vertical_unit",
       [](const Setting& s, BuildSettings& to) {
         const auto unit = ingest::parse_vertical_unit(s.text());
         if (!unit) s.refuse("metre, foot or us-survey-foot");
         to.ingest.vertical_unit = unit;
       }},
      {"ingest.crs", [](const Setting& s, BuildSettings& to) { to.ingest.crs = s.text(); }},
      {"ingest.geoid", [](const Setting& s, BuildSettings& to) { to.tiling.geoid = s.text(); }},
      {"build.tolerance_m",
       [](const Setting& s, BuildSettings& to) { to.build.tolerance_m = s.real_number(); }},
      {"build.tile_cells",
       [](const Setting& s, BuildSettings& to) { to.build.tile_cells = s.whole_number(); }},
      {"build.levels_per_octave",
       [](const Setting& s, BuildSettings& to) { to.build.levels_per_octave = s.whole_number(); }},
      {"build.effort",
       [](const Setting& s, BuildSettings& to) { to.build.effort = s.whole_number(); }},
      {"build.scheme", [](const Setting& s, BuildSettings& to) { to.tiling.scheme = s.text(); }},
      {"build.format", [](const Setting& s, BuildSettings& to) { to.tiling.format = s.text(); }},
      {"geodetic.max_zoom",
       [](const Setting& s, BuildSettings& to) { to.tiling.max_zoom = s.whole_number(); }},
      {"geodetic.fill_m",
       [](const Setting& s, BuildSettings& to) { to.tiling.fill_m = s.real_number(); }},
      {"features.lines",
       [](const Setting& s, BuildSettings& to) { to.features.lines = s.texts(); }},
      {"features.water",
       [](const Setting& s, BuildSettings& to) { to.features.water = s.texts(); }},
      {"features.water_height_m",
       [](const Setting& s, BuildSettings& to) { to.features.water_height_m = s.real_number(); }},
      {"raster.px", [](const Setting& s, BuildSettings& to) { to.raster.px = s.whole_number(); }},
      {"raster.image", [](const Setting& s, BuildSettings& to) { to.raster.image = s.text(); }},
      {"build.jobs", [](const Setting& s, BuildSettings& to) { to.build.jobs = s.whole_number(); }},
      {"tiles.implicit",
       [](const Setting& s, BuildSettings& to) { to.build.format.is_implicit = s.truth(); }},
      {"tiles.tileset_tiles",
       [](const Setting& s, BuildSettings& to) {
         to.build.format.tiles_per_tileset = s.whole_number();
       }},
      {"tiles.compression", read_word<&TileOptions::compression>},
      {"tiles.positions", read_word<&TileOptions::positions>},
      {"tiles.material", read_word<&TileOptions::material>},
      {"tiles.skirts", read_word<&TileOptions::skirts>},
      {"tiles.colour", read_word<&TileOptions::colour>},
      {"tiles.attribution", read_word<&TileOptions::attribution>},
      {"tiles.texture", [](const Setting& s, BuildSettings& to) { to.drape.images = s.texts(); }},
      {"tiles.texture_format",
       [](const Setting& s, BuildSettings& to) { to.drape.format = picture_format_of(s.text()); }},
      {"tiles.texture_px",
       [](const Setting& s, BuildSettings& to) { to.build.format.texture_px = s.whole_number(); }},
  };
  return known;
}

std::string known_keys() {
  std::string keys;
  for (const auto& [key, reader] : readers()) keys += (keys.empty() ? "" : ", ") + key;
  return keys;
}

void read_setting(const Setting& setting, BuildSettings& settings) {
  const auto reader = readers().find(setting.key);
  if (reader == readers().end()) {
    throw ConfigError(fmt::format("{}:{}: unknown key {}. Known are: {}", setting.file.string(),
                                  setting.node.source().begin.line, setting.key, known_keys()));
  }
  reader->second(setting, settings);
}

std::string quoted(const std::string& text) {
  std::ostringstream stream;
  stream << toml::value<std::string>(text);
  return stream.str();
}

/// A path that means the same from everywhere; other sources ("NETCDF:...") as they are.
std::string repeatable(const std::string& source) {
  std::error_code error;
  if (!std::filesystem::exists(source, error)) return source;
  return std::filesystem::absolute(source).lexically_normal().string();
}

std::string list_of(const std::vector<std::string>& sources) {
  std::string text = "[";
  for (const std::string& source : sources) {
    text += (text.size() > 1 ? ", " : "") + quoted(repeatable(source));
  }
  return text + "]";
}

std::string tiling_toml(const TilingSettings& settings) {
  std::string text = "\n[geodetic]\n";
  if (settings.max_zoom) text += fmt::format("max_zoom = {}\n", *settings.max_zoom);
  text += fmt::format("fill_m = {}\n", settings.fill_m);
  return text;
}

std::string features_toml(const ingest::FeatureOptions& features) {
  if (features.empty()) return "";
  std::string text = "\n[features]\n";
  if (!features.lines.empty()) text += "lines = " + list_of(features.lines) + "\n";
  if (!features.water.empty()) text += "water = " + list_of(features.water) + "\n";
  if (features.water_height_m) {
    text += fmt::format("water_height_m = {}\n", *features.water_height_m);
  }
  return text;
}

}  // namespace

void read_settings(const std::filesystem::path& file, BuildSettings& settings) {
  const std::string text = tiler::read_whole_file(file);
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        fmt::format("{}:{}: {}", file.string(), error.source().begin.line, error.description()));
  }
  for (const auto& [section, content] : table) {
    const std::string name(section.str());
    if (!content.is_table()) {
      read_setting({file, name, content}, settings);
      continue;
    }
    for (const auto& [key, node] : *content.as_table()) {
      read_setting({file, name + "." + std::string(key.str()), node}, settings);
    }
  }
}

GridFeatures read_features(const BuildSettings& settings, ingest::Dem& dem, Progress& progress) {
  ingest::FeatureOptions options = settings.features;
  options.plan_tolerance_m = settings.build.tolerance_m;
  options.is_rounded = true;
  return ingest::read_features(dem, options, progress);
}

std::string to_toml(const BuildSettings& settings) {
  std::string text =
      "# Written by terrane build. Repeat with: terrane build --config THIS -o OUT\n";
  text += "[ingest]\ndem = " + list_of(settings.dem) + "\n";
  const ingest::OpenOptions& ingest = settings.ingest;
  if (ingest.band) text += fmt::format("band = {}\n", *ingest.band);
  if (ingest.nodata) text += "nodata = " + quoted(*ingest.nodata) + "\n";
  if (ingest.vertical_unit) {
    text += "vertical_unit = " + quoted(std::string(name_of(*ingest.vertical_unit))) + "\n";
  }
  if (!ingest.crs.empty()) text += "crs = " + quoted(ingest.crs) + "\n";
  if (!settings.tiling.geoid.empty()) {
    text += "geoid = " + quoted(repeatable(settings.tiling.geoid)) + "\n";
  }
  text += fmt::format(
      "\n[build]\ntolerance_m = {}\ntile_cells = {}\nlevels_per_octave = {}\neffort = {}\n",
      settings.build.tolerance_m, settings.build.tile_cells, settings.build.levels_per_octave,
      settings.build.effort);
  const bool is_native = settings.tiling.is_native();
  if (!is_native) {
    text += "scheme = " + quoted(settings.tiling.scheme) +
            "\nformat = " + quoted(settings.tiling.format) + "\n";
  }
  text += features_toml(settings.features);
  text += "\n[tiles]\n" + to_toml(settings.build.format);
  if (!settings.drape.images.empty()) {
    text += fmt::format("texture = {}\ntexture_format = \"{}\"\n", list_of(settings.drape.images),
                        word_of(settings.drape.format));
  }
  if (!settings.build.format.attribution.empty()) {
    text += "attribution = " + quoted(settings.build.format.attribution) + "\n";
  }
  if (!is_native) text += tiling_toml(settings.tiling);
  if (settings.tiling.is_raster()) text += to_toml(settings.raster);
  return text;
}

}  // namespace terrane::cli
