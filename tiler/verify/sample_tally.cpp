#include "tiler/verify/sample_tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace terrane::verify {
namespace {

constexpr double kRelativeSlack = 1e-9;
constexpr std::size_t kMostFailingTiles = 1000;

/// Blocks along one axis that hold a sample.
int blocks_along(std::int64_t at, std::int64_t samples, std::int64_t cells) {
  const bool is_between = at % cells == 0 && at != 0 && at != samples - 1;
  return is_between ? 2 : 1;
}

}  // namespace

double tolerance_m(const std::vector<LevelEntry>& levels, const Slot& slot) {
  const auto level = static_cast<std::size_t>(slot.time == 0 ? slot.level : slot.level + 1);
  return levels[level].tolerance_m;
}

void Tally::add(const Verdict& verdict, const SamplePlace& place, double limit_m) {
  ++samples;
  if (verdict.cover == Cover::kNone) {
    if (uncovered++ == 0) first_uncovered = place;
    return;
  }
  square_sum_m2 += verdict.error_m * verdict.error_m;
  over_tolerance += !(verdict.error_m <= limit_m);
  if (verdict.error_m > max_error_m) {
    max_error_m = verdict.error_m;
    worst = place;
  }
}

void Tally::add(const Tally& other) {
  if (uncovered == 0) first_uncovered = other.first_uncovered;
  if (other.max_error_m > max_error_m) {
    max_error_m = other.max_error_m;
    worst = other.worst;
  }
  samples += other.samples;
  uncovered += other.uncovered;
  over_tolerance += other.over_tolerance;
  square_sum_m2 += other.square_sum_m2;
}

SampleTally::SampleTally(const Tiling& tiling, std::vector<LevelEntry> levels)
    : tiling_(tiling), levels_(std::move(levels)) {
  for (int level = 0; level < static_cast<int>(levels_.size()); ++level) {
    const bool is_root = level + 1 == static_cast<int>(levels_.size());
    for (int time = 0; time < (is_root ? 1 : static_cast<int>(kTimeCount)); ++time)
      tallies_[{level, time}] = {};
  }
}

double SampleTally::limit_m(const Slot& slot) const {
  return tolerance_m(levels_, slot) * (1 + kRelativeSlack);
}

int SampleTally::blocks_with(const SamplePlace& place) const {
  return blocks_along(place.column, tiling_.shape.columns, tiling_.tile_cells) *
         blocks_along(place.row, tiling_.shape.rows, tiling_.tile_cells);
}

void SampleTally::add(const BlockFindings& findings) {
  for (const auto& of_slot : findings.slots) {
    tallies_[of_slot.slot].add(of_slot.inside);
    note_failure(of_slot.slot, findings.leaf, of_slot.inside);
  }
  for (std::size_t n = 0; n < findings.rim.size(); ++n) add_rim_sample(findings, n);
}

void SampleTally::add_rim_sample(const BlockFindings& findings, std::size_t rim_index) {
  const SamplePlace& place = findings.rim[rim_index];
  const std::int64_t key = place.row * tiling_.shape.columns + place.column;
  Waiting& waiting = waiting_[key];
  if (waiting.verdicts.empty()) {
    waiting.blocks_to_come = blocks_with(place);
    waiting.verdicts.resize(findings.slots.size());
  }
  for (std::size_t slot = 0; slot < findings.slots.size(); ++slot) {
    Verdict& verdict = waiting.verdicts[slot];
    verdict = merge(verdict, findings.slots[slot].rim[rim_index]);
  }
  if (--waiting.blocks_to_come > 0) return;
  for (std::size_t n = 0; n < findings.slots.size(); ++n) {
    const Slot& slot = findings.slots[n].slot;
    Tally alone;
    alone.add(waiting.verdicts[n], place, limit_m(slot));
    tallies_[slot].add(alone);
    note_failure(slot, findings.leaf, alone);
  }
  waiting_.erase(key);
}

void SampleTally::note_failure(const Slot& slot, const TileKey& leaf, const Tally& tally) {
  if (tally.holds()) return;
  const std::pair key(tiling_.above(leaf, slot.level), slot.time);
  if (failing_.size() < kMostFailingTiles || failing_.contains(key)) failing_[key].add(tally);
}

const Tally& SampleTally::of(const Slot& slot) const { return tallies_.at(slot); }

std::vector<std::string> SampleTally::problems() const {
  std::vector<std::string> lines;
  for (const auto& [key, tally] : failing_) {
    const auto& [tile, time] = key;
    const std::string when =
        time == 0 ? "" : fmt::format(" at t = {}", time_at(static_cast<std::size_t>(time)));
    if (tally.over_tolerance > 0) {
      lines.push_back(fmt::format(
          "{}{}: {} samples over the tolerance of {} m, the worst {:.6g} m off at (column {}, row "
          "{})",
          to_string(tile), when, tally.over_tolerance, tolerance_m(levels_, {tile.level, time}),
          tally.max_error_m, tally.worst.column, tally.worst.row));
    }
    if (tally.uncovered > 0) {
      lines.push_back(fmt::format("{}{}: {} samples uncovered, the first at (column {}, row {})",
                                  to_string(tile), when, tally.uncovered,
                                  tally.first_uncovered.column, tally.first_uncovered.row));
    }
  }
  return lines;
}

}  // namespace terrane::verify
