#include "hierarchy/levels/weight_table.h"

#include "hierarchy/levels/triangle_weight.h"

namespace terrane::hierarchy {

WeightTable::WeightTable(const LevelMesh& level, const Weights& weights)
    : level_(level),
      weights_(weights),
      keys_(level.mesh.triangle_count()),
      facts_(level.mesh.triangle_count()),
      changed_at_(level.mesh.vertex_count(), 0) {
  static_assert(sizeof(Facts) == 64);
}

void WeightTable::bound(TriangleId t) {
  const HalfedgeMesh& mesh = level_.mesh;
  const HalfedgeId h = HalfedgeMesh::halfedge(t, 0);
  const VertexId a = mesh.start(h), b = mesh.end(h), c = mesh.apex(h);
  const TriangleShape shape = shape_of(level_.point(a), level_.point(b), level_.point(c));
  const int valence = static_cast<int>(mesh.valence(a) + mesh.valence(b) + mesh.valence(c)) - 9;
  Facts& facts = facts_[index(t)];
  facts.area = shape.area;
  facts.state = State::kBounded;
  keys_[index(t)] =
      shape.area * (weights_.angle * shape.angle + weights_.valence * valence_term(valence));
}

void WeightTable::fit(CollapseJudge& judge, TriangleId t) {
  Facts& facts = facts_[index(t)];
  if (facts.state != State::kBounded) return;
  const auto frame = judge.frame(t);
  facts.surface = frame ? judge.surface(t, *frame) : LocalSurface();
  facts.state = State::kFitted;
}

void WeightTable::set_largest_curvature() {
  for (const Facts& facts : facts_) {
    if (facts.state == State::kBounded) continue;
    largest_curvature_ = std::max(largest_curvature_, facts.surface.absolute_curvature());
  }
}

void WeightTable::weigh(CollapseJudge& judge, TriangleId t) {
  fit(judge, t);
  Facts& facts = facts_[index(t)];
  double terms = 0;
  if (largest_curvature_ > 0) {
    terms = weights_.curvature * facts.surface.absolute_curvature() / largest_curvature_;
  }
  if (weights_.error > 0) {
    const auto frame = judge.frame(t);
    const auto plan = frame ? judge.plan(t, *frame, facts.surface) : std::nullopt;
    if (!plan) return reject(t, frame ? judge.rejection() : Rejection::kFlat);
    terms += weights_.error * judge.predictive_error(*frame, facts.surface, *plan);
  }
  keys_[index(t)] += facts.area * terms;
  facts.state = State::kWeighed;
}

void WeightTable::reject(TriangleId t, Rejection why) {
  facts_[index(t)].rejected_at = number_;
  facts_[index(t)].rejection = why;
}

void WeightTable::compact(const Survivors& old) {
  keep_only(keys_, old.triangles);
  keep_only(facts_, old.triangles);
  keep_only(changed_at_, old.vertices);
}

}  // namespace terrane::hierarchy
