#pragma once

#include <optional>
#include <vector>

#include "tiler/gltf/glb_values.h"
#include "tiler/gltf/write_glb.h"

namespace terrane::tiler {

/// One primitive before it is stored: its vertices in the order of the vertex cache.
struct GlbArrays {
  GlbValues positions, morphs, normals;
  std::optional<GlbValues> places;   ///< TEXCOORD_0
  std::optional<GlbValues> colours;  ///< COLOR_0
  std::vector<std::uint32_t> indices;
};

/// The point that a tile's positions are counted from: the middle of its extent.
LatticePoint origin_of(const TileMesh& mesh);

/// The tile's own triangles.
/// \throws OutputError if a position or displacement does not fit 24 bits.
GlbArrays arrange_surface(const GlbTile& tile, const TileFormat& format);

/// The triangles of its skirt.
/// \pre there are some.
GlbArrays arrange_skirt(const GlbTile& tile, const TileFormat& format);

}  // namespace terrane::tiler
