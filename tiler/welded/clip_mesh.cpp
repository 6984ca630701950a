#include "tiler/welded/clip_mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace terrane::welded {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

class Clipping {
 public:
  Clipping(const SurfaceMesh& mesh, const std::function<double(const Position&)>& inside)
      : mesh_(mesh), kept_as_(mesh.positions.size(), kUnused) {
    for (const Position& position : mesh.positions) values_.push_back(inside(position));
  }

  SurfaceMesh run() {
    for (const Triangle& triangle : mesh_.triangles) add(triangle);
    return std::move(clipped_);
  }

 private:
  bool is_inside(std::uint32_t vertex) const { return values_[vertex] >= 0; }

  /// Walks around the triangle: its corners inside, and the cuts between inside and outside.
  void add(const Triangle& triangle) {
    std::vector<std::uint32_t> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangle[k];
      const std::uint32_t to = triangle[(k + 1) % 3];
      if (is_inside(from)) polygon.push_back(kept(from));
      if (is_inside(from) == is_inside(to)) continue;
      // where the inner end is on the border itself, it is the cut
      const std::uint32_t inner = is_inside(from) ? from : to;
      if (values_[inner] > 0) polygon.push_back(cut(from, to));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      clipped_.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
  }

  std::uint32_t append(const Position& position) {
    clipped_.positions.push_back(position);
    return static_cast<std::uint32_t>(clipped_.positions.size() - 1);
  }

  std::uint32_t kept(std::uint32_t vertex) {
    if (kept_as_[vertex] == kUnused) kept_as_[vertex] = append(mesh_.positions[vertex]);
    return kept_as_[vertex];
  }

  std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);  // the same rounding from both sides
    const auto known = cuts_.find({a, b});
    if (known != cuts_.end()) return known->second;
    const double t = values_[a] / (values_[a] - values_[b]);
    Position position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double from = mesh_.positions[a][axis];
      position[axis] = from + t * (mesh_.positions[b][axis] - from);
    }
    return cuts_[{a, b}] = append(position);
  }

  const SurfaceMesh& mesh_;
  std::vector<double> values_;
  std::vector<std::uint32_t> kept_as_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts_;
  SurfaceMesh clipped_;
};

}  // namespace

SurfaceMesh clip(const SurfaceMesh& mesh, const std::function<double(const Position&)>& inside) {
  return Clipping(mesh, inside).run();
}

}  // namespace terrane::welded
