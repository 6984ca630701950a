#include "tiler/verify/tile_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tiler/verify/glb.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

/// glTF is y up: (i, k, -j) back to (i, j, k).
Lattice from_y_up(const Glb::Whole& stored) { return {stored[0], -stored[2], stored[1]}; }

bool agree(const json& numbers, const std::array<double, 3>& expected) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double off = numbers.at(axis).get<double>() - expected[axis];
    if (!(std::abs(off) <= 1e-9 * std::max(1.0, std::abs(expected[axis])))) return false;
  }
  return true;
}

void check_node(const json& document, const Eigen::Vector3d& step, const Lattice& origin,
                TileMesh& mesh) {
  const json& nodes = document.at("nodes");
  if (nodes.size() != 1 || document.at("meshes").size() != 1 ||
      document["meshes"][0].at("primitives").size() != 1) {
    mesh.misstated.push_back("has not one node, one mesh, one primitive");
  }
  const json& node = nodes.at(0);
  if (node.contains("matrix") || node.contains("rotation") ||
      !agree(node.at("scale"), {step[0], step[2], step[1]})) {
    mesh.misstated.push_back("the node's scale is not the step of terrane.json");
  }
  const auto i = static_cast<double>(origin[0]);
  const auto j = static_cast<double>(origin[1]);
  const auto k = static_cast<double>(origin[2]);
  if (!agree(node.value("translation", json::array({0, 0, 0})),
             {i * step[0], k * step[2], -j * step[1]})) {
    mesh.misstated.push_back("the node's translation is not the tile's origin");
  }
}

void check_extras(const json& extras, TileMesh& mesh) {
  const TileKey said{extras.at("level"), extras.at("x"), extras.at("y")};
  if (said != mesh.key) {
    mesh.misstated.push_back(fmt::format("its glb says that it is {}", to_string(said)));
  }
}

/// Clients cull by min and max; a wrong one makes a tile vanish.
void check_bounds(const json& accessor, const std::vector<Glb::Whole>& values, TileMesh& mesh) {
  Glb::Whole least = values.front();
  Glb::Whole most = values.front();
  for (const auto& value : values) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], value[axis]);
      most[axis] = std::max(most[axis], value[axis]);
    }
  }
  if (accessor.at("min").get<Glb::Whole>() != least ||
      accessor.at("max").get<Glb::Whole>() != most) {
    mesh.misstated.push_back("min and max of POSITION are not those of its vertices");
  }
}

void check_primitive(const json& document, const json& primitive, TileMesh& mesh) {
  const json& attributes = primitive.at("attributes");
  if (primitive.value("mode", 4) != 4) mesh.misstated.push_back("its primitive is no triangles");
  if (!primitive.contains("targets") ||
      primitive.at("targets").at(0).at("POSITION") != attributes.at("_MORPH")) {
    mesh.misstated.push_back("its morph target is not the accessor of _MORPH");
  }
  const json& normals = document.at("accessors").at(attributes.at("NORMAL").get<std::size_t>());
  if (normals.at("count") != mesh.position.size()) {
    mesh.misstated.push_back("has not one normal per vertex");
  }
}

void take_triangles(const Glb& glb, const std::vector<std::uint32_t>& indices, TileMesh& mesh) {
  if (indices.size() % 3 != 0) glb.fail("the number of indices is no multiple of 3");
  mesh.triangles.resize(indices.size() / 3);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= mesh.position.size()) glb.fail("an index points past the vertices");
    mesh.triangles[i / 3][i % 3] = indices[i];
  }
}

void take_vertices(const Glb& glb, const json& primitive, const Lattice& origin, TileMesh& mesh) {
  const json& attributes = primitive.at("attributes");
  const auto positions = glb.whole_vectors(attributes.at("POSITION"));
  const auto morphs = glb.whole_vectors(attributes.at("_MORPH"));
  if (positions.empty()) glb.fail("no vertices");
  if (positions.size() != morphs.size()) glb.fail("POSITION and _MORPH differ in length");
  for (std::size_t v = 0; v < positions.size(); ++v) {
    mesh.position.push_back(origin + from_y_up(positions[v]));
    mesh.morph.push_back(from_y_up(morphs[v]));
  }
  const auto accessor = attributes.at("POSITION").get<std::size_t>();
  check_bounds(glb.document().at("accessors").at(accessor), positions, mesh);
}

}  // namespace

Lattice operator+(const Lattice& a, const Lattice& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

TileMesh read_tile_mesh(const Output& output, const TileKey& key) {
  const Glb glb = Glb::read(output.file_of(key));
  TileMesh mesh{.key = key, .bytes = glb.bytes()};
  try {
    const json& document = glb.document();
    const json& content = document.at("meshes").at(0);
    const json& primitive = content.at("primitives").at(0);
    const json& extras = content.at("extras").at("terrane");
    const auto origin = extras.at("origin").get<Lattice>();
    take_vertices(glb, primitive, origin, mesh);
    take_triangles(glb, glb.indices(primitive.at("indices")), mesh);
    check_extras(extras, mesh);
    check_node(document, output.levels[static_cast<std::size_t>(key.level)].step_m, origin, mesh);
    check_primitive(document, primitive, mesh);
  } catch (const json::exception& error) {
    glb.fail(error.what());
  }
  return mesh;
}

}  // namespace terrane::verify
