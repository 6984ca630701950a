#include "tiler/gltf/write_glb.h"

#include <nlohmann/json.hpp>
#include <optional>

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
    mesh["primitives"] = ordered_json::array();
    add_primitives(arrange_surface, mesh["primitives"], "");
    if (!tile_.skirt.triangles.empty()) add_primitives(arrange_skirt, mesh["primitives"], "skirt");
    if (has_targets()) mesh["weights"] = {0};
    mesh["extras"] = describe(tile_, origin_);

    ordered_json json;
    json["asset"] = {{"version", "2.0"}, {"generator", TERRANE_GENERATOR}};
    if (!format_.attribution.empty()) json["asset"]["copyright"] = format_.attribution;
    list_extensions(json);
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = {node_at(origin_, tile_.step_m, is_scaled)};
    json["meshes"] = {mesh};
    json["materials"] = materials_;
    if (tile_.texture.is_there()) add_texture(json);
    json["accessors"] = buffers_.accessors();
    json["bufferViews"] = buffers_.views();
    json["buffers"] = buffers_.buffers();
    return pack_glb(json.dump(), buffers_.bytes());
  }

 private:
  bool has_targets() const { return format_.compression != Compression::kDraco; }

  using Arrange = GlbArrays (*)(const GlbTile&, const TileFormat&, Cover);

  /// Those on land, then those in water.
  /// \param mark  what extras say that they are; empty: nothing.
  void add_primitives(Arrange arrange, ordered_json& list, const char* mark) {
    const auto add = [&](ordered_json primitive, bool is_water) {
      primitive["material"] = material(is_water);
      if (*mark != 0) primitive["extras"]["terrane"][mark] = true;
      list.push_back(std::move(primitive));
    };
    if (format_.compression == Compression::kDraco) {
      for (const bool is_water : {false, true}) {
        const GlbArrays arrays = arrange(tile_, format_, is_water ? Cover::kWater : Cover::kLand);
        const std::size_t indices = (is_water ? arrays.water : arrays.land).size();
        if (indices == 0) continue;
        add(draco_primitive(encode_draco(arrays, is_water), indices), is_water);
      }
      return;
    }
    const GlbArrays arrays = arrange(tile_, format_, Cover::kAll);
    ordered_json attributes = stored_attributes(arrays);
    if (!arrays.land.empty()) add(primitive(attributes, arrays.land, arrays.vertices()), false);
    if (arrays.water.empty()) return;
    attributes["NORMAL"] = buffers_.add_vertices(arrays.upright);
    attributes.erase("COLOR_0");
    add(primitive(attributes, arrays.water, arrays.vertices()), true);
  }

  ordered_json stored_attributes(const GlbArrays& arrays) {
    ordered_json attributes;
    const auto [position, morph] = buffers_.add_vertices(arrays.positions, arrays.morphs);
    attributes["POSITION"] = position;
    if (!arrays.land.empty()) attributes["NORMAL"] = buffers_.add_vertices(arrays.normals);
    attributes["_MORPH"] = morph;
    if (arrays.places) attributes["TEXCOORD_0"] = buffers_.add_vertices(*arrays.places);
    if (arrays.colours && !arrays.land.empty()) {
      attributes["COLOR_0"] = buffers_.add_vertices(*arrays.colours);
    }
    return attributes;
  }

  ordered_json primitive(const ordered_json& attributes, const std::vector<std::uint32_t>& indices,
                         std::size_t vertices) {
    ordered_json primitive;
    primitive["attributes"] = attributes;
    primitive["targets"] = {{{"POSITION", attributes["_MORPH"]}}};
    primitive["indices"] = buffers_.add_triangles(indices, vertices);
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

  /// The number of a material, which is made when it is first used.
  std::size_t material(bool is_water) {
    std::optional<std::size_t>& number = is_water ? water_ : land_;
    if (!number) {
      number = materials_.size();
      materials_.push_back(is_water ? water_material() : land_material());
    }
    return *number;
  }

  ordered_json land_material() const {
    ordered_json material;
    ordered_json& surface = material["pbrMetallicRoughness"];
    const bool has_colours = tile_.texture.is_there() || format_.colour != Colour::kNone;
    if (!has_colours) surface["baseColorFactor"] = {0.62, 0.6, 0.55, 1};
    finish(material);  // what is left out is as wanted: 1 is its roughness
    return material;
  }

  ordered_json water_material() const {
    constexpr double kRoughness = 0.25;
    ordered_json material;
    material["name"] = "water";
    ordered_json& surface = material["pbrMetallicRoughness"];
    if (!tile_.texture.is_there()) surface["baseColorFactor"] = {0.03, 0.12, 0.22, 1};
    surface["roughnessFactor"] = kRoughness;
    finish(material);
    return material;
  }

  void finish(ordered_json& material) const {
    ordered_json& surface = material["pbrMetallicRoughness"];
    if (tile_.texture.is_there()) surface["baseColorTexture"]["index"] = 0;
    surface["metallicFactor"] = 0;
    if (format_.material == Material::kUnlit) {
      material["extensions"]["KHR_materials_unlit"] = ordered_json::object();
    }
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
  ordered_json materials_ = ordered_json::array();
  std::optional<std::size_t> land_, water_;
};

}  // namespace

std::string encode_glb(const GlbTile& tile, const TileFormat& format) {
  return Document(tile, format).encode();
}

}  // namespace terrane::tiler
