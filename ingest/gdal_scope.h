#pragma once

#include <string>

namespace terrane::ingest {

/// While one lives, GDAL prints nothing on this thread; what it has to say is kept for an exception.
///
/// Also registers GDAL's drivers, once.
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
  std::string first_error_;
};

}  // namespace terrane::ingest
