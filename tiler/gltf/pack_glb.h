#pragma once

#include <string>

namespace terrane::tiler {

/// Joins a glTF document and its buffer (may be empty: none) to one binary glTF 2.0.
/// \pre the buffer is whole words.
/// \throws OutputError if it would be larger than 4 GiB, the most a glb can be.
std::string pack_glb(std::string json, const std::string& binary);

}  // namespace terrane::tiler
