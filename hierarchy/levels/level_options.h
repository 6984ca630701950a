#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <variant>

namespace terrane::hierarchy {

/// Shares of the terms of a triangle's weight, each in [0, 1].
///
/// W(T) = area (curvature kappa + angle alpha + valence V + error E)
/// \par Source
/// Gieng et al. 1998, section 6; the two presets are those of section 7.
struct Weights {
  double curvature = 1. / 3;
  double angle = 1. / 3;
  double valence = 1. / 3;
  double error = 0;
};
inline constexpr Weights kStHelensWeights{};  ///< also of the saddle
inline constexpr Weights kCraterLakeWeights{1. / 8, 1. / 8, 3. / 8, 3. / 8};  ///< also of the torus

/// Which rules a collapse keeps.
enum class Rules : std::uint8_t {
  /// The published ones and more: borders keep their place (in plan where the mesh is a height
  /// field, else their corners), and a height field folds nowhere in plan.
  kTightened,
  kPublished,
};

/// Why a triangle did not collapse at a level.
enum class Rejection : std::uint8_t {
  kOverlap,        ///< its stencil meets that of one already taken
  kCyclic,         ///< the stencil is not complete
  kValence,        ///< a vertex would be left with valence 3: a new cycle
  kBoundary,       ///< type 4, or the border would leave its place
  kNotStarShaped,  ///< the boundary polygon does not see the collapse point
  kFolded,         ///< the same, in plan (height fields)
  kFlat,           ///< the triangle has no area, and so no plane
};
inline constexpr int kRejectionCount = 7;
inline constexpr std::array<std::string_view, kRejectionCount> kRejectionNames{
    "overlap", "cyclic", "valence", "boundary", "not_star_shaped", "folded_in_plan", "no_area"};

/// How one level came about.
struct LevelStatistics {
  std::uint32_t level = 0;      ///< of the mesh that came out; 1 for the first collapses
  std::uint32_t triangles = 0;  ///< left
  std::uint32_t collapses = 0;  ///< from the mesh before
  std::array<std::uint32_t, kRejectionCount> rejected{};  ///< triangles looked at in vain
};

struct LevelOptions {
  Weights weights;
  /// Share of a level's triangles that collapse to make the next one, in (0, 1]. Each collapse
  /// removes four. 0.03 is what the paper's Table 1 follows; its text says 0.025.
  double share = 0.03;
  Rules rules = Rules::kTightened;
  std::uint32_t most_levels = 30;      ///< ends with M_n, n = this
  std::uint32_t fewest_triangles = 0;  ///< ends with the first level of at most so many
  int jobs = 0;                        ///< threads; 0: one per core. Changes nothing but the time
  /// Called after each level; false ends the sequence before this level.
  std::function<bool(const LevelStatistics&)> keep;
};

}  // namespace terrane::hierarchy
