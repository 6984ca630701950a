#include "tiler/verify/picture_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "tiler/verify/json_file.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

/// Tiles from one to another, both among them; columns go on round the Earth.
struct Square {
  std::int64_t left = 0, top = 0, right = 0, bottom = 0;
};

/// Those that the bounds reach by more than so many pixels.
Square reached(const PictureSet& set, int zoom, double by_px) {
  const auto& [west, south, east, north] = set.bounds_deg;
  const double px = set.tile_px;
  const auto [left, top] = set.on_map({west, north}, zoom);
  const auto [right, bottom] = set.on_map({east, south}, zoom);
  const auto last = static_cast<std::int64_t>(set.pixels_across(zoom) / px) - 1;
  const auto tile = [&](double at) { return static_cast<std::int64_t>(std::floor(at / px)); };
  return {tile(left + by_px), std::clamp<std::int64_t>(tile(top + by_px), 0, last),
          tile(right - by_px), std::clamp<std::int64_t>(tile(bottom - by_px), 0, last)};
}

/// Whoever lists the tiles of damaged bounds would never come to an end.
void check_bounds(const PictureSet& set, const std::filesystem::path& listing) {
  const auto& [west, south, east, north] = set.bounds_deg;
  if (!(west >= -180 && west < east && east <= west + 361 && south >= -90 && south < north &&
        north <= 90)) {
    throw damaged(listing, "has bounds that are none");
  }
  for (int zoom = 0; zoom <= set.finest(); ++zoom) {
    const Square tiles = reached(set, zoom, 0);
    const auto columns = static_cast<double>(tiles.right - tiles.left + 1);
    const auto rows = static_cast<double>(tiles.bottom - tiles.top + 1);
    // a row and a column more, where the bounds only touch them
    const auto stated = static_cast<double>(set.zooms[static_cast<std::size_t>(zoom)].tiles);
    if (columns * rows <= 4 * stated + 4) continue;
    throw damaged(listing, fmt::format("has bounds of {} tiles at zoom {}, terrane.json has {}",
                                       columns * rows, zoom, stated));
  }
}

}  // namespace

std::string to_string(const PictureKey& key) {
  return fmt::format("tile {}/{}/{}", key.zoom, key.x, key.y);
}

std::filesystem::path PictureSet::file_of(const PictureKey& key) const {
  return folder / fmt::format("{}/{}/{}.png", key.zoom, key.x, key.y);
}

double PictureSet::pixels_across(int zoom) const { return std::ldexp(tile_px, zoom); }

std::array<double, 2> PictureSet::on_map(const LonLat& place, int zoom) const {
  const double latitude = place.latitude_deg * std::numbers::pi / 180;
  const double north = std::asinh(std::tan(latitude)) / std::numbers::pi;  // -1 to 1 in the square
  const double across = pixels_across(zoom);
  return {(place.longitude_deg + 180) / 360 * across, (1 - north) / 2 * across};
}

std::vector<PictureKey> PictureSet::wanted(int zoom) const {
  constexpr double kClearly_px = 1e-3;
  const Square tiles = reached(*this, zoom, kClearly_px);
  const std::int64_t across = std::int64_t{1} << zoom;
  std::set<PictureKey> keys;
  for (std::int64_t y = tiles.top; y <= tiles.bottom; ++y) {
    for (std::int64_t x = tiles.left; x <= std::min(tiles.right, tiles.left + across - 1); ++x) {
      keys.insert({zoom, (x % across + across) % across, y});
    }
  }
  return {keys.begin(), keys.end()};
}

bool PictureSet::may_have(const PictureKey& key) const {
  constexpr double kTouching_px = -1e-3;
  if (key.zoom < 0 || key.zoom > finest()) return false;
  const Square tiles = reached(*this, key.zoom, kTouching_px);
  const std::int64_t across = std::int64_t{1} << key.zoom;
  const std::int64_t from_left = ((key.x - tiles.left) % across + across) % across;
  return key.x >= 0 && key.x < across && tiles.left + from_left <= tiles.right &&
         key.y >= tiles.top && key.y <= tiles.bottom;
}

std::vector<double> PictureSet::heights_of(const Picture& picture) const {
  std::vector<double> heights;
  heights.reserve(picture.rgb.size() / 3);
  for (std::size_t k = 0; k + 2 < picture.rgb.size(); k += 3) {
    const double red = picture.rgb[k], green = picture.rgb[k + 1], blue = picture.rgb[k + 2];
    heights.push_back(encoding == "terrarium" ? red * 256 + green + blue / 256 - 32768
                                              : -10000 + (red * 65536 + green * 256 + blue) / 10);
  }
  return heights;
}

double PictureSet::stored_m(double height_m) const {
  return encoding == "terrarium" ? std::round(height_m * 256) / 256
                                 : std::round((height_m + 10000) * 10) / 10 - 10000;
}

PictureSet read_picture_set(const std::filesystem::path& folder) {
  PictureSet set{.folder = folder};
  const auto listing = folder / "tiles.json", summary = folder / "terrane.json";
  int finest = 0;
  read_json(listing, [&](const json& document) {
    set.tile_px = document.at("tileSize");
    set.encoding = document.at("encoding");
    set.bounds_deg = document.at("bounds");
    finest = document.at("maxzoom");
    if (document.at("tiles").at(0) != "{z}/{x}/{y}.png") {
      throw InputError(
          fmt::format("{}: lists pictures that verify does not read. Those of --raster-image png "
                      "have the same heights",
                      listing.string()));
    }
    if ((set.encoding != "terrarium" && set.encoding != "mapbox") || set.tile_px < 1 ||
        set.tile_px > 4096 || document.at("scheme") != "xyz" || document.at("minzoom") != 0) {
      throw damaged(listing, "is not the one that terrane writes");
    }
  });
  read_json(summary, [&](const json& document) {
    for (const json& zoom : document.at("zooms")) {
      if (zoom.at("zoom") != set.zooms.size()) throw damaged(summary, "zooms do not count from 0");
      set.zooms.push_back({zoom.at("tiles"), zoom.at("bytes")});
    }
    if (document.at("tile_px") != set.tile_px || document.at("encoding") != set.encoding) {
      set.faults.push_back("tiles.json: has another size or encoding than terrane.json");
    }
  });
  if (set.zooms.empty() || finest != set.finest() || finest > 30) {
    throw damaged(listing, fmt::format("names {} as the finest zoom, terrane.json has {} zooms",
                                       finest, set.zooms.size()));
  }
  check_bounds(set, listing);
  return set;
}

}  // namespace terrane::verify
