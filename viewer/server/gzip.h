#pragma once

#include <string>
#include <string_view>

namespace terrane::viewer {

/// Compresses to the gzip format; the same content gives the same bytes (no time, no name).
std::string gzip(std::string_view content);

/// True if the value of an Accept-Encoding header allows gzip (RFC 9110, section 12.5.3).
bool accepts_gzip(std::string_view accept_encoding);

}  // namespace terrane::viewer
