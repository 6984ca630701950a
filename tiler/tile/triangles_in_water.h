#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hierarchy/mesh/lined_triangles.h"
#include "tiler/tile/water_areas.h"

namespace terrane::tiler {

/// Tells which triangles of a full-resolution mesh lie in water.
///
/// A triangle with a corner off every line is where that sample is; of the others the middle
/// decides, as no triangle lies on both sides of a shore.
///
/// \param places    of the vertices, on the grid of the DEM.
/// \param lines     those in the window and on its border, shores among them.
/// \param is_water  whether a sample lies in water; what it says on a shore does not count.
/// \return 1 or 0 for each triangle; empty if none is in water.
std::vector<std::uint8_t> triangles_in_water(
    const hierarchy::LinedTriangles& full, std::span<const hierarchy::BorderPlace> places,
    std::span<const FeatureLine> lines,
    const std::function<bool(const hierarchy::SampleId&)>& is_water, const WaterAreas& areas);

}  // namespace terrane::tiler
