#include "tiler/gltf/draco_mesh.h"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

using draco::GeometryAttribute;

draco::DataType draco_type(Component component) {
  switch (component) {
    case Component::kByte:
      return draco::DT_INT8;
    case Component::kUnsignedByte:
      return draco::DT_UINT8;
    case Component::kShort:
      return draco::DT_INT16;
    case Component::kUnsignedShort:
      return draco::DT_UINT16;
    case Component::kFloat:
      return draco::DT_FLOAT32;
  }
  return draco::DT_INVALID;
}

int size_of(Component component) {
  if (component == Component::kFloat) return 4;
  return component == Component::kShort || component == Component::kUnsignedShort ? 2 : 1;
}

/// The same as floats: Draco has ways of its own to make them small.
GlbValues as_floats(const GlbValues& values) {
  if (values.component == Component::kFloat) return values;
  GlbValues floats{.components = values.components, .count = values.count};
  floats.stride = 4 * static_cast<std::size_t>(values.components);
  for (std::size_t n = 0; n < values.count; ++n) {
    const char* element = values.bytes.data() + n * values.stride;
    for (int k = 0; k < values.components; ++k) {
      std::int8_t byte;
      std::uint16_t word;
      std::memcpy(&byte, element + k, 1);
      if (values.component == Component::kUnsignedShort) std::memcpy(&word, element + 2 * k, 2);
      const float value = values.component == Component::kUnsignedShort
                              ? static_cast<float>(word) / 65535
                              : static_cast<float>(byte) / 127;
      char raw[4];
      std::memcpy(raw, &value, 4);
      floats.bytes.append(raw, 4);
    }
  }
  return floats;
}

class Encoding {
 public:
  Encoding(const GlbArrays& arrays, bool is_water) {
    const std::vector<std::uint32_t>& indices = is_water ? arrays.water : arrays.land;
    mesh_.set_num_points(static_cast<std::uint32_t>(arrays.vertices()));
    mesh_.SetNumFaces(indices.size() / 3);
    for (std::uint32_t f = 0; f < mesh_.num_faces(); ++f) {
      const auto corner = [&](std::uint32_t k) { return draco::PointIndex(indices[3 * f + k]); };
      mesh_.SetFace(draco::FaceIndex(f), {corner(0), corner(1), corner(2)});
    }
    add("POSITION", arrays.positions, GeometryAttribute::POSITION);
    add("NORMAL", as_floats(is_water ? arrays.upright : arrays.normals), GeometryAttribute::NORMAL);
    add("_MORPH", arrays.morphs, GeometryAttribute::GENERIC);
    if (arrays.places) add("TEXCOORD_0", as_floats(*arrays.places), GeometryAttribute::TEX_COORD);
    if (arrays.colours && !is_water) add("COLOR_0", *arrays.colours, GeometryAttribute::COLOR);
  }

  DracoMesh encode() {
    draco::ExpertEncoder encoder(mesh_);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetSpeedOptions(3, 3);
    encoder.SetTrackEncodedProperties(true);
    for (int id = 0; id < static_cast<int>(result_.attributes.size()); ++id) {
      quantize(encoder, id, result_.attributes[static_cast<std::size_t>(id)]);
    }
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok() || encoder.num_encoded_faces() != mesh_.num_faces()) {
      throw OutputError(fmt::format("Draco cannot encode a tile ({}). Use --compression meshopt",
                                    status.error_msg_string()));
    }
    result_.bytes.assign(buffer.data(), buffer.size());
    result_.vertices = encoder.num_encoded_points();
    return std::move(result_);
  }

 private:
  void add(const char* name, const GlbValues& values, GeometryAttribute::Type kind) {
    GeometryAttribute attribute;
    const int bytes = values.components * size_of(values.component);
    attribute.Init(kind, nullptr, static_cast<std::int8_t>(values.components),
                   draco_type(values.component), values.is_normalized, bytes, 0);
    const int id = mesh_.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.count));
    for (std::uint32_t n = 0; n < values.count; ++n) {
      mesh_.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(n),
                                             values.bytes.data() + n * values.stride);
    }
    result_.attributes.emplace_back(name, values);
  }

  /// Integers are kept as they are; floats on a lattice by a quantization that has just its steps.
  static void quantize(draco::ExpertEncoder& encoder, int id,
                       const std::pair<std::string, GlbValues>& attribute) {
    const auto& [name, values] = attribute;
    constexpr int kNormalBits = 8, kPlaceBits = 14;
    if (name == "NORMAL") encoder.SetAttributeQuantization(id, kNormalBits);
    if (name == "TEXCOORD_0") encoder.SetAttributeQuantization(id, kPlaceBits);
    if (values.low.empty() || values.component != Component::kFloat) return;
    const float step = std::ldexp(1.0F, *std::ranges::min_element(values.exponent));
    const double lowest = *std::ranges::min_element(values.low);
    const double highest = *std::ranges::max_element(values.high);
    const auto steps = static_cast<std::uint64_t>((highest - lowest) / step);
    const int bits = std::max(1, static_cast<int>(std::bit_width(steps)));
    // beyond, floats would be rounded on the way; as they are, they are kept
    constexpr int kMostBits = 23;
    if (bits > kMostBits) return;
    const auto origin = static_cast<float>(lowest);
    const float origins[] = {origin, origin, origin};
    encoder.SetAttributeExplicitQuantization(id, bits, 3, origins,
                                             step * static_cast<float>((1 << bits) - 1));
  }

  draco::Mesh mesh_;
  DracoMesh result_;
};

}  // namespace

DracoMesh encode_draco(const GlbArrays& arrays, bool is_water) {
  return Encoding(arrays, is_water).encode();
}

}  // namespace terrane::tiler
