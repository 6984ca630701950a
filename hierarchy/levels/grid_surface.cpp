#include "hierarchy/levels/grid_surface.h"

#include "hierarchy/mesh/grid_triangles.h"

namespace terrane::hierarchy {

SurfaceMesh surface_of(const HeightGrid& grid, double column_spacing_m, double row_spacing_m) {
  GridTriangles full = triangulate(grid, grid.window);
  SurfaceMesh mesh{{}, std::move(full.triangles)};
  mesh.points.reserve(full.vertices.size());
  for (const SampleId& s : full.vertices) {
    mesh.points.push_back({s.column * column_spacing_m, -s.row * row_spacing_m,
                           static_cast<double>(grid.at(s.column, s.row))});
  }
  return mesh;
}

}  // namespace terrane::hierarchy
