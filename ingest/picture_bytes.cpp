#include "ingest/picture_bytes.h"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <atomic>

#include "core/errors.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {

std::string picture_bytes(GDALDataset& picture, const char* driver,
                          const std::vector<const char*>& options) {
  const GdalScope gdal;
  static std::atomic<int> number = 0;  // of a file in memory; not in the bytes
  const std::string file = fmt::format("/vsimem/terrane_picture_{}", ++number);
  GDALDriver* const with = GetGDALDriverManager()->GetDriverByName(driver);
  if (with == nullptr) {
    throw InputError(
        fmt::format("GDAL was built without {}. Choose another format for pictures", driver));
  }
  std::vector<const char*> list = options;
  list.push_back(nullptr);
  GDALDatasetUniquePtr written(with->CreateCopy(file.c_str(), &picture, FALSE,
                                                const_cast<char**>(list.data()), nullptr, nullptr));
  if (written == nullptr) throw InputError("a picture cannot be encoded: " + gdal.reason());
  written.reset();
  vsi_l_offset size = 0;
  const GByte* bytes = VSIGetMemFileBuffer(file.c_str(), &size, FALSE);
  std::string result(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  VSIUnlink(file.c_str());
  VSIUnlink((file + ".aux.xml").c_str());
  return result;
}

}  // namespace terrane::ingest
