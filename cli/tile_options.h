#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/drape.h"
#include "tiler/tile_format.h"

namespace terrane::cli {

/// How tiles are to be written, in the words of the command line and of settings files; what is not
/// given stays as it is.
struct TileOptions {
  std::optional<bool> is_implicit;
  std::optional<std::int64_t> tiles_per_tileset;
  std::optional<int> texture_px;
  std::optional<std::string> compression, positions, material, colour, skirts, attribution;
  std::vector<std::string> textures;
  std::optional<std::string> texture_format;
};

void add_tile_options(CLI::App& command, TileOptions& options);

/// Puts what was given over \p format.
/// \throws ConfigError that names the option, for a word that is not known.
void apply(const TileOptions& options, tiler::TileFormat& format);

void apply(const TileOptions& options, ingest::DrapeOptions& drape);

/// The first option of those that say how tiles of the DEM's own grid are written, if one is given:
/// all but the attribution.
const char* first_of_native_tiles(const TileOptions& options);

/// \throws ConfigError if it is neither jpeg nor webp.
ingest::PictureFormat picture_format_of(const std::string& word);
std::string word_of(ingest::PictureFormat format);

/// The lines of a settings file that make this format from the default one.
std::string to_toml(const tiler::TileFormat& format);

}  // namespace terrane::cli
