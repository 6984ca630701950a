#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/grid_features.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "ingest/vertical_unit.h"

namespace terrane::ingest {

class Geoid;

/// What a user says about a DEM; each wins over what its files say.
struct OpenOptions {
  /// Band that holds the heights, from 1. Needed only for files with several.
  std::optional<int> band;

  /// Value that means "no data", as stored (before scale, offset and unit): a number, several with
  /// commas between them, or "none": read every value as a height, masks too. NaN and infinities
  /// are never heights.
  std::optional<std::string> nodata;

  std::optional<VerticalUnit> vertical_unit;

  /// CRS of the plan in any form that GDAL takes ("EPSG:4326", WKT, a PROJ string, a file name);
  /// empty: as in the file.
  std::string crs;
};

/// What DemDescription::vertical_crs says of heights over the WGS 84 ellipsoid.
inline constexpr const char* kEllipsoidalHeight = "ellipsoid";

/// What a DEM is made of, to show to its user.
struct DemDescription {
  std::vector<std::string> files;  ///< as given to open_dem()
  std::string format;              ///< GDAL's name of it, or "synthetic"
  int band = 1;                    ///< the one with the heights, from 1
  int band_count = 1;
  std::string data_type;  ///< as stored: "Int16", "Float32", ...
  double scale = 1;       ///< height in the file's unit = stored * scale + offset
  double offset = 0;
  VerticalUnit vertical_unit = VerticalUnit::kMetre;
  std::string vertical_unit_origin;  ///< who said so: "--vertical-unit", "the band", ...
  std::vector<double> nodata;        ///< stored values read as "no data"
  std::string nodata_origin;         ///< "--nodata", "the band", "a mask", or empty: there is none
  double column_spacing = 1;         ///< distance of two samples of a row, in units of the CRS
  double row_spacing = 1;            ///< distance of two samples of a column, in units of the CRS
  std::string crs_name;              ///< empty without a CRS
  std::string crs_unit = "metre";    ///< of the two spacings
  std::string vertical_crs;          ///< name of the CRS of heights; empty: the file does not say
  std::string datum_shift;           ///< operation that leads to WGS84; empty without a CRS
  std::int64_t block_columns = 1;    ///< samples that the file stores together
  std::int64_t block_rows = 1;
};

/// A height that a value gets which usually means "no data" but is not declared as such.
struct SuspectHeight {
  std::string stored;                  ///< the value in the file, as `--nodata` takes it
  float height_m = 0;                  ///< what it is read as
  bool and_everything_beyond = false;  ///< larger magnitudes of the same sign are suspect too
};

/// A digital elevation model that is open for reading: heights in metres on a georeferenced grid.
///
/// Thread-safe as far as its two parts are: any number of threads may read.
class Dem {
 public:
  Dem(std::string name, DemDescription description, std::vector<SuspectHeight> suspects,
      std::unique_ptr<HeightSource> heights, std::unique_ptr<Georeference> place);

  const HeightSource& heights() const { return *heights_; }

  /// Puts every sample of some water at its height from now on: see water_level.h.
  void level_water(const WaterRows& water);

  /// Gives heights over the ellipsoid from now on: see raise_heights.h.
  /// \pre the DEM has a CRS.
  void raise(std::unique_ptr<Geoid> geoid);

  /// What heights were raised by, on average over some places; 0 if they were not.
  double raised_m(std::span<const GridPosition> places) const;

  const Georeference& place() const { return *place_; }

  /// File name without its folders, or "a.tif and 1 more".
  const std::string& name() const { return name_; }

  const DemDescription& description() const { return description_; }

  /// What scan_heights() must not meet. Empty after `--nodata none`.
  const std::vector<SuspectHeight>& suspects() const { return suspects_; }

 private:
  std::string name_;
  DemDescription description_;
  std::vector<SuspectHeight> suspects_;
  std::unique_ptr<HeightSource> heights_;
  std::unique_ptr<Georeference> place_;
  const Geoid* raised_by_ = nullptr;  // the heights own it
};

/// Opens one raster, several that make up one grid, or "synthetic:..." (see synthetic.h).
///
/// Heights are read window by window and never resampled. Several files must have the same CRS,
/// number of bands and cells, and lie whole cells apart; where they overlap, a later one's height
/// hides an earlier one's. Between them there is no data.
///
/// Unit of heights: options, else the band's, else that of the CRS's vertical axis, else metre.
/// Decisions made for the user (no CRS, no geotransform) go to progress.note().
///
/// \param sources  at least one: paths, or anything else that GDAL opens.
/// \throws InputError if a file cannot be opened, is no DEM, or does not fit the others; if the
///         CRS is not known; if a band has to be named.
/// \throws ConfigError if options.nodata is not what it may be.
std::unique_ptr<Dem> open_dem(const std::vector<std::string>& sources, const OpenOptions& options,
                              Progress& progress);

}  // namespace terrane::ingest
