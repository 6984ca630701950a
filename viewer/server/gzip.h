#pragma once

#include <string>
#include <string_view>

namespace terrane::viewer {

/// Compresses to the gzip format; the same content gives the same bytes (no time, no name).
std::string gzip(std::string_view content);

}  // namespace terrane::viewer
