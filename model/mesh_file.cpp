#include "model/mesh_file.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/vector_cast.hh>

#include "core/errors.h"

namespace terrane::model {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

}  // namespace

hierarchy::volume::SurfaceMesh read_mesh(const std::filesystem::path& file) {
  // OpenMesh reports on its own; what went wrong is said in our words
  omerr().disable();
  omlog().disable();
  Mesh source;
  OpenMesh::IO::Options options;
  if (!OpenMesh::IO::read_mesh(source, file.string(), options) || source.n_faces() == 0) {
    throw InputError(
        fmt::format("{}: is no triangle mesh that can be read. Give an OBJ, PLY, OFF "
                    "or STL file",
                    file.string()));
  }
  hierarchy::volume::SurfaceMesh mesh;
  for (const auto v : source.vertices()) {
    const Mesh::Point p = source.point(v);
    mesh.points.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto f : source.faces()) {
    std::vector<std::uint32_t> corners;
    for (const auto v : f.vertices()) corners.push_back(static_cast<std::uint32_t>(v.idx()));
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
    }
  }
  return mesh;
}

}  // namespace terrane::model
