#include "tiler/verify/draco_primitive.h"

#include <draco/compression/decode.h>

namespace terrane::verify {

struct DracoPrimitive::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

std::optional<DracoPrimitive> DracoPrimitive::decode(std::span<const unsigned char> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) return std::nullopt;
  DracoPrimitive primitive;
  primitive.decoded_ = std::make_shared<const Decoded>(std::move(mesh).value());
  return primitive;
}

std::size_t DracoPrimitive::vertices() const { return decoded_->mesh->num_points(); }

std::vector<std::uint32_t> DracoPrimitive::indices() const {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t f = 0; f < decoded_->mesh->num_faces(); ++f) {
    for (const draco::PointIndex& corner : decoded_->mesh->face(draco::FaceIndex(f))) {
      indices.push_back(corner.value());
    }
  }
  return indices;
}

std::vector<std::array<double, 3>> DracoPrimitive::vectors(std::uint32_t unique_id) const {
  const draco::PointAttribute* attribute = decoded_->mesh->GetAttributeByUniqueId(unique_id);
  if (attribute == nullptr || attribute->num_components() != 3) return {};
  std::vector<std::array<double, 3>> vectors(vertices());
  for (std::uint32_t v = 0; v < vectors.size(); ++v) {
    attribute->ConvertValue<double>(attribute->mapped_index(draco::PointIndex(v)), 3,
                                    vectors[v].data());
  }
  return vectors;
}

}  // namespace terrane::verify
