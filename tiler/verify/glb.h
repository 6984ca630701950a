#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace terrane::verify {

/// A binary glTF file whose buffer views are compressed with EXT_meshopt_compression.
///
/// Every accessor is checked against the file's length before it is read; whatever is wrong is an
/// InputError that names the file.
class Glb {
 public:
  using Whole = std::array<std::int32_t, 3>;

  /// \throws InputError if the file is missing, cut off or no binary glTF.
  static Glb read(const std::filesystem::path& file);

  const nlohmann::json& document() const { return document_; }
  std::int64_t bytes() const { return static_cast<std::int64_t>(content_.size()); }

  /// Elements of a VEC3 accessor of whole numbers, stored as SHORT or as FLOAT.
  std::vector<Whole> whole_vectors(const nlohmann::json& accessor_index) const;

  /// Elements of an UNSIGNED SHORT or UNSIGNED INT scalar accessor.
  std::vector<std::uint32_t> indices(const nlohmann::json& accessor_index) const;

  /// An error about this file.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct View {
    std::vector<unsigned char> bytes;
    std::size_t stride = 0;
  };

  Whole whole_of_shorts(const unsigned char* element) const;
  Whole whole_of_floats(const unsigned char* element) const;
  std::vector<unsigned char> decode_view(std::size_t index, std::size_t& stride) const;
  View view_of(const nlohmann::json& accessor, std::size_t element_bytes) const;
  void split_chunks();

  std::filesystem::path file_;
  std::vector<unsigned char> content_;
  std::size_t binary_begin_ = 0;
  std::size_t binary_size_ = 0;
  nlohmann::json document_;
};

}  // namespace terrane::verify
