#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "peer.h"

namespace terrane::peers {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

Mesh mesh_of(const Terrain& terrain) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> handles;
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
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    result.points.push_back({p.x() / terrain.column_m, p.y() / terrain.row_m, p.z()});
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    Triangle triangle{};
    int k = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) {
      triangle[k++] = static_cast<std::uint32_t>(v);
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

Answer collapse(const Terrain& terrain, std::size_t triangles) {
  Mesh mesh = mesh_of(terrain);
  const double begin_s = cpu_s();
  // three edges for two triangles
  const sms::Count_stop_predicate<Mesh> stop(triangles * 3 / 2);
  sms::edge_collapse(mesh, stop,
                     CGAL::parameters::get_cost(sms::LindstromTurk_cost<Mesh>())
                         .get_placement(sms::LindstromTurk_placement<Mesh>())
                         .filter(sms::Bounded_normal_change_filter<>()));
  mesh.collect_garbage();
  const double end_s = cpu_s();
  return {peer_mesh(mesh, terrain), end_s - begin_s};
}

}  // namespace

std::vector<Peer> cgal_peers() {
  return {
      {.name = "CGAL Lindstrom-Turk", .setting = "normal change bounded", .by_count = collapse}};
}

}  // namespace terrane::peers
