#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/progress.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::cli {

/// A mesh file or a DEM, and what a command line says about it.
struct SurfaceInput {
  std::string input;
  std::optional<int> band;
  std::optional<std::string> nodata, vertical_unit, crs;
};

/// Adds the options that describe a DEM.
void add_surface_options(CLI::App& command, SurfaceInput& input);

/// Reads the mesh, or makes the full mesh of the DEM, and checks it.
/// \throws InputError, ConfigError or TopologyError if it cannot be used.
hierarchy::SurfaceMesh read_input(const SurfaceInput& input, Progress& progress);

}  // namespace terrane::cli
