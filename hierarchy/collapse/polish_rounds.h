#pragma once

namespace terrane::hierarchy {

/// How often vertices are moved and collapses tried again once a mesh is collapsed.
struct PolishRounds {
  int everywhere = 0;
  int near_locked = 0;  ///< after those everywhere: around locked vertices, as on seams, alone

  bool operator==(const PolishRounds&) const = default;
};

/// \param effort  StrictOptions::effort.
/// \param is_above_level_0  does it have a finer level that blends into it?
/// \param samples_per_triangle  of the mesh as the collapse left it. The fewer triangles there are
///        for the samples, the more seams and blends cost of them. With the default effort there is
///        no polish above level 0 where they are many, and one round where they are so few that it
///        costs all samples for little.
PolishRounds polish_rounds(int effort, bool is_above_level_0, double samples_per_triangle);

}  // namespace terrane::hierarchy
