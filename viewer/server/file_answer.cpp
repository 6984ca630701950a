#include "viewer/server/file_answer.h"

#include <fmt/format.h>

#include <string_view>

#include "viewer/server/gzip.h"
#include "viewer/server/media_type.h"

namespace terrane::viewer {
namespace {

// Larger JSON would take a second to compress, and all of it in memory.
constexpr std::uint64_t kLargestGzipBytes = 64 << 20;

FileAnswer text_answer(int status, const std::string& text) {
  FileAnswer answer{.status = status, .headers = {}, .body = text + "\n"};
  answer.headers = {{"Content-Type", "text/plain; charset=utf-8"},
                    {"Content-Length", std::to_string(text.size() + 1)},
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

FileAnswer no_such_bytes_answer(std::uint64_t bytes) {
  FileAnswer answer = text_answer(416, "the file has no such bytes");
  answer.headers.emplace_back("Content-Range", fmt::format("bytes */{}", bytes));
  return answer;
}

std::string etag_of(const OpenFile& file, bool is_gzip) {
  return fmt::format("\"{:x}-{:x}{}\"", file.modified_ns(), file.bytes(), is_gzip ? "-gz" : "");
}

// Weak comparison: a cache may have marked our tag W/ on its way.
bool is_listed(std::string_view tags, std::string_view etag) {
  return tags == "*" || tags.find(etag) != std::string_view::npos;
}

FileAnswer headers_of_file(const ServedFile& file, const MediaType& type, std::string etag) {
  FileAnswer answer;
  answer.headers = {
      {"Content-Type", std::string(type.name)},
      {"ETag", std::move(etag)},
      // ask again each time: a folder that was built anew shows at once
      {"Cache-Control", "no-cache"},
      {"Accept-Ranges", "bytes"},
      {"Access-Control-Allow-Origin", "*"},
      {"Access-Control-Expose-Headers", "Accept-Ranges, Content-Length, Content-Range, ETag"},
      {"X-Content-Type-Options", "nosniff"}};
  if (type.is_compressible) answer.headers.emplace_back("Vary", "Accept-Encoding");
  answer.body = FilePart{file.content, {0, file.content->bytes()}};
  return answer;
}

void add_whole(FileAnswer& answer) {
  const auto& part = std::get<FilePart>(answer.body);
  answer.headers.emplace_back("Content-Length", std::to_string(part.range.length));
}

void add_part(FileAnswer& answer, const ByteRange& range) {
  auto& part = std::get<FilePart>(answer.body);
  part.range = range;
  answer.status = 206;
  answer.headers.emplace_back("Content-Length", std::to_string(range.length));
  answer.headers.emplace_back(
      "Content-Range", fmt::format("bytes {}-{}/{}", range.offset, range.offset + range.length - 1,
                                   part.file->bytes()));
}

void add_gzip(FileAnswer& answer, const OpenFile& file) {
  std::string compressed = gzip(file.read(0, file.bytes()));
  answer.headers.emplace_back("Content-Length", std::to_string(compressed.size()));
  answer.headers.emplace_back("Content-Encoding", "gzip");
  answer.body = std::move(compressed);
}

FileAnswer answer_with_file(const ServedFile& file, const FileRequest& request) {
  const MediaType type = media_type_of(file.path);
  const OpenFile& content = *file.content;
  // a range counts bytes of the plain file
  const bool is_gzip = type.is_compressible && request.range.empty() && content.bytes() > 0 &&
                       content.bytes() <= kLargestGzipBytes &&
                       accepts_gzip(request.accept_encoding);
  const std::string etag = etag_of(content, is_gzip);
  FileAnswer answer = headers_of_file(file, type, etag);
  if (is_listed(request.if_none_match, etag)) {
    answer.status = 304;
    answer.body = std::string();
    return answer;
  }
  if (is_gzip) {
    add_gzip(answer, content);
    return answer;
  }

  const bool wants_range =
      request.method == "GET" && (request.if_range.empty() || request.if_range == etag);
  const auto range = parse_byte_range(wants_range ? request.range : "", content.bytes());
  if (std::holds_alternative<NoSuchBytes>(range)) return no_such_bytes_answer(content.bytes());
  if (const auto* part = std::get_if<ByteRange>(&range)) {
    add_part(answer, *part);
  } else {
    add_whole(answer);
  }
  return answer;
}

}  // namespace

FileAnswer answer_file_request(const std::filesystem::path& root, const FileRequest& request) {
  if (request.method == "OPTIONS") return options_answer();
  if (request.method != "GET" && request.method != "HEAD") return method_answer();
  const auto file = open_served_file(root, request.path);
  return file ? answer_with_file(*file, request) : text_answer(404, "not found");
}

}  // namespace terrane::viewer
