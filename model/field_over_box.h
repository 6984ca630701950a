#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/progress.h"
#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::model {

/// The posts of an axis that a range needs: [first, first + count).
struct PostRange {
  std::size_t first = 0, count = 0;
};

/// Posts from the last one at or before the range to the first one at or behind it. At least two.
/// \pre axis rises, and has two posts or more.
PostRange posts_around(const std::vector<double>& axis, double low, double high);

/// Refuses an axis that does not rise, and a grid that lies beside the box.
///
/// A field is level beyond its ends: where those lie more than a cell inside the box, in plan or in
/// height, progress.note() says so.
///
/// \param name  of field and file, for messages.
/// \throws InputError naming the axis.
void check_reach(const std::string& name, const std::array<std::vector<double>, 3>& axes,
                 const hierarchy::volume::Box& box, Progress& progress);

}  // namespace terrane::model
