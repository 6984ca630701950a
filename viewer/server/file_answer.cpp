#include "viewer/server/file_answer.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "core/deflate/deflate.h"
#include "viewer/server/content_coding.h"
#include "viewer/server/media_type.h"
#include "viewer/server/url_path.h"

namespace terrane::viewer {
namespace {

// Larger JSON would take a second to compress, and all of it in memory.
constexpr std::uint64_t kLargestGzipBytes = 64 << 20;
constexpr std::uint64_t kSmallestGzipBytes = 256;  // less becomes no packet less
constexpr std::uint64_t kLargestPlainBytes = 1 << 30;
constexpr int kGzipLevel = 4;                   // the viewer: half the time of 6, 5 % more bytes
constexpr std::uint64_t kQuickBytes = 1 << 18;  // compressed in a few milliseconds
constexpr std::size_t kLongestTarget = 8192;

FileAnswer text_answer(int status, const std::string& text) {
  FileAnswer answer{.status = status, .headers = {}, .body = FileContent(text + "\n")};
  answer.headers = {{"Content-Type", "text/plain; charset=utf-8"},
                    {"Cache-Control", "no-cache"},
                    {"Access-Control-Allow-Origin", "*"}};
  return answer;
}

FileAnswer method_answer() {
  FileAnswer answer = text_answer(405, "only GET, HEAD and OPTIONS are served");
  answer.headers.emplace_back("Allow", "GET, HEAD, OPTIONS");
  return answer;
}

FileAnswer options_answer() {
  return {.status = 204,
          .headers = {{"Allow", "GET, HEAD, OPTIONS"},
                      {"Access-Control-Allow-Origin", "*"},
                      {"Access-Control-Allow-Methods", "GET, HEAD, OPTIONS"},
                      {"Access-Control-Allow-Headers", "*"},
                      {"Access-Control-Max-Age", "86400"}},
          .body = {}};
}

/// What is wrong with the form of a request; nothing if it is good.
std::optional<FileAnswer> refuse_form(const FileRequest& request) {
  // a NUL in the request line cuts it off before its version
  if (!request.version.starts_with("HTTP/")) return text_answer(400, "this is no HTTP");
  if (request.version != "HTTP/1.1" && request.version != "HTTP/1.0") {
    return text_answer(505, "only HTTP/1.1 and 1.0 are spoken");
  }
  if (request.version == "HTTP/1.1" && !request.has_host) {
    return text_answer(400, "the header Host is missing");
  }
  if (request.target.size() > kLongestTarget) return text_answer(414, "the address is too long");
  return std::nullopt;
}

FileAnswer redirect_answer(const std::string& location) {
  FileAnswer answer = text_answer(301, "see " + location);
  answer.headers.emplace_back("Location", location);
  return answer;
}

FileAnswer no_such_bytes_answer(std::uint64_t bytes) {
  FileAnswer answer = text_answer(416, "the file has no such bytes");
  answer.headers.emplace_back("Content-Range", fmt::format("bytes */{}", bytes));
  return answer;
}

// Weak comparison: a cache may have marked our tag W/ on its way.
bool is_listed(std::string_view tags, std::string_view etag) {
  return tags == "*" || tags.find(etag) != std::string_view::npos;
}

/// One form of a file: plain, or coded as Content-Encoding says.
struct Representation {
  FileContent content;
  std::string tag;
  std::string_view coding;  ///< empty for plain
};

class Answering {
 public:
  Answering(const Site& site, const FileRequest& request, const FileRules& rules, GzipCache& cache,
            std::string path)
      : site_(site), request_(request), rules_(rules), cache_(cache), path_(std::move(path)) {}

  FileAnswer run() {
    auto file = site_.find(path_);
    if (!file) {
      const auto location = site_.redirect(path_);
      return location ? redirect_answer(*location) : text_answer(404, "not found");
    }
    const MediaType type = media_type_of(file->name);
    if (path_.ends_with('/')) path_ += "index.html";
    file->is_gzipped = file->is_gzipped || lies_gzipped(*file, type);
    const auto chosen = choose(*file, type);
    return chosen ? answer_with(*chosen, type) : FileAnswer{.status = FileAnswer::kTakesTime};
  }

 private:
  bool accepts(std::string_view coding) const {
    return accepts_coding(request_.accept_encoding, coding);
  }

  // quantized-mesh is stored gzipped by custom, and other tools gzip glb and JSON on disk
  static bool lies_gzipped(const DataSetFile& file, const MediaType& type) {
    return type.may_lie_gzipped && looks_gzipped(file.content.read(0, 3));
  }

  /// Nothing if it takes more time than there is.
  std::optional<Representation> choose(const DataSetFile& file, const MediaType& type) const {
    const Representation as_it_is{file.content, file.tag, ""};
    if (file.is_gzipped) return accepts("gzip") ? gzipped(file) : unpacked(file);
    // a range counts bytes of the plain file
    if (!request_.range.empty() || !type.varies) return as_it_is;
    if (auto sibling = find_sibling(file, "br", ".br")) return *sibling;
    if (auto sibling = find_sibling(file, "gzip", ".gz")) return *sibling;
    const std::uint64_t bytes = file.content.bytes();
    if (!type.is_compressible || bytes < kSmallestGzipBytes || bytes > kLargestGzipBytes ||
        !accepts("gzip")) {
      return as_it_is;
    }
    const std::string key = path_ + "\n" + file.tag;
    if (takes_time(bytes, key)) return std::nullopt;
    const auto text = cache_.get(key, [&] { return gzip(file.content.read_all(), kGzipLevel); });
    return Representation{FileContent(text), file.tag + "-gz", "gzip"};
  }

  bool takes_time(std::uint64_t bytes, const std::string& key) const {
    return request_.must_be_quick && bytes > kQuickBytes && !cache_.holds(key);
  }

  std::optional<Representation> find_sibling(const DataSetFile& file, std::string_view coding,
                                             const std::string& suffix) const {
    if (!accepts(coding)) return std::nullopt;
    const auto sibling = site_.find(path_ + suffix);
    // an older one is of a file that was there before
    if (!sibling || sibling->modified_ns < file.modified_ns) return std::nullopt;
    return Representation{sibling->content, fmt::format("{}-{}{}", file.tag, sibling->tag, suffix),
                          coding};
  }

  static Representation gzipped(const DataSetFile& file) {
    return {file.content, file.tag + "-gz", "gzip"};
  }

  std::optional<Representation> unpacked(const DataSetFile& file) const {
    const std::string key = path_ + "\nplain\n" + file.tag;
    if (takes_time(file.content.bytes(), key)) return std::nullopt;
    const auto text = cache_.get(
        key, [&] { return gunzip(file.content.read_all(), kLargestPlainBytes).value_or(""); });
    return Representation{FileContent(text), file.tag, ""};
  }

  std::string cache_control(const MediaType& type) const {
    // pages and JSON name the tiles: ask again each time, so that a folder built anew shows at once
    if (rules_.tiles_max_age_s <= 0 || !type.is_tile) return "no-cache";
    return fmt::format("public, max-age={}", rules_.tiles_max_age_s);
  }

  FileAnswer answer_with(const Representation& chosen, const MediaType& type) const {
    const std::string etag = "\"" + chosen.tag + "\"";
    FileAnswer answer{.status = 200, .headers = {}, .body = chosen.content};
    answer.headers = {{"Content-Type", std::string(type.name)},
                      {"ETag", etag},
                      {"Cache-Control", cache_control(type)},
                      {"Accept-Ranges", "bytes"},
                      {"Access-Control-Allow-Origin", "*"},
                      {"Access-Control-Expose-Headers",
                       "Accept-Ranges, Content-Encoding, Content-Length, Content-Range, ETag"},
                      {"X-Content-Type-Options", "nosniff"}};
    if (type.varies) answer.headers.emplace_back("Vary", "Accept-Encoding");
    if (!chosen.coding.empty()) answer.headers.emplace_back("Content-Encoding", chosen.coding);
    if (is_listed(request_.if_none_match, etag)) {
      answer.status = 304;  // its Content-Length is that of the 200 (RFC 9110, section 8.6)
      return answer;
    }
    return cut(std::move(answer), etag);
  }

  /// Cuts out the bytes that a Range header names.
  FileAnswer cut(FileAnswer answer, const std::string& etag) const {
    const bool wants_range =
        request_.method == "GET" && (request_.if_range.empty() || request_.if_range == etag);
    const std::uint64_t bytes = answer.body.bytes();
    const auto range = parse_byte_range(wants_range ? request_.range : "", bytes);
    if (std::holds_alternative<NoSuchBytes>(range)) return no_such_bytes_answer(bytes);
    if (const auto* part = std::get_if<ByteRange>(&range)) {
      answer.status = 206;
      answer.body = answer.body.part(*part);
      answer.headers.emplace_back(
          "Content-Range",
          fmt::format("bytes {}-{}/{}", part->offset, part->offset + part->length - 1, bytes));
    }
    return answer;
  }

  const Site& site_;
  const FileRequest& request_;
  const FileRules& rules_;
  GzipCache& cache_;
  std::string path_;
};

}  // namespace

FileAnswer answer_file_request(const Site& site, const FileRequest& request, const FileRules& rules,
                               GzipCache& cache) {
  if (auto refusal = refuse_form(request)) return *std::move(refusal);
  if (request.method == "OPTIONS") return options_answer();
  if (request.method != "GET" && request.method != "HEAD") return method_answer();
  auto path = decode_url_path(request.target);
  if (!path) return text_answer(400, "the address is no path");
  return Answering(site, request, rules, cache, *std::move(path)).run();
}

}  // namespace terrane::viewer
