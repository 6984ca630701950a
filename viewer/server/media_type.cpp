#include "viewer/server/media_type.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace terrane::viewer {
namespace {

// Tiles are compressed already (meshopt): gzip on the way would cost more time than it saves.
constexpr std::array kMediaTypes = {
    std::pair{std::string_view(".html"), MediaType{"text/html; charset=utf-8", true}},
    std::pair{std::string_view(".js"), MediaType{"text/javascript; charset=utf-8", true}},
    std::pair{std::string_view(".css"), MediaType{"text/css; charset=utf-8", true}},
    std::pair{std::string_view(".json"), MediaType{"application/json", true}},
    std::pair{std::string_view(".glb"), MediaType{"model/gltf-binary", false}},
    std::pair{std::string_view(".gltf"), MediaType{"model/gltf+json", true}},
    std::pair{std::string_view(".terrain"), MediaType{"application/vnd.quantized-mesh", false}},
    std::pair{std::string_view(".png"), MediaType{"image/png", false}},
    std::pair{std::string_view(".jpg"), MediaType{"image/jpeg", false}},
    std::pair{std::string_view(".svg"), MediaType{"image/svg+xml", true}},
    std::pair{std::string_view(".ico"), MediaType{"image/x-icon", false}},
    std::pair{std::string_view(".wasm"), MediaType{"application/wasm", true}},
    std::pair{std::string_view(".toml"), MediaType{"text/plain; charset=utf-8", true}},
    std::pair{std::string_view(".txt"), MediaType{"text/plain; charset=utf-8", true}},
};

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

MediaType media_type_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), to_lower);
  const auto* known = std::find_if(kMediaTypes.begin(), kMediaTypes.end(),
                                   [&](const auto& type) { return type.first == extension; });
  return known == kMediaTypes.end() ? MediaType{"application/octet-stream", false} : known->second;
}

}  // namespace terrane::viewer
