#pragma once

#include <filesystem>
#include <string_view>

namespace terrane::viewer {

/// What a file is to a browser, told from its name.
struct MediaType {
  std::string_view name;  ///< value of Content-Type
  bool is_compressible;   ///< gzip is worth its time
};

/// Media type of a file; application/octet-stream for an extension that is not known.
MediaType media_type_of(const std::filesystem::path& file);

}  // namespace terrane::viewer
