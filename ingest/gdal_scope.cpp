#include "ingest/gdal_scope.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>

#include <algorithm>
#include <mutex>

namespace terrane::ingest {
namespace {

// a row of 512 x 512 blocks over 60,000 columns of Int16
constexpr GIntBig kCacheBytes = 64 << 20;

void CPL_STDCALL keep_first_error(CPLErr severity, CPLErrorNum, const char* message) {
  auto* first_error = static_cast<std::string*>(CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure && first_error->empty()) *first_error = message;
}

std::recursive_mutex& gdal_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

void set_up_gdal() {
  GDALAllRegister();
  // GDAL's own bound is 5 % of the machine's memory; a user's GDAL_CACHEMAX wins
  if (CPLGetConfigOption("GDAL_CACHEMAX", nullptr) == nullptr) GDALSetCacheMax64(kCacheBytes);
}

}  // namespace

GdalScope::GdalScope() : lock_(gdal_mutex()) {
  static std::once_flag is_set_up;
  std::call_once(is_set_up, set_up_gdal);
  CPLPushErrorHandlerEx(keep_first_error, &first_error_);
}

GdalScope::~GdalScope() { CPLPopErrorHandler(); }

std::string GdalScope::reason() const {
  std::string line = first_error_;
  std::replace(line.begin(), line.end(), '\n', ' ');
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) line.pop_back();
  return line.empty() ? "GDAL gives no reason" : line;
}

}  // namespace terrane::ingest
