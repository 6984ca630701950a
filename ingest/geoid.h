#pragma once

#include <memory>
#include <string>

#include "core/georeference.h"

namespace terrane::ingest {

/// How high sea level lies over the WGS84 ellipsoid.
class Geoid {
 public:
  virtual ~Geoid() = default;

  /// Metres from the ellipsoid to the geoid; what has to be added to a height over sea level.
  ///
  /// Thread-safe; the same place gives the same bits at every call.
  virtual double undulation_m(LonLat place) const = 0;

  /// Where it is from, for messages and for whoever repeats the run.
  const std::string& name() const { return name_; }

 protected:
  explicit Geoid(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

/// Opens a geoid.
///
/// \param wanted  "egm96": PROJ's egm96_15.gtx, a post every 15'; a file that GDAL reads, in
///                longitudes and latitudes and around the whole Earth or over the DEM; or the name
///                of a geoid of GeographicLib that is installed, like egm2008-5.
/// \throws ConfigError if it is none of these, InputError if a file is not a grid in degrees.
std::unique_ptr<Geoid> open_geoid(const std::string& wanted);

}  // namespace terrane::ingest
