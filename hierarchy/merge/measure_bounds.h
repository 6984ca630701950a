#pragma once

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// Sets a tree's normals and bounds.
///
/// - normals: of the full mesh (surface_normals.h); of a vertex that is not in it, the mean of its
///   children's. Rounded to what a file holds.
/// - error: the largest of the samples (sample_lists.h) under the triangles that the merge makes.
/// - switched: how far the children are from their parent, or the largest such distance below
///   them, if that is more. It is the upswitch distance of the children; the largest of a vertex's
///   merges is its downswitch distance.
/// - radius, angle: of the sphere and the cone that hold all places, samples and normals of the
///   full mesh under the merge, and the triangles on either side of it with their normals.
/// - colour: the largest difference of two of these places in red, green or blue, as a share of
/// 255.
/// - all_...: the same over the merge and all that have to be made before it.
/// \par Source
/// Xia and Varshney 1996, section 4.2: subtree attribute ranges.
void measure_bounds(MergeTree& tree);

/// The smallest number of 16 bits (the upper half of a float) that is not below value.
/// \pre value is 0 or more and finite.
float rounded_up(double value);

}  // namespace terrane::hierarchy
