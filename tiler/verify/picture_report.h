#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace terrane::verify {

/// What can be wrong with heights as pictures. Each has a column of its own in the report.
enum class PictureFault {
  kMissing,     ///< the bounds reach it, but there is no such file
  kUnexpected,  ///< there, but beside the bounds
  kUnreadable,  ///< no whole picture of the stated size
  kOffDem,      ///< pixels of the finest zoom lower or higher than all samples around them
  kMeans,       ///< pixels of a coarser zoom that are no mean of those below
  kMisstated    ///< counts and sizes in terrane.json and tiles.json
};
inline constexpr std::size_t kPictureFaults = 6;

struct PictureZoomReport {
  int zoom = 0;
  std::int64_t tiles = 0, bytes = 0;
  /// Pixels of the finest zoom whose middle lies in a cell of the DEM with four heights, each
  /// against the bilinear one there. Told, not judged: a picture has no tolerance, and where pixels
  /// are larger than cells they are means.
  std::int64_t pixels = 0;
  double max_difference_m = 0, rms_difference_m = 0;

  std::array<std::int64_t, kPictureFaults> faults{};
  bool holds() const;
};

/// The verdict on heights as pictures.
struct PictureReport {
  std::vector<PictureZoomReport> zooms;  ///< from 0
  std::vector<std::string> problems;     ///< one line each; not all if many
  std::int64_t problems_left_out = 0;

  bool holds() const;
};

/// A table for a terminal, the problems below it. Ends with a newline.
std::string to_text(const PictureReport& report);

/// The whole report as a JSON object, with the key "holds".
std::string to_json(const PictureReport& report);

}  // namespace terrane::verify
