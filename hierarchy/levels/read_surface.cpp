#include "hierarchy/levels/read_surface.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cctype>
#include <fstream>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

/// Takes what OpenMesh's readers find, without OpenMesh's meshes: those leave out faces that are
/// not manifold, and we have to say which.
class Collector final : public OpenMesh::IO::BaseImporter {
 public:
  SurfaceMesh mesh;

  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& p) override {
    return add_vertex(OpenMesh::Vec3d(p[0], p[1], p[2]));
  }
  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& p) override {
    mesh.points.push_back({p[0], p[1], p[2]});
    return OpenMesh::VertexHandle(static_cast<int>(mesh.points.size()) - 1);
  }
  OpenMesh::VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3d(0, 0, 0)); }
  void set_point(OpenMesh::VertexHandle v, const OpenMesh::Vec3f& p) override {
    mesh.points[static_cast<std::size_t>(v.idx())] = {p[0], p[1], p[2]};
  }
  void set_color(OpenMesh::VertexHandle v, const OpenMesh::Vec3uc& c) override {
    // vertices without a colour are white
    mesh.colours.resize(mesh.points.size(), {255, 255, 255});
    mesh.colours[static_cast<std::size_t>(v.idx())] = {c[0], c[1], c[2]};
  }
  void set_color(OpenMesh::VertexHandle v, const OpenMesh::Vec4uc& c) override {
    set_color(v, OpenMesh::Vec3uc(c[0], c[1], c[2]));
  }
  void set_color(OpenMesh::VertexHandle v, const OpenMesh::Vec3f& c) override {
    const auto byte = [](float x) {
      return static_cast<unsigned char>(std::clamp(x, 0.0F, 1.0F) * 255 + 0.5F);
    };
    set_color(v, OpenMesh::Vec3uc(byte(c[0]), byte(c[1]), byte(c[2])));
  }
  void set_color(OpenMesh::VertexHandle v, const OpenMesh::Vec4f& c) override {
    set_color(v, OpenMesh::Vec3f(c[0], c[1], c[2]));
  }
  OpenMesh::FaceHandle add_face(const VHandles& corners) override {
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(corners[0].idx()),
                                static_cast<std::uint32_t>(corners[k - 1].idx()),
                                static_cast<std::uint32_t>(corners[k].idx())});
    }
    return OpenMesh::FaceHandle(static_cast<int>(mesh.triangles.size()) - 1);
  }
  std::size_t n_vertices() const override { return mesh.points.size(); }
  std::size_t n_faces() const override { return mesh.triangles.size(); }
  std::size_t n_edges() const override { return 0; }

  // all that a mesh may have besides its shape
  OpenMesh::HalfedgeHandle add_edge(OpenMesh::VertexHandle, OpenMesh::VertexHandle) override {
    return OpenMesh::HalfedgeHandle();
  }
  OpenMesh::FaceHandle add_face(OpenMesh::HalfedgeHandle) override {
    return OpenMesh::FaceHandle();
  }
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                          const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle,
                          const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(OpenMesh::FaceHandle, int) override {}
  void set_halfedge(OpenMesh::VertexHandle, OpenMesh::HalfedgeHandle) override {}
  void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::VertexHandle, const OpenMesh::Vec3d&) override {}
  void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec2f&) override {}
  void set_status(OpenMesh::VertexHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(OpenMesh::HalfedgeHandle, OpenMesh::HalfedgeHandle) override {}
  void set_face(OpenMesh::HalfedgeHandle, OpenMesh::FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(OpenMesh::VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(OpenMesh::HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(OpenMesh::HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(OpenMesh::FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(OpenMesh::FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_status(OpenMesh::FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}
};

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

bool is_surface_file(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".obj" || extension == ".ply" || extension == ".off" || extension == ".stl";
}

SurfaceMesh read_surface(const std::filesystem::path& file) {
  if (!std::ifstream(file, std::ios::binary)) {
    throw InputError(
        fmt::format("{}: cannot be read. Check the name and its permissions", file.string()));
  }
  // OpenMesh prints what it dislikes; what matters comes as an exception
  omerr().disable();
  omlog().disable();
  Collector collector;
  OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexColor;
  const bool is_read = OpenMesh::IO::IOManager().read(file.string(), collector, options);
  if (!is_read) {
    throw InputError(fmt::format(
        "{}: is no mesh that can be read, or breaks off. Use an OBJ, PLY, OFF or STL file",
        file.string()));
  }
  if (collector.mesh.triangles.empty()) {
    throw InputError(
        fmt::format("{}: holds no face. Name a file with a triangle mesh", file.string()));
  }
  const auto count = static_cast<std::uint32_t>(collector.mesh.points.size());
  for (std::size_t t = 0; t < collector.mesh.triangles.size(); ++t) {
    const std::uint32_t largest = std::ranges::max(collector.mesh.triangles[t]);
    if (largest < count) continue;
    throw InputError(
        fmt::format("{}: triangle {} names vertex {}, but {} can be read. Complete the file",
                    file.string(), t, largest, count));
  }
  SurfaceMesh& mesh = collector.mesh;
  if (!mesh.colours.empty()) mesh.colours.resize(mesh.points.size(), {255, 255, 255});
  return std::move(mesh);
}

}  // namespace terrane::hierarchy
