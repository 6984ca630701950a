#include "ingest/gdal_scope.h"

#include <cpl_error.h>
#include <gdal.h>

#include <algorithm>
#include <mutex>

namespace terrane::ingest {
namespace {

void CPL_STDCALL keep_first_error(CPLErr severity, CPLErrorNum, const char* message) {
  auto* first_error = static_cast<std::string*>(CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure && first_error->empty()) *first_error = message;
}

}  // namespace

GdalScope::GdalScope() {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
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
