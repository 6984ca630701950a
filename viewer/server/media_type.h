#pragma once

#include <filesystem>
#include <string_view>

namespace terrane::viewer {

/// What a file is to a browser, told from its name.
struct MediaType {
  std::string_view name;         ///< value of Content-Type
  bool is_compressible = false;  ///< gzip on the way is worth its time
  bool varies = false;           ///< may be sent in several codings (Vary: Accept-Encoding)
  bool may_lie_gzipped =
      false;             ///< the file itself may be gzipped, under the name of the plain one
  bool is_tile = false;  ///< content that only changes with the whole data set
};

/// Media type of a file; application/octet-stream for an extension that is not known.
MediaType media_type_of(const std::filesystem::path& file);

}  // namespace terrane::viewer
