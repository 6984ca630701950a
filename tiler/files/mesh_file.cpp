#include "tiler/files/mesh_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <iterator>
#include <sstream>
#include <vector>

#include "core/errors.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {
namespace {

using hierarchy::Corners;
using hierarchy::TerrainMesh;

static_assert(std::endian::native == std::endian::little, "PLY and glTF are written as they lie");

/// x, y (in the plane of a CRS, or local metres) of a grid position.
struct AffineMap {
  PlanPosition origin, per_column, per_row;

  PlanPosition at(double column, double row) const {
    return {origin.x + per_column.x * column + per_row.x * row,
            origin.y + per_column.y * column + per_row.y * row};
  }
  /// Does the grid, its rows downward, run clockwise in the plane?
  bool is_mirrored() const { return per_column.x * per_row.y - per_column.y * per_row.x > 0; }
};

bool runs_clockwise(const Georeference& place) {
  const PlanPosition o = place.to_plan({0, 0}), c = place.to_plan({1, 0}),
                     r = place.to_plan({0, 1});
  return AffineMap{o, {c.x - o.x, c.y - o.y}, {r.x - o.x, r.y - o.y}}.is_mirrored();
}

PlanPosition in_crs(const hierarchy::Place& at, const Georeference& place) {
  return place.to_plan({column_of(at.plan), row_of(at.plan)});
}

std::vector<Corners> turned_up(const TerrainMesh& mesh, bool is_mirrored) {
  std::vector<Corners> triangles = mesh.triangles;
  if (!is_mirrored) return triangles;
  for (Corners& corners : triangles) std::swap(corners[1], corners[2]);
  return triangles;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string encode_obj(const TerrainMesh& mesh, const Georeference& place) {
  std::string text = "# terrane: x, y in the DEM's CRS, z in metres\n";
  if (!place.crs_wkt().empty()) text += fmt::format("# CRS: {}\n", place.crs_wkt());
  auto end = std::back_inserter(text);
  for (const hierarchy::TerrainVertex& vertex : mesh.vertices) {
    const PlanPosition plan = in_crs(vertex.place, place);
    fmt::format_to(end, "v {} {} {}\n", plan.x, plan.y, vertex.place.height_m);
  }
  for (const auto& [a, b, c] : turned_up(mesh, runs_clockwise(place))) {
    fmt::format_to(end, "f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  for (const auto& [a, b] : mesh.lines) fmt::format_to(end, "l {} {}\n", a + 1, b + 1);
  return text;
}

std::string encode_ply(const TerrainMesh& mesh, const Georeference& place) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment terrane: x, y in the DEM's "
      "CRS, z in metres\n";
  if (!place.crs_wkt().empty()) bytes += fmt::format("comment CRS: {}\n", place.crs_wkt());
  bytes += fmt::format(
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\n",
      mesh.vertices.size(), mesh.triangles.size());
  if (!mesh.lines.empty()) {
    bytes += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n",
                         mesh.lines.size());
  }
  bytes += "end_header\n";
  for (const hierarchy::TerrainVertex& vertex : mesh.vertices) {
    const PlanPosition plan = in_crs(vertex.place, place);
    append(bytes, std::array{plan.x, plan.y, vertex.place.height_m});
  }
  for (const Corners& corners : turned_up(mesh, runs_clockwise(place))) {
    append(bytes, std::uint8_t{3});
    append(bytes, corners);
  }
  for (const hierarchy::LineEdge& edge : mesh.lines) append(bytes, edge);
  return bytes;
}

/// East and north metres from the DEM's centre, in the plane that touches its map there.
AffineMap tangent_map(const WorldFrame& world, GridShape shape) {
  const double column = static_cast<double>(shape.columns - 1) / 2;
  const double row = static_cast<double>(shape.rows - 1) / 2;
  constexpr double kHalf = 0.5;
  const std::vector<GridPosition> around{
      {column - kHalf, row}, {column + kHalf, row}, {column, row - kHalf}, {column, row + kHalf}};
  const std::vector<Plumb> at = world.plumbs(around);
  const Eigen::Vector3d c = at[1].base - at[0].base, r = at[3].base - at[2].base;
  return {{-c.x() * column - r.x() * row, -c.y() * column - r.y() * row},
          {c.x(), c.y()},
          {r.x(), r.y()}};
}

tinygltf::Value origin_of(const WorldFrame& world) {
  tinygltf::Value::Object origin;
  if (world.is_local()) {
    origin["x"] = tinygltf::Value(world.local_origin().x);
    origin["y"] = tinygltf::Value(world.local_origin().y);
  } else {
    origin["longitude_deg"] = tinygltf::Value(world.origin().longitude_deg);
    origin["latitude_deg"] = tinygltf::Value(world.origin().latitude_deg);
  }
  tinygltf::Value::Object own, extras;
  own["origin"] = tinygltf::Value(origin);
  extras["terrane"] = tinygltf::Value(own);
  return tinygltf::Value(extras);
}

/// Appends values as a buffer view with its accessor, and returns the accessor's number.
template <class T>
int add_accessor(tinygltf::Model& model, const std::vector<T>& values, int target, int component,
                 int type, std::size_t count) {
  std::vector<unsigned char>& bytes = model.buffers.front().data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = values.size() * sizeof(T);
  view.target = target;
  bytes.resize(bytes.size() + view.byteLength);
  std::memcpy(bytes.data() + view.byteOffset, values.data(), view.byteLength);
  model.bufferViews.push_back(view);

  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

using Float3 = std::array<float, 3>;

std::vector<Float3> local_positions(const TerrainMesh& mesh, const AffineMap& map) {
  std::vector<Float3> positions;
  positions.reserve(mesh.vertices.size());
  for (const hierarchy::TerrainVertex& vertex : mesh.vertices) {
    const PlanPosition at = map.at(column_of(vertex.place.plan), row_of(vertex.place.plan));
    positions.push_back({static_cast<float>(at.x), static_cast<float>(vertex.place.height_m),
                         static_cast<float>(-at.y)});
  }
  return positions;
}

std::string encode_plain_glb(const TerrainMesh& mesh, const Georeference& place, GridShape shape) {
  const WorldFrame world(place, shape);
  const AffineMap map = tangent_map(world, shape);
  const std::vector<Float3> positions = local_positions(mesh, map);
  const std::vector<Corners> triangles = turned_up(mesh, map.is_mirrored());

  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "terrane";
  model.buffers.emplace_back();
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] =
      add_accessor(model, positions, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                   TINYGLTF_TYPE_VEC3, positions.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(positions, {}, [axis](const Float3& p) { return p[axis]; });
    model.accessors[0].minValues.push_back(low[axis]);
    model.accessors[0].maxValues.push_back(high[axis]);
  }
  primitive.indices = add_accessor(model, triangles, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                   triangles.size() * 3);
  model.meshes.emplace_back().primitives = {primitive};
  if (!mesh.lines.empty()) {
    primitive.mode = TINYGLTF_MODE_LINE;
    primitive.indices = add_accessor(model, mesh.lines, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                     mesh.lines.size() * 2);
    model.meshes.back().primitives.push_back(primitive);
  }
  tinygltf::Node node;
  node.mesh = 0;
  node.extras = origin_of(world);
  model.nodes.push_back(node);
  model.scenes.emplace_back().nodes = {0};
  model.defaultScene = 0;

  std::ostringstream bytes;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, bytes, /*prettyPrint=*/false,
                                              /*writeBinary=*/true);
  return std::move(bytes).str();
}

}  // namespace

MeshFormat mesh_format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".glb") return MeshFormat::kGlb;
  throw ConfigError(fmt::format(
      "{}: the extension says no format of a mesh. Use .obj, .ply or .glb", file.string()));
}

double height_steps_per_m(MeshFormat format) {
  // a float holds every multiple of 1/1024 up to 16 km; doubles get what prints as six decimals
  return format == MeshFormat::kGlb ? 1024 : 1e6;
}

std::string encode_mesh(const TerrainMesh& mesh, MeshFormat format, const Georeference& place,
                        GridShape shape) {
  switch (format) {
    case MeshFormat::kObj:
      return encode_obj(mesh, place);
    case MeshFormat::kPly:
      return encode_ply(mesh, place);
    case MeshFormat::kGlb:
      return encode_plain_glb(mesh, place, shape);
  }
  return {};
}

}  // namespace terrane::tiler
