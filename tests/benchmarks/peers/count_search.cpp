#include "count_search.h"

#include <cmath>

namespace terrane::peers {

const Run& CountSearch::run(std::size_t count) {
  if (const auto known = runs_.find(count); known != runs_.end()) return known->second;
  const Answer answer = peer_.by_count(terrain_, count);
  return runs_[count] =
             Run{answer.mesh.triangles.size(), judge(answer.mesh, terrain_.grid), answer.cpu_s};
}

std::optional<Run> CountSearch::fewest_within(double tolerance_m) {
  constexpr double kStep = 1.6, kLastStep = 1.01;
  const auto holds = [&](std::size_t count) { return run(count).verdict.max_m <= tolerance_m; };
  // all the way down: one bad vertex may break the bound at a count and be gone at the next
  const auto full = static_cast<double>(terrain_.full.triangles.size()) / 1.02;
  double enough = 0;
  for (double count = full; count > 1000; count /= kStep) {
    if (holds(static_cast<std::size_t>(count))) enough = count;
  }
  if (enough == 0) return std::nullopt;
  double few = enough / kStep;
  while (enough / few > kLastStep) {
    const double middle = std::sqrt(few * enough);
    (holds(static_cast<std::size_t>(middle)) ? enough : few) = middle;
  }
  return run(static_cast<std::size_t>(enough));
}

}  // namespace terrane::peers
