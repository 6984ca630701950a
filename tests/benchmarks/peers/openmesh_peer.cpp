#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "peer.h"

namespace terrane::peers {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Mesh mesh_of(const Terrain& terrain) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> handles;
  for (const auto& [column, row, height_m] : terrain.full.points) {
    handles.push_back(mesh.add_vertex({column * terrain.column_m, row * terrain.row_m, height_m}));
  }
  for (const auto& [a, b, c] : terrain.full.triangles) {
    mesh.add_face(handles[a], handles[b], handles[c]);
  }
  return mesh;
}

PeerMesh peer_mesh(const Mesh& mesh, const Terrain& terrain) {
  PeerMesh result;
  for (const Mesh::VertexHandle v : mesh.vertices()) {
    const OpenMesh::Vec3d& p = mesh.point(v);
    result.points.push_back({p[0] / terrain.column_m, p[1] / terrain.row_m, p[2]});
  }
  for (const Mesh::FaceHandle f : mesh.faces()) {
    Triangle triangle{};
    int k = 0;
    for (const Mesh::VertexHandle v : mesh.fv_range(f)) {
      triangle[k++] = static_cast<std::uint32_t>(v.idx());
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

Answer decimate(const Terrain& terrain, std::size_t triangles, bool lock_border) {
  Mesh mesh = mesh_of(terrain);
  const double begin_s = cpu_s();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  for (const Mesh::VertexHandle v : mesh.vertices()) {
    if (lock_border && mesh.is_boundary(v)) mesh.status(v).set_locked(true);
  }
  decimater.decimate_to_faces(0, triangles);
  mesh.garbage_collection();
  const double end_s = cpu_s();
  return {peer_mesh(mesh, terrain), end_s - begin_s};
}

}  // namespace

std::vector<Peer> openmesh_peers() {
  std::vector<Peer> peers;
  for (const bool lock_border : {false, true}) {
    peers.push_back({.name = "OpenMesh quadric",
                     .setting = lock_border ? "border locked" : "border free",
                     .by_count = [=](const Terrain& terrain, std::size_t triangles) {
                       return decimate(terrain, triangles, lock_border);
                     }});
  }
  return peers;
}

}  // namespace terrane::peers
