#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "viewer/server/byte_range.h"
#include "viewer/server/served_file.h"

namespace terrane::viewer {

/// What of an HTTP request matters for files.
struct FileRequest {
  std::string method;
  std::string path;  ///< percent-decoded once, without query
  std::string accept_encoding;
  std::string if_none_match;
  std::string if_range;
  std::string range;
};

/// Part of an open file.
struct FilePart {
  std::shared_ptr<const OpenFile> file;
  ByteRange range;
};

/// An HTTP response as it is to be sent, less the body for HEAD.
struct FileAnswer {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;  ///< with Content-Length
  std::variant<std::string, FilePart> body;
};

/// Answers a request with a file of the folder: 200, 206, 304, or 404, 405, 416 with a line of
/// text; OPTIONS with what is allowed (CORS).
///
/// Guarantees: what open_served_file() guarantees; every representation of a file (plain, gzip)
/// has its own strong ETag, which changes when the file does.
///
/// \param root  canonical path of the served folder.
FileAnswer answer_file_request(const std::filesystem::path& root, const FileRequest& request);

}  // namespace terrane::viewer
