#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace terrane::verify {

/// A mesh of KHR_draco_mesh_compression, decoded.
class DracoPrimitive {
 public:
  /// \return nothing if the bytes do not decode to a triangle mesh.
  static std::optional<DracoPrimitive> decode(std::span<const unsigned char> bytes);

  std::size_t vertices() const;
  std::vector<std::uint32_t> indices() const;

  /// Three components of each vertex; empty if there is no such attribute with three.
  std::vector<std::array<double, 3>> vectors(std::uint32_t unique_id) const;

 private:
  struct Decoded;
  std::shared_ptr<const Decoded> decoded_;
};

}  // namespace terrane::verify
