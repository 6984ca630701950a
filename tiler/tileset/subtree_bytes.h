#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace terrane::tiler {

/// Levels of a subtree: from 3 to 5, so that the last subtrees are as full as can be; 4 where that
/// is the same.
int best_levels_per_subtree(int levels);

/// The bits of both numbers in turn, those of x in the even places.
std::int64_t morton(std::int64_t x, std::int64_t y);

/// Tiles on the levels above \p depth of a full quadtree.
std::int64_t tiles_above(int depth);

/// The buffer of a subtree as it grows: views, each on a multiple of eight bytes.
class SubtreeBuffers {
 public:
  /// \return the number of the view.
  template <class T>
  int add(const std::vector<T>& values) {
    return add_bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  const nlohmann::ordered_json& views() const { return views_; }
  /// All of it, in whole eights of bytes.
  std::string padded() const;

 private:
  int add_bytes(const char* begin, std::size_t size);

  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

/// Which of some tiles are there: a constant where that is all or none.
class SubtreeAvailability {
 public:
  explicit SubtreeAvailability(std::int64_t size)
      : bits_(static_cast<std::size_t>((size + 7) / 8)), size_(size) {}

  void set(std::int64_t index);
  nlohmann::ordered_json json(SubtreeBuffers& buffers) const;

 private:
  std::vector<unsigned char> bits_;
  std::int64_t size_;
  std::int64_t count_ = 0;
};

/// Joins a subtree's JSON and its buffer to the binary format.
/// \par Source
/// OGC 3D Tiles 1.1, "Subtree binary format".
std::string pack_subtree(std::string json, const std::string& binary);

}  // namespace terrane::tiler
