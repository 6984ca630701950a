#include "archive/archive.h"

#include <algorithm>
#include <cctype>

#include "archive/read_pmtiles.h"
#include "archive/read_zip.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"

namespace terrane::archive {

std::optional<std::string> Archive::read(std::string_view name) const {
  std::optional<Content> content = find(name);
  if (!content) return std::nullopt;
  if (auto* text = std::get_if<std::string>(&*content)) return std::move(*text);
  const auto& stored = std::get<StoredBytes>(*content);
  std::string bytes = file().read(stored.offset, stored.length);
  if (stored.coding == Coding::kNone) return bytes;
  auto plain = stored.coding == Coding::kGzip ? gunzip(bytes, stored.most_plain_bytes)
                                              : inflate_raw(bytes, stored.most_plain_bytes);
  if (!plain) file().fail(std::string(name) + " does not decompress");
  return plain;
}

bool is_archive_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".pmtiles" || extension == ".3tz";
}

std::unique_ptr<Archive> open_archive(const std::filesystem::path& path) {
  auto file = std::make_unique<const ArchiveFile>(path);
  const std::string begin = file->read(0, std::min<std::uint64_t>(file->bytes(), 7));
  if (begin == "PMTiles") return read_pmtiles(std::move(file));
  if (begin.starts_with("PK")) return read_zip(std::move(file));
  throw InputError(path.string() +
                   ": neither a PMTiles nor a 3tz archive. Pack a folder with 'terrane pack'");
}

bool is_safe_name(std::string_view name) {
  if (name.empty() || name.size() > 4096) return false;
  if (std::ranges::any_of(name,
                          [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; })) {
    return false;
  }
  while (true) {
    const std::size_t slash = name.find('/');
    const std::string_view part = name.substr(0, slash);
    if (part.empty() || part.front() == '.') return false;
    if (slash == std::string_view::npos) return true;
    name.remove_prefix(slash + 1);
  }
}

}  // namespace terrane::archive
