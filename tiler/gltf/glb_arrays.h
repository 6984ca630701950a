#pragma once

#include <optional>
#include <vector>

#include "tiler/gltf/glb_values.h"
#include "tiler/gltf/write_glb.h"

namespace terrane::tiler {

/// Triangles before they are stored, and their vertices in the order of the vertex cache.
struct GlbArrays {
  GlbValues positions, morphs, normals;
  std::optional<GlbValues> places;         ///< TEXCOORD_0
  std::optional<GlbValues> colours;        ///< COLOR_0
  std::vector<std::uint32_t> land, water;  ///< corners of the triangles there
  /// Upright at every vertex: what is water is level, but on its shore `normals` are the land's.
  GlbValues upright;

  std::size_t vertices() const { return positions.count; }
};

/// Some of the triangles of a tile.
enum class Cover { kAll, kLand, kWater };

/// The point that a tile's positions are counted from: the middle of its extent.
LatticePoint origin_of(const TileMesh& mesh);

/// The tile's own triangles; without vertices if there are none of that kind.
/// \throws OutputError if a position or displacement does not fit 24 bits.
GlbArrays arrange_surface(const GlbTile& tile, const TileFormat& format, Cover cover = Cover::kAll);

/// The triangles of its skirt.
GlbArrays arrange_skirt(const GlbTile& tile, const TileFormat& format, Cover cover = Cover::kAll);

}  // namespace terrane::tiler
