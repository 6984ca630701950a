#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tiler/gltf/glb_values.h"

namespace terrane::tiler {

/// The binary chunk of a glb as it grows, with the buffer views and accessors into it.
class GlbBuffers {
 public:
  /// \param is_meshopt  vertices and triangles are stored as EXT_meshopt_compression has it.
  explicit GlbBuffers(bool is_meshopt) : is_meshopt_(is_meshopt) {}

  /// \return the number of the accessor.
  int add_vertices(const GlbValues& values);
  /// Two attributes side by side in one view, where that can be: it is shorter than two views.
  /// \return the numbers of their accessors.
  std::array<int, 2> add_vertices(const GlbValues& first, const GlbValues& second);
  int add_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices);
  /// An accessor whose values lie in the compressed bytes of an extension.
  int add_elsewhere(const GlbValues& values, std::size_t count);
  int add_elsewhere(std::size_t indices, std::size_t vertices);
  /// Bytes as they are. \return the number of the buffer view.
  int add_raw(std::string_view bytes);

  const nlohmann::ordered_json& accessors() const { return accessors_; }
  const nlohmann::ordered_json& views() const { return views_; }
  nlohmann::ordered_json buffers() const;
  const std::string& bytes() const { return bytes_; }

 private:
  /// How values are stored here: as they are without meshopt.
  Filter filter_of(const GlbValues& values) const;
  const std::string& stored(const GlbValues& values) const;
  int add_vertex_view(const std::string& bytes, std::size_t count, std::size_t stride,
                      Filter filter);
  int add_coded(const std::vector<unsigned char>& coded, std::size_t count, std::size_t stride,
                const char* mode, const char* filter);
  int add_view(nlohmann::ordered_json view);
  int add_accessor(nlohmann::ordered_json accessor);

  bool is_meshopt_;
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
  std::string bytes_;
  std::size_t fallback_bytes_ = 0;
};

}  // namespace terrane::tiler
