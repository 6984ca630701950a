#include "viewer/server/media_type.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace terrane::viewer {
namespace {

constexpr MediaType text(std::string_view name) {
  return {.name = name, .is_compressible = true, .varies = true};
}

constexpr MediaType json(std::string_view name) {
  return {.name = name, .is_compressible = true, .varies = true, .may_lie_gzipped = true};
}

// Tiles are compressed already (meshopt): gzip on the way would cost more time than it saves.
constexpr MediaType tile(std::string_view name) {
  return {.name = name, .varies = true, .may_lie_gzipped = true, .is_tile = true};
}

constexpr MediaType picture(std::string_view name) { return {.name = name, .is_tile = true}; }

constexpr MediaType archive(std::string_view name) { return {.name = name}; }

using Known = std::pair<std::string_view, MediaType>;
constexpr std::array kMediaTypes = {
    Known{".html", text("text/html; charset=utf-8")},
    Known{".js", text("text/javascript; charset=utf-8")},
    Known{".mjs", text("text/javascript; charset=utf-8")},
    Known{".css", text("text/css; charset=utf-8")},
    Known{".map", text("application/json")},
    Known{".json", json("application/json")},
    Known{".geojson", json("application/geo+json")},
    Known{".glb", tile("model/gltf-binary")},
    Known{".gltf", json("model/gltf+json")},
    Known{".bin", tile("application/octet-stream")},
    Known{".subtree", tile("application/octet-stream")},
    Known{".b3dm", tile("application/octet-stream")},
    Known{".terrain", tile("application/vnd.quantized-mesh")},
    Known{".png", picture("image/png")},
    Known{".jpg", picture("image/jpeg")},
    Known{".jpeg", picture("image/jpeg")},
    Known{".webp", picture("image/webp")},
    Known{".svg", text("image/svg+xml")},
    Known{".ico", picture("image/x-icon")},
    Known{".wasm", text("application/wasm")},
    Known{".toml", text("text/plain; charset=utf-8")},
    Known{".txt", text("text/plain; charset=utf-8")},
    Known{".xml", text("application/xml")},
    Known{".tree", archive("application/vnd.terrane.merge-tree")},
    Known{".pmtiles", archive("application/vnd.pmtiles")},
    Known{".3tz", archive("application/vnd.maxar.archive.3tz+zip")},
};

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

MediaType media_type_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), to_lower);
  const auto known = std::find_if(kMediaTypes.begin(), kMediaTypes.end(),
                                  [&](const auto& type) { return type.first == extension; });
  return known == kMediaTypes.end() ? MediaType{"application/octet-stream"} : known->second;
}

}  // namespace terrane::viewer
