#pragma once

#include <gdal_priv.h>

#include "core/height_source.h"

namespace terrane::ingest {

/// Heights as a raster of GDAL's: one band of floats, NaN for no data, without a place.
class HeightDataset final : public GDALDataset {
 public:
  /// \param heights     must outlive the data set.
  /// \param goes_round  the grid goes once round the Earth: kMargin columns of the other end are
  ///                    added on each side.
  HeightDataset(const HeightSource& heights, bool goes_round);

  static constexpr int kMargin = 4;

  /// Columns of the raster before the first of the heights.
  int first_column() const { return goes_round_ ? kMargin : 0; }

 private:
  class Band;

  bool goes_round_;
};

}  // namespace terrane::ingest
