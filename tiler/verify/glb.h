#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "tiler/verify/draco_primitive.h"

namespace terrane::verify {

/// A binary glTF file whose primitives are compressed with EXT_meshopt_compression, with
/// KHR_draco_mesh_compression, or not at all.
///
/// Every accessor is checked against the file's length before it is read; whatever is wrong is an
/// InputError that names the file.
class Glb {
 public:
  using Vector = std::array<double, 3>;

  /// \throws InputError if the file is missing, cut off or no binary glTF.
  static Glb read(const std::filesystem::path& file);

  const nlohmann::json& document() const { return document_; }
  std::int64_t bytes() const { return static_cast<std::int64_t>(content_.size()); }

  /// An attribute of a primitive of SHORT or FLOAT VEC3; exact.
  std::vector<Vector> vectors(const nlohmann::json& primitive, const char* attribute) const;

  /// The corners of a primitive, UNSIGNED SHORT or UNSIGNED INT.
  std::vector<std::uint32_t> indices(const nlohmann::json& primitive) const;

  /// Whole numbers of an accessor, UNSIGNED SHORT or UNSIGNED INT, of no Draco mesh.
  std::vector<std::uint32_t> whole_numbers(const nlohmann::json& accessor_index) const;

  /// An error about this file.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct View {
    std::vector<unsigned char> bytes;
    std::size_t stride = 0;
  };

  const nlohmann::json& accessor_of(const nlohmann::json& index) const;
  std::vector<unsigned char> decode_view(std::size_t index, std::size_t& stride) const;
  std::vector<unsigned char> plain_view(const nlohmann::json& view, std::size_t index) const;
  View view_of(const nlohmann::json& accessor, std::size_t element_bytes) const;
  DracoPrimitive draco_of(const nlohmann::json& coded) const;
  void split_chunks();

  std::filesystem::path file_;
  std::vector<unsigned char> content_;
  std::size_t binary_begin_ = 0;
  std::size_t binary_size_ = 0;
  nlohmann::json document_;
};

}  // namespace terrane::verify
