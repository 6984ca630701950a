#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/star.h"

namespace terrane::hierarchy {

/// The heights of a star's centre that keep it near the samples, in metres over Star::origin().
struct StarHeights {
  float lowest = 0;  ///< the feasible interval; infinite where no sample decides
  float highest = 0;
  float best = 0;           ///< least squares, moved into the interval
  float squared_error = 0;  ///< sum over the samples at best, in square metres
};

enum class StarVerdict : std::uint8_t {
  kFeasible,
  kNotStarShaped,  ///< the polygon does not see the centre, or a triangle would be too thin
  kOverTolerance,  ///< no height keeps the bound
};

/// Judges the stars that may replace a stencil. Keeps its scratch space from call to call.
class StarJudge {
 public:
  StarJudge();
  /// \param is_wide  whether to use has_wide_lanes() (lanes.h); the results are the same.
  explicit StarJudge(bool is_wide) : is_wide_(is_wide) {}

  /// Finds the heights of a centre for which the star stays within the tolerance of every sample
  /// under it: in single precision and eight samples at once, so holds() has the last word.
  ///
  /// \param smallest_altitude_cells  of any triangle of the star, in plan.
  /// \param[out] heights             written if feasible.
  /// \param number  of the centre among those tried since begin(): the next time with the same
  ///                number it is the same centre, and samples alone have been added to the star.
  StarVerdict fit(const Star& star, Star::Centre centre, float tolerance_m,
                  float smallest_altitude_cells, StarHeights& heights, std::size_t number = 0);

  /// Is the star around a written place within the tolerance of every sample under it? In double
  /// precision.
  /// \pre the polygon sees the place.
  bool holds(const Star& star, const Place& centre, double tolerance_m);

  /// Tells that another star comes, or other centres.
  void begin() {
    contrary_.count = 0;
    ++star_number_;
  }

  /// For each sample of the star the sector that it is in, around the place that last held.
  std::span<const std::uint32_t> sectors(const Star& star) const {
    return std::span(sectors_).first(star.sample_count());
  }

  /// A sector around a written place.
  struct ExactSector {
    double from_x, from_y, to_x, to_y;  // of the corners, from the centre in grid units
    double scale;                       // 1 / twice the area
    double from_m, to_m;                // heights of the corners
  };

 private:
  /// The eights of samples that left no height to the last centre which had none. They are asked
  /// first about the next centre, as most have the same two to refuse them.
  struct Contrary {
    std::size_t count = 0;
    std::array<std::size_t, 2> first{};  // samples that the eights begin with
  };

  struct Fit;
  struct Guess;

  /// The sectors around a centre.
  struct Known {
    std::uint64_t star_number = 0;
    std::vector<float> memory;  // see Sectors in the source
  };

  bool is_wide_;
  std::uint64_t star_number_ = 1;
  Contrary contrary_;
  std::vector<Known> known_;
  Known guess_;
  std::vector<float> bounds_memory_;  // see Bounds in the source
  std::vector<ExactSector> exact_sectors_;
  std::vector<std::uint32_t> sectors_;
};

}  // namespace terrane::hierarchy
