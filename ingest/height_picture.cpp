#include "ingest/height_picture.h"

#include <gdal_priv.h>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/picture_bytes.h"

namespace terrane::ingest {

std::string encode_lossless(std::span<const std::uint8_t> rgb, int side_px, bool is_webp) {
  const GdalScope gdal;
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const GDALDatasetUniquePtr picture(memory->Create("", side_px, side_px, 3, GDT_Byte, nullptr));
  constexpr GSpacing kPixel = 3;
  if (picture == nullptr ||
      picture->RasterIO(GF_Write, 0, 0, side_px, side_px, const_cast<std::uint8_t*>(rgb.data()),
                        side_px, side_px, GDT_Byte, 3, nullptr, kPixel, kPixel * side_px, 1,
                        nullptr) != CE_None) {
    throw InputError("a picture cannot be made: " + gdal.reason());
  }
  return is_webp ? picture_bytes(*picture, "WEBP", {"LOSSLESS=YES"})
                 : picture_bytes(*picture, "PNG", {"ZLEVEL=9"});
}

}  // namespace terrane::ingest
