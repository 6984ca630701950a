#pragma once

#include <limits>
#include <vector>

#include "core/height_source.h"
#include "core/loose_samples.h"
#include "hierarchy/collapse/strict_collapse.h"
#include "tiler/pyramid.h"
#include "tiler/seams/seam.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/tile_features.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {

/// What every tile of a data set is built from.
struct TileSource {
  const HeightSource& heights;
  const WorldFrame& world;
  const Pyramid& pyramid;
  const Lattice& lattice;
  /// See hierarchy::StrictOptions::effort.
  int effort = hierarchy::kDefaultEffort;
  /// Lines and water that tiles keep, if any.
  const TileFeatures* features = nullptr;
  const LooseSamples* loose = nullptr;  ///< between the samples of heights; null: none
  /// Most metres that a triangle may rise over one metre: see steepest() in tile/lattice.h.
  double steepest = std::numeric_limits<double>::infinity();
};

/// What lines do in a leaf tile and on its border.
std::span<const FeatureLine> lines_of(const TileSource& source, const TileId& leaf);

/// The water between samples, if a data set has some.
hierarchy::WaterHeight water_of(const TileSource& source);

/// A tile and where the vertices of its children end in it.
struct BuiltTile {
  TileMesh mesh;
  /// For each child, for each of its vertices: the place at t = 1, in steps of the *child's* level.
  std::vector<std::vector<LatticePoint>> child_targets;
};

/// Builds a leaf tile from its samples.
/// \param seams  what became of its seams.
/// \throws ConfigError if the tolerance is finer than what the lattice can hold.
BuiltTile build_leaf(const TileSource& source, const TileId& tile,
                     const std::vector<SeamChain>& seams, double tolerance_m);

/// Builds a tile from the meshes of its children (in the order of Pyramid::children): joins them
/// along their borders and collapses what the wider tolerance allows.
///
/// The result is within the tolerance of every sample as measured in the world; its seams are the
/// children's outer ones, less what \p seams leave out.
BuiltTile build_parent(const TileSource& source, const TileId& tile,
                       const std::vector<TileMesh>& children, const std::vector<SeamChain>& seams,
                       double tolerance_m);

}  // namespace terrane::tiler
