#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace terrane::viewer {

/// The path that a request asks for: without query, percent-decoded once. Nothing if an escape is
/// broken or the target is no path.
///
/// \param target  as it stands in the request line: "/a%20b?c", "http://host/a".
/// \par Source
/// RFC 9112, section 3.2; RFC 3986, section 2.1.
std::optional<std::string> decode_url_path(std::string_view target);

/// Percent-encodes what has a meaning in a path, '/' excepted.
std::string encode_url_path(std::string_view path);

}  // namespace terrane::viewer
