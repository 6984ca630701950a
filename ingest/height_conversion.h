#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ingest/dem.h"

namespace terrane::ingest {

/// From a stored number to a height.
struct HeightConversion {
  double scale = 1;
  double offset = 0;
  double metres_per_unit = 1;
  std::vector<double> nodata;  ///< stored values without a height

  /// (stored * scale + offset) * metres_per_unit, computed in double and rounded once.
  /// NaN for a nodata value, for NaN and for what is no finite float.
  float height_m(double stored) const;
};

/// Numbers of `--nodata`: one, or several with commas between them; empty for "none".
/// \throws ConfigError naming \p file if \p text is anything else.
std::vector<double> parse_nodata(const std::string& text, const std::string& file);

/// The stored value nearest to \p nodata that a Float32 band can hold: files often declare more
/// digits than their samples have, or a number just beyond the largest float.
double rounded_to_float(double nodata);

/// Values that usually mean "no data" and that \p conversion would read as heights.
std::vector<SuspectHeight> suspects_of(const HeightConversion& conversion);

}  // namespace terrane::ingest
