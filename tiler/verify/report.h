#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace terrane::verify {

/// The moments of a morph at which samples and triangles are judged: those that a builder is likely
/// to check, and others. The end, t = 1, is compared with the next level itself.
inline constexpr std::array<double, 12> kMorphTimes = {0.03, 0.1, 0.2, 0.25, 0.3, 0.4,
                                                       0.5,  0.6, 0.7, 0.75, 0.9, 0.97};

/// A level half-way into the next one: every vertex at POSITION + t * _MORPH.
struct MorphReport {
  double t = 0;
  double max_error_m = 0;
  std::int64_t samples_over_tolerance = 0;  ///< over the tolerance of the *next* level
  std::int64_t uncovered_samples = 0;
  std::int64_t folded_triangles = 0;

  bool holds() const;
};

/// What was measured on one level. Everything that is not a size or an error has to be zero.
struct LevelReport {
  int level = 0;
  double tolerance_m = 0;  ///< as terrane.json states it
  std::int64_t tiles = 0;
  std::int64_t triangles = 0;
  std::int64_t bytes = 0;

  /// Errors at the samples: |mesh - DEM| along the vertical (the ellipsoid's normal).
  double max_error_m = 0;
  double rms_error_m = 0;
  std::int64_t samples = 0;  ///< samples of the terrain, each counted once
  std::int64_t uncovered_samples = 0;
  std::int64_t samples_over_tolerance = 0;
  std::int64_t folded_triangles = 0;  ///< not seen from above, or without area

  /// Cracks. A vertex agrees if its place *and* its displacement are the same integers.
  std::int64_t seam_vertices = 0;  ///< compared between tiles of this level
  std::int64_t mismatched_same_level = 0;
  std::int64_t mismatched_across_levels = 0;  ///< at t = 1, against the next level's borders
  std::int64_t torn_edges = 0;  ///< inside a tile: two sides that part, or are there twice

  /// This level at t = 1 against the next level, as sets of triangles of integers.
  std::int64_t parent_triangles_missing = 0;
  std::int64_t parent_triangles_extra = 0;
  std::int64_t root_morphs = 0;  ///< vertices of the root with a displacement
  bool has_morph() const { return !morph.empty(); }
  std::vector<MorphReport> morph;  ///< one for each of kMorphTimes; empty for the root

  /// Water, against the polygons that it was built from.
  std::int64_t water_triangles = 0;
  std::int64_t uneven_water_triangles = 0;  ///< not at the height of a lake there
  /// Farther from any shore than the tolerance; on borders of leaf tiles once for each.
  std::int64_t samples_on_wrong_side = 0;

  /// Tiles whose box lacks some of their vertices (t = 0 or 1), and children that stick out of it.
  std::int64_t boxes_violated = 0;
  std::int64_t nested_errors_violated = 0;  ///< tiles that state a smaller error than a child's
  std::int64_t stated_error_too_small = 0;  ///< tiles that state less than was measured
  std::int64_t tiles_missing = 0;           ///< the DEM has triangles there, the output no tile
  std::int64_t tiles_unexpected = 0;        ///< no triangle in the DEM, or not in tileset.json
  std::int64_t facts_misstated = 0;         ///< other statements in the files that are not true

  bool holds() const;
};

/// The verdict on one output.
struct VerifyReport {
  std::vector<LevelReport> levels;    ///< level 0, the finest, first
  std::vector<std::string> problems;  ///< one line each: which tile, what, where; not all if many
  std::int64_t problems_left_out = 0;
  std::int64_t samples_under_water = 0;  ///< that are clearly in water; see water_samples.h
  std::int64_t water_samples_wrong = 0;  ///< that the reference has not at their height

  /// True if every invariant holds on every level.
  bool holds() const;
};

/// What all reports end with: the problems, a line each, and whether the invariants hold.
std::string verdict_text(const std::vector<std::string>& problems, std::int64_t left_out,
                         bool holds);

/// Tables for a terminal, the problems below them. Ends with a newline.
std::string to_text(const VerifyReport& report);

/// The whole report as a JSON object, with the key "holds".
std::string to_json(const VerifyReport& report);

}  // namespace terrane::verify
