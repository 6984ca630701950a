#pragma once

#include <string_view>

namespace terrane::viewer {

/// True if the value of an Accept-Encoding header allows a coding, by its name or as `*`.
/// \par Source
/// RFC 9110, section 12.5.3.
bool accepts_coding(std::string_view accept_encoding, std::string_view coding);

}  // namespace terrane::viewer
