#include "hierarchy/levels/swap_cycles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <set>
#include <vector>

namespace terrane::hierarchy {
namespace {

/// The mesh with what swaps need: neighbours of vertices, and triangles of edges.
class Swapper {
 public:
  explicit Swapper(SurfaceMesh& mesh) : mesh_(mesh), incident_(mesh.points.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) incident_[v].insert(t);
    }
  }

  CycleSwaps run() {
    CycleSwaps result;
    for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
      if (!is_cycle(v)) continue;
      ++result.found;
      result.removed += open(v);
    }
    return result;
  }

 private:
  /// Three triangles that close up about the vertex?
  bool is_cycle(std::uint32_t v) const {
    if (incident_[v].size() != 3) return false;
    return neighbours(v).size() == 3;
  }

  std::set<std::uint32_t> neighbours(std::uint32_t v) const {
    std::set<std::uint32_t> result;
    for (const std::uint32_t t : incident_[v]) {
      for (const std::uint32_t other : mesh_.triangles[t]) {
        if (other != v) result.insert(other);
      }
    }
    return result;
  }

  bool is_on_border(std::uint32_t v) const { return neighbours(v).size() != incident_[v].size(); }

  /// Edges at v as the stencils count them: one more, to infinity, on the border.
  std::size_t valence(std::uint32_t v) const {
    return neighbours(v).size() + (is_on_border(v) ? 1 : 0);
  }

  struct Swap {
    std::uint32_t inner, outer;  // triangles: (a, b, v) of the cycle, (b, a, far) outside
    std::uint32_t a, b, v, far;
    double bend;  // cosine between the two new triangles: the larger, the flatter
  };

  /// Swaps the best of the three edges about a cycle; false if none may be.
  bool open(std::uint32_t v) {
    std::optional<Swap> best;
    for (const std::uint32_t t : incident_[v]) {
      const auto swap = swap_of(t, v);
      if (swap && (!best || swap->bend > best->bend)) best = swap;
    }
    if (!best) return false;
    commit(*best);
    return true;
  }

  std::optional<Swap> swap_of(std::uint32_t inner, std::uint32_t v) const {
    const Corners& c = mesh_.triangles[inner];
    const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
    const std::uint32_t a = c[(k + 1) % 3], b = c[(k + 2) % 3];
    for (const std::uint32_t t : incident_[a]) {
      if (t == inner || !incident_[b].contains(t)) continue;
      const Corners& o = mesh_.triangles[t];
      const std::uint32_t far = *std::ranges::find_if(o, [&](auto w) { return w != a && w != b; });
      if (neighbours(v).contains(far) || valence(a) < 5 || valence(b) < 5) return std::nullopt;
      return judged({inner, t, a, b, v, far, 0});
    }
    return std::nullopt;
  }

  Eigen::Vector3d normal(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const auto& p = mesh_.points;
    return (p[b] - p[a]).cross(p[c] - p[a]);
  }

  std::optional<Swap> judged(Swap swap) const {
    const Eigen::Vector3d before =
        normal(swap.a, swap.b, swap.v) + normal(swap.b, swap.a, swap.far);
    const Eigen::Vector3d one = normal(swap.v, swap.a, swap.far);
    const Eigen::Vector3d other = normal(swap.v, swap.far, swap.b);
    if (!(one.dot(before) > 0 && other.dot(before) > 0)) return std::nullopt;
    swap.bend = one.normalized().dot(other.normalized());
    return swap;
  }

  void commit(const Swap& swap) {
    incident_[swap.b].erase(swap.inner);
    incident_[swap.a].erase(swap.outer);
    mesh_.triangles[swap.inner] = {swap.v, swap.a, swap.far};
    mesh_.triangles[swap.outer] = {swap.v, swap.far, swap.b};
    incident_[swap.far].insert(swap.inner);
    incident_[swap.v].insert(swap.outer);
  }

  SurfaceMesh& mesh_;
  std::vector<std::set<std::uint32_t>> incident_;
};

}  // namespace

CycleSwaps swap_cycles(SurfaceMesh& mesh) { return Swapper(mesh).run(); }

}  // namespace terrane::hierarchy
