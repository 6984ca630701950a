#include "tiler/verify/tile_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tiler/verify/glb.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

/// What one unit of a stored position is in lattice steps, in glTF's axes.
using Units = std::array<double, 3>;

/// A node that scales has positions in steps, one that does not has them in metres.
Units units_of(const json& document, const Eigen::Vector3d& step) {
  if (document.at("nodes").at(0).contains("scale")) return {1, 1, 1};
  return {1 / step[0], 1 / step[2], 1 / step[1]};
}

/// glTF is y up: (i, k, -j) back to (i, j, k).
Lattice from_y_up(const Glb& glb, const Glb::Vector& stored, const Units& units) {
  Lattice whole;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr double kMostWhole = 1 << 24;  // above, a float skips integers
    const double steps = stored[axis] * units[axis];
    if (!(std::abs(steps) < kMostWhole) || std::trunc(steps) != steps) {
      glb.fail(fmt::format("a vertex attribute is {} steps, no whole number below 2^24", steps));
    }
    whole[axis] = static_cast<std::int64_t>(steps);
  }
  return {whole[0], -whole[2], whole[1]};
}

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
  if (nodes.size() != 1 || document.at("meshes").size() != 1) {
    mesh.misstated.push_back("has not one node and one mesh");
  }
  const json& node = nodes.at(0);
  if (node.contains("matrix") || node.contains("rotation") ||
      (node.contains("scale") && !agree(node.at("scale"), {step[0], step[2], step[1]}))) {
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
void check_bounds(const json& accessor, const std::vector<Glb::Vector>& values, TileMesh& mesh) {
  Glb::Vector least = values.front();
  Glb::Vector most = values.front();
  for (const auto& value : values) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], value[axis]);
      most[axis] = std::max(most[axis], value[axis]);
    }
  }
  if (accessor.at("min").get<Glb::Vector>() != least ||
      accessor.at("max").get<Glb::Vector>() != most) {
    mesh.misstated.push_back("min and max of POSITION are not those of its vertices");
  }
}

bool is_draco(const json& primitive) {
  return primitive.value("extensions", json::object()).contains("KHR_draco_mesh_compression");
}

/// Each kind of primitive has a material of its own.
bool is_water(const json& document, const json& primitive) {
  if (!primitive.contains("material")) return false;
  const json& material = document.at("materials").at(primitive.at("material").get<std::size_t>());
  return material.value("name", "") == "water";
}

bool is_skirt(const json& primitive) {
  return primitive.value("/extras/terrane/skirt"_json_pointer, false);
}

void check_primitive(const json& document, const json& primitive, std::size_t vertices,
                     TileMesh& mesh) {
  const json& attributes = primitive.at("attributes");
  if (primitive.value("mode", 4) != 4) mesh.misstated.push_back("its primitive is no triangles");
  // where Draco orders the vertices anew, a target beside it would not fit
  if (is_draco(primitive)
          ? primitive.contains("targets")
          : !primitive.contains("targets") ||
                primitive.at("targets").at(0).at("POSITION") != attributes.at("_MORPH")) {
    mesh.misstated.push_back("its morph target is not the accessor of _MORPH");
  }
  const json& normals = document.at("accessors").at(attributes.at("NORMAL").get<std::size_t>());
  if (normals.at("count") != vertices) {
    mesh.misstated.push_back("has not one normal per vertex");
  }
}

struct Vertices {
  std::vector<Lattice> position;
  std::vector<Lattice> morph;
};

Vertices read_vertices(const Glb& glb, const json& primitive, const Units& units,
                       const Lattice& origin, TileMesh& mesh) {
  const auto positions = glb.vectors(primitive, "POSITION");
  const auto morphs = glb.vectors(primitive, "_MORPH");
  if (positions.empty()) glb.fail("no vertices");
  if (positions.size() != morphs.size()) glb.fail("POSITION and _MORPH differ in length");
  Vertices vertices;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    vertices.position.push_back(origin + from_y_up(glb, positions[v], units));
    vertices.morph.push_back(from_y_up(glb, morphs[v], units));
  }
  const auto accessor = primitive.at("attributes").at("POSITION").get<std::size_t>();
  check_bounds(glb.document().at("accessors").at(accessor), positions, mesh);
  return vertices;
}

/// Adds what is seen from above: all land, or all water, whose vertices may be the land's.
void take_surface(const Glb& glb, const json& primitive, const Units& units, const Lattice& origin,
                  TileMesh& mesh) {
  const json& document = glb.document();
  const json& first = document.at("meshes").at(0).at("primitives").at(0);
  const auto has_same = [&](const char* name) {
    return first.at("attributes").at(name) == primitive.at("attributes").at(name);
  };
  const bool has_its_own =
      mesh.position.empty() || is_draco(primitive) || !has_same("POSITION") || !has_same("_MORPH");
  std::size_t before = 0;
  if (has_its_own) {
    before = mesh.position.size();
    const Vertices vertices = read_vertices(glb, primitive, units, origin, mesh);
    mesh.position.insert(mesh.position.end(), vertices.position.begin(), vertices.position.end());
    mesh.morph.insert(mesh.morph.end(), vertices.morph.begin(), vertices.morph.end());
  }
  const std::size_t count = mesh.position.size() - before;
  check_primitive(document, primitive, count, mesh);
  const std::vector<std::uint32_t> indices = glb.indices(primitive);
  if (indices.size() % 3 != 0) glb.fail("the number of indices is no multiple of 3");
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= count) glb.fail("an index points past the vertices");
    if (i % 3 == 0) mesh.triangles.emplace_back();
    mesh.triangles.back()[i % 3] = static_cast<std::uint32_t>(before + indices[i]);
  }
  mesh.in_water.resize(mesh.triangles.size(), is_water(document, primitive));
}

/// Place and displacement, to be sorted by.
using Standing = std::pair<Lattice, Lattice>;

/// A skirt hangs from vertices of the tile straight down, all of it equally far.
void take_skirt(const Glb& glb, const json& primitive, const Units& units, const Lattice& origin,
                TileMesh& mesh) {
  const Vertices vertices = read_vertices(glb, primitive, units, origin, mesh);
  std::set<Standing> surface;
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    surface.emplace(mesh.position[v], mesh.morph[v]);
  }
  std::set<Standing> upper, lower;
  for (std::size_t v = 0; v < vertices.position.size(); ++v) {
    const Standing vertex{vertices.position[v], vertices.morph[v]};
    (surface.contains(vertex) ? upper : lower).insert(vertex);
    if (surface.contains(vertex)) continue;
    mesh.hem.push_back(vertex.first);
    mesh.hem.push_back(vertex.first + vertex.second);
  }
  const auto falls = [&](const Standing& high, const Standing& low) {
    const auto& first_high = upper.begin()->first;
    const auto& first_low = lower.begin()->first;
    return high.second == low.second && low.first[2] < high.first[2] &&
           low.first - high.first == first_low - first_high;
  };
  // moving all alike keeps their order
  if (upper.empty() || !std::equal(upper.begin(), upper.end(), lower.begin(), lower.end(), falls)) {
    mesh.misstated.push_back("its skirt does not hang straight from its vertices");
  }
  for (const std::uint32_t index : glb.indices(primitive)) {
    if (index >= vertices.position.size()) glb.fail("an index points past the vertices");
  }
}

}  // namespace

Lattice operator+(const Lattice& a, const Lattice& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Lattice operator-(const Lattice& a, const Lattice& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

TileMesh read_tile_mesh(const Output& output, const TileKey& key) {
  const Glb glb = Glb::read(output.file_of(key));
  TileMesh mesh{.key = key, .bytes = glb.bytes()};
  try {
    const json& document = glb.document();
    const json& content = document.at("meshes").at(0);
    const json& primitives = content.at("primitives");
    const json& extras = content.at("extras").at("terrane");
    const auto origin = extras.at("origin").get<Lattice>();
    const Eigen::Vector3d& step = output.levels[static_cast<std::size_t>(key.level)].step_m;
    const Units units = units_of(document, step);
    std::set<std::pair<bool, bool>> kinds;
    for (const json& primitive : primitives) {
      if (!kinds.emplace(is_skirt(primitive), is_water(document, primitive)).second) {
        mesh.misstated.push_back("has two primitives of one kind");
      }
      if (!is_skirt(primitive)) take_surface(glb, primitive, units, origin, mesh);
    }
    for (const json& primitive : primitives) {
      if (is_skirt(primitive)) take_skirt(glb, primitive, units, origin, mesh);
    }
    if (mesh.position.empty()) glb.fail("no vertices");
    check_extras(extras, mesh);
    check_node(document, step, origin, mesh);
  } catch (const json::exception& error) {
    glb.fail(error.what());
  }
  return mesh;
}

}  // namespace terrane::verify
