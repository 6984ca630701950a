#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

namespace terrane::ingest {

/// A picture as the bytes of a file, through one of GDAL's drivers.
///
/// \param driver   GDAL's name: "PNG", "JPEG" or "WEBP".
/// \param options  of the driver, like "QUALITY=85".
/// \pre the caller holds a GdalScope.
/// \throws InputError if GDAL was built without the driver, or cannot encode it.
std::string picture_bytes(GDALDataset& picture, const char* driver,
                          const std::vector<const char*>& options);

}  // namespace terrane::ingest
