#pragma once

#include <mutex>
#include <string>

namespace terrane::ingest {

/// While one lives, its thread alone is inside GDAL, and GDAL prints nothing: what it has to say is
/// kept for an exception.
///
/// One lock for all files, as virtual rasters share the handles of their sources behind our back,
/// whichever thread they were opened on. Decoding takes 40 ns a sample, meshing a thousand times
/// that. Scopes may be nested. The first one registers GDAL's drivers and bounds its cache.
class GdalScope {
 public:
  GdalScope();
  ~GdalScope();
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  /// GDAL's first error since construction, in one line without its full stop; later
  /// ones mostly repeat it with less detail. "GDAL gives no reason" where there is none.
  std::string reason() const;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  std::string first_error_;
};

}  // namespace terrane::ingest
