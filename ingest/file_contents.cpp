#include "ingest/file_contents.h"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "core/errors.h"
#include "ingest/fingerprint.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {
namespace {

std::uint64_t hash_of_file(const std::string& file, const GdalScope& gdal) {
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> stream(VSIFOpenL(file.c_str(), "rb"),
                                                             VSIFCloseL);
  if (stream == nullptr) {
    throw InputError(
        fmt::format("{}: cannot be opened ({}). Check that it may be read", file, gdal.reason()));
  }
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // whole words
  std::string piece(kPiece, '\0');
  Fingerprint fingerprint;
  std::size_t count = kPiece;
  while (count == kPiece) {
    count = VSIFReadL(piece.data(), 1, kPiece, stream.get());
    fingerprint.add_packed(std::string_view(piece).substr(0, count));
  }
  return fingerprint.value();
}

}  // namespace

std::string hash_of_files(const std::vector<std::string>& files) {
  const GdalScope gdal;
  std::vector<std::uint64_t> hashes;
  for (const std::string& file : files) hashes.push_back(hash_of_file(file, gdal));
  std::ranges::sort(hashes);
  Fingerprint all;
  for (const std::uint64_t hash : hashes) all.add(hash);
  return all.hex();
}

}  // namespace terrane::ingest
