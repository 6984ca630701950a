#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viewer/server/file_content.h"
#include "viewer/server/gzip_cache.h"
#include "viewer/server/site.h"

namespace terrane::viewer {

/// What of an HTTP request matters for files.
struct FileRequest {
  std::string method;
  std::string target;  ///< as in the request line
  std::string version = "HTTP/1.1";
  bool has_host = true;
  std::string accept_encoding;
  std::string if_none_match;
  std::string if_range;
  std::string range;
  bool must_be_quick = false;  ///< what takes long to compress is not compressed now
};

/// How files are sent.
struct FileRules {
  int tiles_max_age_s = 0;  ///< how long clients may keep tiles without asking; 0: always ask
};

/// An HTTP response as it is to be sent, less Content-Length. Answers to HEAD and 304 have the body
/// whose length they state; it is not sent.
struct FileAnswer {
  /// In place of a status: this takes time. Ask without must_be_quick, elsewhere, then again.
  static constexpr int kTakesTime = 0;

  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  FileContent body;
};

/// Answers a request with a file of the site: 200, 206, 301, 304, or 400, 404, 405, 414, 416 with a
/// line of text; OPTIONS with what is allowed (CORS).
///
/// A file `x` is sent as `x.br` or `x.gz` where such a file lies beside it, is not older, and the
/// client takes it; else text is gzipped on the way, and kept in \p cache. A file that lies gzipped
/// is sent so, or unpacked for those who cannot read it.
///
/// Guarantees: what DataSet guarantees; every representation of a file (plain, gzip, Brotli) has
/// its own strong ETag, which changes when the file does.
FileAnswer answer_file_request(const Site& site, const FileRequest& request, const FileRules& rules,
                               GzipCache& cache);

}  // namespace terrane::viewer
