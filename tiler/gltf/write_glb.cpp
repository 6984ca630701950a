#include "tiler/gltf/write_glb.h"

#include <nlohmann/json.hpp>

#include "tiler/gltf/draco_mesh.h"
#include "tiler/gltf/glb_arrays.h"
#include "tiler/gltf/glb_buffers.h"
#include "tiler/gltf/pack_glb.h"

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

ordered_json number_of(const LatticePoint& p) { return {p.i, p.j, p.k}; }

ordered_json describe(const GlbTile& tile, const LatticePoint& origin) {
  ordered_json extras;
  extras["terrane"] = {{"level", tile.id.level},
                       {"x", tile.id.x},
                       {"y", tile.id.y},
                       {"origin", number_of(origin)},
                       {"tolerance_m", tile.tolerance_m},
                       {"max_error_m", tile.max_error_m}};
  return extras;
}

ordered_json node_at(const LatticePoint& origin, const Eigen::Vector3d& step_m, bool is_scaled) {
  ordered_json node{{"mesh", 0}};
  if (is_scaled) node["scale"] = {step_m.x(), step_m.z(), step_m.y()};
  node["translation"] = {static_cast<double>(origin.i) * step_m.x(),
                         static_cast<double>(origin.k) * step_m.z(),
                         static_cast<double>(-origin.j) * step_m.y()};
  return node;
}

/// The document of a tile, part by part.
class Document {
 public:
  Document(const GlbTile& tile, const TileFormat& format)
      : tile_(tile),
        format_(format),
        buffers_(format.compression == Compression::kMeshopt),
        origin_(origin_of(tile.mesh)) {}

  std::string encode() {
    const bool is_scaled = format_.positions == Positions::kLattice;
    ordered_json mesh;
    mesh["primitives"].push_back(primitive(arrange_surface(tile_, format_)));
    if (!tile_.skirt.triangles.empty()) {
      mesh["primitives"].push_back(primitive(arrange_skirt(tile_, format_)));
      mesh["primitives"][1]["extras"]["terrane"]["skirt"] = true;
    }
    if (has_targets()) mesh["weights"] = {0};
    mesh["extras"] = describe(tile_, origin_);
    const ordered_json material = make_material();  // puts the texture into the buffer

    ordered_json json;
    json["asset"] = {{"version", "2.0"}, {"generator", TERRANE_GENERATOR}};
    if (!format_.attribution.empty()) json["asset"]["copyright"] = format_.attribution;
    list_extensions(json);
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = {node_at(origin_, tile_.step_m, is_scaled)};
    json["meshes"] = {mesh};
    json["materials"] = {material};
    if (tile_.texture.is_there()) add_texture(json);
    json["accessors"] = buffers_.accessors();
    json["bufferViews"] = buffers_.views();
    json["buffers"] = buffers_.buffers();
    return pack_glb(json.dump(), buffers_.bytes());
  }

 private:
  bool has_targets() const { return format_.compression != Compression::kDraco; }

  ordered_json primitive(const GlbArrays& arrays) {
    ordered_json primitive;
    if (format_.compression == Compression::kDraco) {
      primitive = draco_primitive(encode_draco(arrays), arrays.indices.size());
    } else {
      ordered_json attributes;
      const auto [position, morph] = buffers_.add_vertices(arrays.positions, arrays.morphs);
      attributes["POSITION"] = position;
      attributes["NORMAL"] = buffers_.add_vertices(arrays.normals);
      attributes["_MORPH"] = morph;
      if (arrays.places) attributes["TEXCOORD_0"] = buffers_.add_vertices(*arrays.places);
      if (arrays.colours) attributes["COLOR_0"] = buffers_.add_vertices(*arrays.colours);
      primitive["attributes"] = attributes;
      primitive["targets"] = {{{"POSITION", attributes["_MORPH"]}}};
      primitive["indices"] = buffers_.add_triangles(arrays.indices, arrays.positions.count);
    }
    primitive["material"] = 0;
    return primitive;
  }

  /// Draco changes the order of the vertices, so that a morph target beside it would not fit: the
  /// displacement is the attribute _MORPH alone.
  ordered_json draco_primitive(const DracoMesh& mesh, std::size_t indices) {
    ordered_json primitive, coded;
    coded["bufferView"] = buffers_.add_raw(mesh.bytes);
    int id = 0;
    for (const auto& [name, values] : mesh.attributes) {
      primitive["attributes"][name] = buffers_.add_elsewhere(values, mesh.vertices);
      coded["attributes"][name] = id++;
    }
    primitive["indices"] = buffers_.add_elsewhere(indices, mesh.vertices);
    primitive["extensions"][kDraco] = coded;
    return primitive;
  }

  ordered_json make_material() {
    ordered_json material;
    ordered_json& surface = material["pbrMetallicRoughness"];
    const bool has_colours = tile_.texture.is_there() || format_.colour != Colour::kNone;
    if (!has_colours) surface["baseColorFactor"] = {0.62, 0.6, 0.55, 1};
    if (tile_.texture.is_there()) surface["baseColorTexture"]["index"] = 0;
    surface["metallicFactor"] = 0;  // what is left out is as wanted: 1 is its roughness
    if (format_.material == Material::kUnlit) {
      material["extensions"]["KHR_materials_unlit"] = ordered_json::object();
    }
    return material;
  }

  bool is_webp() const { return tile_.texture.media_type == "image/webp"; }

  void add_texture(ordered_json& json) {
    json["images"] = {{{"bufferView", buffers_.add_raw(tile_.texture.bytes)},
                       {"mimeType", tile_.texture.media_type}}};
    constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071;
    json["samplers"] = {{{"magFilter", kLinear},
                         {"minFilter", kLinearMipmapLinear},
                         {"wrapS", kClampToEdge},
                         {"wrapT", kClampToEdge}}};
    ordered_json texture{{"sampler", 0}};
    if (is_webp()) {
      texture["extensions"]["EXT_texture_webp"]["source"] = 0;
    } else {
      texture["source"] = 0;
    }
    json["textures"] = {texture};
  }

  void list_extensions(ordered_json& json) const {
    std::vector<std::string> used, required;
    if (format_.positions == Positions::kLattice) required.push_back("KHR_mesh_quantization");
    if (format_.compression == Compression::kMeshopt) required.push_back("EXT_meshopt_compression");
    if (format_.compression == Compression::kDraco) required.push_back(kDraco);
    if (tile_.texture.is_there() && is_webp()) required.push_back("EXT_texture_webp");
    used = required;
    if (format_.material == Material::kUnlit) used.push_back("KHR_materials_unlit");
    if (!used.empty()) json["extensionsUsed"] = used;
    if (!required.empty()) json["extensionsRequired"] = required;
  }

  const GlbTile& tile_;
  const TileFormat& format_;
  GlbBuffers buffers_;
  LatticePoint origin_;
};

}  // namespace

std::string encode_glb(const GlbTile& tile, const TileFormat& format) {
  return Document(tile, format).encode();
}

}  // namespace terrane::tiler
