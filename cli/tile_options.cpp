#include "cli/tile_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/errors.h"
#include "tiler/build.h"

namespace terrane::cli {
namespace {

/// Words for the values of an enum, in their order.
using Words = std::vector<std::string>;

const Words kCompressions = {"meshopt", "draco", "none"};
const Words kPositions = {"lattice", "float"};
const Words kMaterials = {"lit", "unlit"};
const Words kPictureFormats = {"jpeg", "webp"};
const Words kColours = {"none", "hypsometric", "slope"};

template <class Value>
void choose(const char* option, const std::optional<std::string>& given, const Words& words,
            Value& value) {
  if (!given) return;
  const auto found = std::ranges::find(words, *given);
  if (found == words.end()) {
    throw ConfigError(
        fmt::format("{} {}: is not known. Use {}", option, *given, fmt::join(words, ", ")));
  }
  value = static_cast<Value>(found - words.begin());
}

template <class Value>
const std::string& word_for(const Words& words, Value value) {
  return words[static_cast<std::size_t>(value)];
}

std::optional<double> skirt_of(const std::string& given) {
  if (given == "none") return std::nullopt;
  if (given == "auto") return 0;
  double metres = 0;
  const char* end = given.data() + given.size();
  const auto [stop, error] = std::from_chars(given.data(), end, metres);
  if (error != std::errc() || stop != end || !(metres > 0)) {
    throw ConfigError(
        fmt::format("--skirts {}: must be a number of metres above 0, auto or none", given));
  }
  return metres;
}

}  // namespace

void add_tile_options(CLI::App& command, TileOptions& options) {
  const auto add = [&](const char* name, auto& option, const char* text) {
    command.add_option(name, option, text)->group("How tiles are written");
  };
  command
      .add_flag_callback(
          "--implicit", [&options] { options.is_implicit = true; },
          "Implicit tiling: subtrees in place of a list of tiles")
      ->group("How tiles are written");
  add("--tileset-tiles", options.tiles_per_tileset,
      "Tiles above which the list is split into external tilesets [1000]");
  add("--compression", options.compression, "meshopt, draco or none [meshopt]");
  add("--positions", options.positions,
      "lattice: 16-bit integers where they fit; float: for readers without KHR_mesh_quantization "
      "[lattice]");
  add("--material", options.material, "lit, or unlit: texture or colours as they are [lit]");
  add("--skirts", options.skirts,
      "Curtains below shared borders, for clients that mix levels without blending: metres, auto "
      "(five times the level's tolerance) or none [none]");
  add("--colour", options.colour, "Vertex colours: hypsometric, slope or none [none]");
  add("--texture", options.textures,
      "Image to lay over the terrain, in any format and CRS; several: later ones on top");
  add("--texture-format", options.texture_format, "jpeg, or webp (EXT_texture_webp) [jpeg]");
  add("--texture-px", options.texture_px,
      "Texels along a tile, 16 to 4096; never more than the image has [256]");
  add("--attribution", options.attribution, "Who made the data; clients show it");
}

void apply(const TileOptions& options, tiler::TileFormat& format) {
  if (options.is_implicit) format.is_implicit = *options.is_implicit;
  if (options.tiles_per_tileset) format.tiles_per_tileset = *options.tiles_per_tileset;
  choose("--compression", options.compression, kCompressions, format.compression);
  choose("--positions", options.positions, kPositions, format.positions);
  choose("--material", options.material, kMaterials, format.material);
  choose("--colour", options.colour, kColours, format.colour);
  if (options.skirts) format.skirt_m = skirt_of(*options.skirts);
  if (options.texture_px) format.texture_px = *options.texture_px;
  if (options.attribution) format.attribution = *options.attribution;
}

void apply(const TileOptions& options, ingest::DrapeOptions& drape) {
  if (!options.textures.empty()) drape.images = options.textures;
  if (options.texture_format) drape.format = picture_format_of(*options.texture_format);
}

const char* first_of_native_tiles(const TileOptions& options) {
  return options.is_implicit         ? "--implicit"
         : options.tiles_per_tileset ? "--tileset-tiles"
         : options.compression       ? "--compression"
         : options.positions         ? "--positions"
         : options.material          ? "--material"
         : options.skirts            ? "--skirts"
         : options.colour            ? "--colour"
         : !options.textures.empty() ? "--texture"
         : options.texture_format    ? "--texture-format"
         : options.texture_px        ? "--texture-px"
                                     : nullptr;
}

ingest::PictureFormat picture_format_of(const std::string& word) {
  ingest::PictureFormat format = ingest::PictureFormat::kJpeg;
  choose("--texture-format", word, kPictureFormats, format);
  return format;
}

std::string word_of(ingest::PictureFormat format) { return word_for(kPictureFormats, format); }

std::string to_toml(const tiler::TileFormat& format) {
  const std::string skirts = !format.skirt_m        ? "none"
                             : *format.skirt_m == 0 ? "auto"
                                                    : fmt::format("{}", *format.skirt_m);
  return fmt::format(
      "implicit = {}\ntileset_tiles = {}\ncompression = \"{}\"\npositions = \"{}\"\n"
      "material = \"{}\"\nskirts = \"{}\"\ncolour = \"{}\"\ntexture_px = {}\n",
      format.is_implicit, format.tiles_per_tileset, word_for(kCompressions, format.compression),
      word_for(kPositions, format.positions), word_for(kMaterials, format.material), skirts,
      word_for(kColours, format.colour), format.texture_px);
}

}  // namespace terrane::cli
