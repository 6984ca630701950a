#include "tiler/gltf/pack_glb.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

void append_word(std::string& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  char raw[4];
  std::memcpy(raw, &word, 4);
  bytes.append(raw, 4);
}

}  // namespace

std::string pack_glb(std::string json, const std::string& binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t bytes = 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (bytes > std::numeric_limits<std::uint32_t>::max()) {
    throw OutputError(fmt::format("a glb of {} bytes: 4 GiB are the most", bytes));
  }
  std::string glb = "glTF";
  append_word(glb, 2);
  append_word(glb, bytes);
  append_word(glb, json.size());
  glb += "JSON" + json;
  if (binary.empty()) return glb;
  append_word(glb, binary.size());
  glb += std::string("BIN\0", 4) + binary;
  return glb;
}

}  // namespace terrane::tiler
