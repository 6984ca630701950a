#include "tiler/verify/block_judge.h"

namespace terrane::verify {
namespace {

/// Judges the samples of one leaf block against the tiles above it, at every level and time.
class BlockJudge {
 public:
  BlockJudge(const Output& output, const WaterJudge& water,
             const std::map<TileKey, TileFindings>& open)
      : output_(output), water_(water), open_(open) {}

  BlockFindings run(const SampleBlock& block) {
    BlockFindings findings{.leaf = block.leaf, .window = block.window};
    findings.rim = rim_of(block);
    const int levels = static_cast<int>(output_.levels.size());
    for (int level = 0; level < levels; ++level) {
      const int times = level + 1 == levels ? 1 : static_cast<int>(kTimeCount);
      for (int time = 0; time < times; ++time) judge_slot(block, {level, time}, findings);
    }
    judge_sides(block, findings);
    return findings;
  }

 private:
  static std::vector<SamplePlace> rim_of(const SampleBlock& block) {
    std::vector<SamplePlace> rim;
    for_each_terrain_sample(block, [&](std::int64_t column, std::int64_t row) {
      if (block.is_rim(column, row)) rim.push_back({column, row});
    });
    return rim;
  }

  template <typename Visit>
  static void for_each_terrain_sample(const SampleBlock& block, Visit visit) {
    const Window& window = block.window;
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        if (block.at(column, row).is_terrain) visit(column, row);
      }
    }
  }

  /// The tile above a leaf at rest, all its siblings too while they morph.
  std::vector<const PlacedMesh*> meshes_over(const TileKey& leaf, const Slot& slot) const {
    const TileKey own = output_.tiling.above(leaf, slot.level);
    const std::vector<TileKey> keys =
        slot.time == 0 ? std::vector{own} : output_.tiling.children(output_.tiling.parent(own));
    std::vector<const PlacedMesh*> meshes;
    for (const TileKey& key : keys) {
      if (const auto& placed = open_.at(key).placed) meshes.push_back(placed.get());
    }
    return meshes;
  }

  std::vector<Verdict> verdicts_of(const SampleBlock& block, const Slot& slot) const {
    const std::vector<const PlacedMesh*> meshes = meshes_over(block.leaf, slot);
    const double near_m = slot.time == 0
                              ? output_.levels[static_cast<std::size_t>(slot.level)].plan_step_m()
                              : output_.reach_m(slot.level);
    return judge(block, meshes, time_at(static_cast<std::size_t>(slot.time)), near_m);
  }

  void judge_slot(const SampleBlock& block, const Slot& slot, BlockFindings& findings) {
    const std::vector<Verdict> verdicts = verdicts_of(block, slot);
    const double limit_m = tolerance_m(output_.levels, slot) * (1 + 1e-9);
    BlockFindings::OfSlot of_slot{.slot = slot, .inside = {}, .rim = {}};
    for_each_terrain_sample(block, [&](std::int64_t column, std::int64_t row) {
      const Verdict& verdict = verdicts[block.index(column, row)];
      if (block.is_rim(column, row)) {
        of_slot.rim.push_back(verdict);
      } else {
        of_slot.inside.add(verdict, {column, row}, limit_m);
      }
    });
    if (slot.time == 0) at_rest_.push_back(verdicts);
    findings.slots.push_back(std::move(of_slot));
  }

  /// Water must be where the polygons are, and land elsewhere.
  void judge_sides(const SampleBlock& block, BlockFindings& findings) const {
    const std::vector<WaterShores::Place> places = water_.find(block);
    for (auto& of_slot : findings.slots) {
      if (of_slot.slot.time != 0) continue;
      const auto level = static_cast<std::size_t>(of_slot.slot.level);
      const double limit_m =
          output_.levels[level].tolerance_m + output_.levels[level].plan_step_m();
      for_each_terrain_sample(block, [&](std::int64_t column, std::int64_t row) {
        const std::size_t i = block.index(column, row);
        if (!is_on_wrong_side(at_rest_[level][i], places[i], limit_m)) return;
        if (of_slot.on_wrong_side++ == 0) of_slot.first_on_wrong_side = {column, row};
      });
    }
  }

  const Output& output_;
  const WaterJudge& water_;
  std::vector<std::vector<Verdict>> at_rest_;  ///< by level
  const std::map<TileKey, TileFindings>& open_;
};

}  // namespace

BlockFindings judge_block(const SampleBlock& block, const Output& output, const WaterJudge& water,
                          const std::map<TileKey, TileFindings>& open) {
  return BlockJudge(output, water, open).run(block);
}

}  // namespace terrane::verify
