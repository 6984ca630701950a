#pragma once

#include <string>
#include <string_view>

namespace terrane::tiler {

/// Compresses to the gzip format as small as it gets; the same content gives the same bytes (no
/// time, no name).
std::string gzip(std::string_view content);

}  // namespace terrane::tiler
