#include "hierarchy/levels/number_sequence.h"

#include <utility>

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kUnnumbered = ~std::uint32_t{0};

}  // namespace

LevelSequence number_sequence(const LevelMesh& level, std::vector<std::vector<Collapse>> records,
                              std::uint32_t finest_vertex_count) {
  LevelSequence sequence{.lattice = level.lattice};
  std::vector<std::uint32_t> number(finest_vertex_count, kUnnumbered);
  sequence.coarsest_triangles = level.mesh.triangles();
  for (const Corners& corners : sequence.coarsest_triangles) {
    for (const std::uint32_t v : corners) number[level.names[v]] = 0;
  }
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < level.names.size(); ++v) {
    std::uint32_t& own = number[level.names[v]];
    if (own == kUnnumbered) continue;
    own = next++;
    sequence.coarsest_points.push_back(level.points[v]);
  }
  for (Corners& corners : sequence.coarsest_triangles) {
    for (std::uint32_t& v : corners) v = number[level.names[v]];
  }

  sequence.levels = std::move(records);
  for (auto collapses = sequence.levels.rbegin(); collapses != sequence.levels.rend();
       ++collapses) {
    for (const Collapse& collapse : *collapses) {
      number[collapse.corners[1]] = next++;
      number[collapse.corners[2]] = next++;
    }
  }
  for (auto& collapses : sequence.levels) {
    for (Collapse& collapse : collapses) {
      for (std::uint32_t& v : collapse.corners) v = number[v];
      for (std::uint32_t& v : collapse.apexes) v = v == kOutside ? kOutside : number[v];
    }
  }
  return sequence;
}

void drop_coarsest(LevelSequence& sequence) {
  LevelRebuilder rebuilder(sequence);
  rebuilder.refine();
  sequence.coarsest_points = rebuilder.points();
  sequence.coarsest_triangles = rebuilder.triangles();
  sequence.levels.pop_back();
}

}  // namespace terrane::hierarchy
