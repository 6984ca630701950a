#include "model/model_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <functional>
#include <map>

#include "core/errors.h"

namespace terrane::model {
namespace {

/// One value of the file, with what an error about it has to say.
class Entry {
 public:
  Entry(const std::string& file, std::string key, const toml::node& node)
      : file_(file), key_(std::move(key)), node_(node) {}

  [[noreturn]] void refuse(std::string_view wanted) const {
    throw ConfigError(
        fmt::format("{}:{}: {} must be {}", file_, node_.source().begin.line, key_, wanted));
  }

  std::string text() const {
    if (!node_.is_string()) refuse("a string");
    return *node_.value<std::string>();
  }
  double number() const {
    if (!node_.is_number()) refuse("a number");
    return *node_.value<double>();
  }
  double above_zero() const {
    if (!(number() > 0)) refuse("above 0");
    return number();
  }
  bool truth() const {
    if (!node_.is_boolean()) refuse("true or false");
    return *node_.value<bool>();
  }
  std::int64_t whole() const {
    if (!node_.is_integer()) refuse("a whole number");
    return *node_.value<std::int64_t>();
  }
  std::vector<std::string> texts() const {
    if (node_.is_string()) return {text()};
    if (!node_.is_array()) refuse("a list of strings");
    std::vector<std::string> result;
    for (const toml::node& item : *node_.as_array()) {
      result.push_back(Entry(file_, key_, item).text());
    }
    return result;
  }
  std::array<double, 3> three() const {
    if (!node_.is_array() || node_.as_array()->size() != 3) refuse("a list of three numbers");
    std::array<double, 3> result;
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = Entry(file_, key_, (*node_.as_array())[k]).number();
    }
    return result;
  }
  std::vector<double> numbers() const {
    if (!node_.is_array()) refuse("a list of numbers");
    std::vector<double> result;
    for (const toml::node& item : *node_.as_array()) {
      result.push_back(Entry(file_, key_, item).number());
    }
    return result;
  }
  /// Names of a table's keys and their values.
  std::vector<std::pair<std::string, Entry>> items() const {
    if (!node_.is_table()) refuse("a table");
    std::vector<std::pair<std::string, Entry>> result;
    for (const auto& [key, item] : *node_.as_table()) {
      const std::string name(key.str());
      result.emplace_back(name, Entry(file_, key_ + "." + name, item));
    }
    return result;
  }
  bool is_table() const { return node_.is_table(); }
  bool is_number() const { return node_.is_number(); }

 private:
  const std::string& file_;
  std::string key_;
  const toml::node& node_;
};

template <class T>
using Readers = std::map<std::string, std::function<void(const Entry&, T&)>>;

const Readers<BoxSettings> kBox = {
    {"west_deg",
     [](const Entry& e, BoxSettings& to) { to.west = e.number(), to.is_geographic = true; }},
    {"east_deg",
     [](const Entry& e, BoxSettings& to) { to.east = e.number(), to.is_geographic = true; }},
    {"south_deg",
     [](const Entry& e, BoxSettings& to) { to.south = e.number(), to.is_geographic = true; }},
    {"north_deg",
     [](const Entry& e, BoxSettings& to) { to.north = e.number(), to.is_geographic = true; }},
    {"west_m", [](const Entry& e, BoxSettings& to) { to.west = e.number(); }},
    {"east_m", [](const Entry& e, BoxSettings& to) { to.east = e.number(); }},
    {"south_m", [](const Entry& e, BoxSettings& to) { to.south = e.number(); }},
    {"north_m", [](const Entry& e, BoxSettings& to) { to.north = e.number(); }},
    {"bottom_m", [](const Entry& e, BoxSettings& to) { to.bottom_m = e.number(); }},
    {"top_m", [](const Entry& e, BoxSettings& to) { to.top_m = e.number(); }},
};

const Readers<SurfaceSettings> kSurface = {
    {"name", [](const Entry& e, SurfaceSettings& to) { to.name = e.text(); }},
    {"dem", [](const Entry& e, SurfaceSettings& to) { to.dem = e.texts(); }},
    {"nodata", [](const Entry& e, SurfaceSettings& to) { to.nodata = e.text(); }},
    {"level_m", [](const Entry& e, SurfaceSettings& to) { to.level_m = e.number(); }},
    {"inside", [](const Entry& e, SurfaceSettings& to) { to.inside = e.text(); }},
    {"mesh", [](const Entry& e, SurfaceSettings& to) { to.mesh = e.text(); }},
    {"over", [](const Entry& e, SurfaceSettings& to) { to.over = e.text(); }},
    {"tolerance_m", [](const Entry& e, SurfaceSettings& to) { to.tolerance_m = e.above_zero(); }},
};

const Readers<MaterialSettings> kMaterial = {
    {"name", [](const Entry& e, MaterialSettings& to) { to.name = e.text(); }},
    {"where", [](const Entry& e, MaterialSettings& to) { to.where = e.text(); }},
    {"empty", [](const Entry& e, MaterialSettings& to) { to.is_empty = e.truth(); }},
};

const Readers<FieldSource> kSource = {
    {"formula", [](const Entry& e, FieldSource& to) { to.formula = e.text(); }},
    {"raster", [](const Entry& e, FieldSource& to) { to.raster = e.text(); }},
    {"levels_m", [](const Entry& e, FieldSource& to) { to.levels_m = e.numbers(); }},
    {"nodata", [](const Entry& e, FieldSource& to) { to.nodata = e.text(); }},
    {"grid", [](const Entry& e, FieldSource& to) { to.grid = e.text(); }},
    {"array", [](const Entry& e, FieldSource& to) { to.array = e.text(); }},
};

FieldSource source_of(const Entry& entry) {
  FieldSource source;
  if (!entry.is_table()) {
    // a number is a formula, too
    source.formula = entry.is_number() ? fmt::format("{}", entry.number()) : entry.text();
    return source;
  }
  for (const auto& [key, value] : entry.items()) {
    const auto reader = kSource.find(key);
    if (reader == kSource.end()) {
      value.refuse("one of formula, raster with levels_m and nodata, grid with array");
    }
    reader->second(value, source);
  }
  const int kinds = (source.formula.empty() ? 0 : 1) + (source.raster.empty() ? 0 : 1) +
                    (source.grid.empty() ? 0 : 1);
  if (kinds != 1) entry.refuse("one of formula, raster and grid");
  return source;
}

const Readers<FieldSettings> kField = {
    {"name", [](const Entry& e, FieldSettings& to) { to.name = e.text(); }},
    {"unit", [](const Entry& e, FieldSettings& to) { to.unit = e.text(); }},
    {"tolerance", [](const Entry& e, FieldSettings& to) { to.tolerance = e.above_zero(); }},
    {"samples",
     [](const Entry& e, FieldSettings& to) {
       for (std::size_t k = 0; k < 3; ++k) to.samples[k] = static_cast<int>(e.three()[k]);
     }},
    {"of",
     [](const Entry& e, FieldSettings& to) {
       for (const auto& [material, entry] : e.items()) {
         to.sources.emplace_back(material, source_of(entry));
       }
     }},
};

const Readers<SectionSettings> kSection = {
    {"name", [](const Entry& e, SectionSettings& to) { to.name = e.text(); }},
    {"normal", [](const Entry& e, SectionSettings& to) { to.normal = e.three(); }},
    {"offset_m", [](const Entry& e, SectionSettings& to) { to.offset_m = e.number(); }},
};

const Readers<ModelSettings> kRefine = {
    {"most_cells",
     [](const Entry& e, ModelSettings& to) {
       if (e.whole() < 6) e.refuse("6 or more");
       to.most_cells = static_cast<std::size_t>(e.whole());
     }},
};

class FileReader {
 public:
  explicit FileReader(const std::string& file) : file_(file) {}

  template <class T>
  void read_table(const std::string& section, const toml::node& node, const Readers<T>& readers,
                  T& to) const {
    if (!node.is_table()) Entry(file_, section, node).refuse("a table");
    for (const auto& [key, value] : *node.as_table()) {
      const std::string name(key.str());
      const auto reader = readers.find(name);
      if (reader == readers.end()) {
        refuse_unknown(section + "." + name, value, known(readers));
      }
      reader->second(Entry(file_, section + "." + name, value), to);
    }
  }

  template <class T>
  void read_list(const std::string& section, const toml::node& node, const Readers<T>& readers,
                 std::vector<T>& to) const {
    if (!node.is_array())
      Entry(file_, section, node).refuse(fmt::format("written [[{}]]", section));
    for (const toml::node& item : *node.as_array()) {
      read_table(section, item, readers, to.emplace_back());
    }
  }

  void read_section(const std::string& name, const toml::node& node, ModelSettings& to) const {
    if (name == "box") return read_table(name, node, kBox, to.box);
    if (name == "refine") return read_table(name, node, kRefine, to);
    if (name == "surface") return read_list(name, node, kSurface, to.surfaces);
    if (name == "material") return read_list(name, node, kMaterial, to.materials);
    if (name == "field") return read_list(name, node, kField, to.fields);
    if (name == "section") return read_list(name, node, kSection, to.sections);
    refuse_unknown(name, node, "box, surface, material, field, section, refine");
  }

 private:
  template <class T>
  static std::string known(const Readers<T>& readers) {
    std::string keys;
    for (const auto& [key, reader] : readers) keys += (keys.empty() ? "" : ", ") + key;
    return keys;
  }

  [[noreturn]] void refuse_unknown(const std::string& key, const toml::node& node,
                                   const std::string& known) const {
    throw ConfigError(fmt::format("{}:{}: unknown key {}. Known are: {}", file_,
                                  node.source().begin.line, key, known));
  }

  const std::string& file_;
};

[[noreturn]] void refuse(const ModelSettings& settings, const std::string& what) {
  throw ConfigError(fmt::format("{}: {}", settings.file, what));
}

bool is_file_name(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

void check_surfaces(const ModelSettings& settings) {
  for (const SurfaceSettings& surface : settings.surfaces) {
    if (!is_file_name(surface.name)) {
      refuse(settings,
             fmt::format("surface '{}': give it a name of letters, digits, _ and -", surface.name));
    }
    const int kinds = (surface.dem.empty() ? 0 : 1) + (surface.inside.empty() ? 0 : 1) +
                      (surface.mesh.empty() ? 0 : 1);
    if (kinds != 1) {
      refuse(settings, fmt::format("surface {}: give one of dem, mesh, or level_m with inside",
                                   surface.name));
    }
    if (surface.tolerance_m == 0) {
      refuse(settings, fmt::format("surface {}: give its tolerance_m", surface.name));
    }
  }
}

void check(const ModelSettings& settings) {
  const BoxSettings& box = settings.box;
  if (!(box.west < box.east) || !(box.south < box.north) || !(box.bottom_m < box.top_m)) {
    refuse(settings,
           "box: give west, east, south and north (_deg or _m), bottom_m and top_m, the "
           "smaller ones smaller");
  }
  check_surfaces(settings);
  if (settings.materials.empty()) refuse(settings, "no material. Give one [[material]] at least");
  for (const SectionSettings& section : settings.sections) {
    if (!is_file_name(section.name)) {
      refuse(settings,
             fmt::format("section '{}': give it a name of letters, digits, _ and -", section.name));
    }
    if (section.normal == std::array<double, 3>{}) {
      refuse(settings, fmt::format("section {}: its normal has no direction", section.name));
    }
  }
}

}  // namespace

ModelSettings read_model_file(const std::filesystem::path& file) {
  ModelSettings settings;
  settings.file = file.string();
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(fmt::format("{}: is no file. Give a model file (TOML)", settings.file));
  }
  toml::table table;
  try {
    table = toml::parse_file(settings.file);
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        fmt::format("{}:{}: {}", settings.file, error.source().begin.line, error.description()));
  }
  const FileReader reader(settings.file);
  for (const auto& [key, node] : table) reader.read_section(std::string(key.str()), node, settings);
  check(settings);
  return settings;
}

}  // namespace terrane::model
