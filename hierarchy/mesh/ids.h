#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrane::hierarchy {

enum class VertexId : std::uint32_t {};
enum class TriangleId : std::uint32_t {};
/// 3 t + k for the k-th side of triangle t.
enum class HalfedgeId : std::uint32_t {};

inline constexpr HalfedgeId kNoHalfedge{~std::uint32_t{0}};

template <class Id>
constexpr std::size_t index(Id id) {
  return static_cast<std::size_t>(id);
}

/// Keeps the values of \p ids only, in that order and without another vector. \pre \p ids ascend.
template <class T, class Id>
void keep_only(std::vector<T>& values, const std::vector<Id>& ids) {
  std::size_t end = 0;
  for (const Id id : ids) values[end++] = values[index(id)];
  values.resize(end);
}

/// A vector that only ids of its own kind can index.
template <class Id, class T>
class IdVector {
 public:
  IdVector() = default;
  explicit IdVector(std::size_t size, const T& value = {}) : values_(size, value) {}

  T& operator[](Id id) { return values_[index(id)]; }
  const T& operator[](Id id) const { return values_[index(id)]; }
  std::size_t size() const { return values_.size(); }
  void push_back(const T& value) { values_.push_back(value); }
  /// Keeps the values of \p ids only, in that order. \pre \p ids ascend.
  void keep(const std::vector<Id>& ids) { keep_only(values_, ids); }
  void resize(std::size_t size) { values_.resize(size); }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::vector<T> values_;
};

}  // namespace terrane::hierarchy
