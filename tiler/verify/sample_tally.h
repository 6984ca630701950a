#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tiler/verify/coverage.h"
#include "tiler/verify/report.h"

namespace terrane::verify {

/// The moments at which samples are judged: at rest, and kMorphTimes.
inline constexpr std::size_t kTimeCount = 1 + kMorphTimes.size();
constexpr double time_at(std::size_t index) { return index == 0 ? 0 : kMorphTimes[index - 1]; }

/// One level at one time.
struct Slot {
  int level = 0;
  int time = 0;  ///< for time_at()

  auto operator<=>(const Slot&) const = default;
};

/// A sample's column and row.
struct SamplePlace {
  std::int64_t column = 0;
  std::int64_t row = 0;
};

/// Sums over judged samples.
struct Tally {
  std::int64_t samples = 0;
  std::int64_t uncovered = 0;
  std::int64_t over_tolerance = 0;
  double max_error_m = 0;
  double square_sum_m2 = 0;
  SamplePlace worst;            ///< where max_error_m is
  SamplePlace first_uncovered;  ///< where the first of `uncovered` is

  void add(const Verdict& verdict, const SamplePlace& place, double limit_m);
  void add(const Tally& other);
  bool holds() const { return uncovered == 0 && over_tolerance == 0; }
};

/// What one leaf block found out, at every level above it.
struct BlockFindings {
  TileKey leaf;
  Window window;
  std::vector<SamplePlace> rim;  ///< terrain samples that other blocks may have too
  struct OfSlot {
    Slot slot;
    Tally inside;                    ///< of the samples that no other block has
    std::vector<Verdict> rim;        ///< one per entry of rim
    std::int64_t on_wrong_side = 0;  ///< of a shore, at rest; those of the rim as well
    SamplePlace first_on_wrong_side;
  };
  std::vector<OfSlot> slots;
};

/// Adds up findings block by block; a sample that several blocks share is counted once, when the
/// last of them has been added. Holds only the samples that still wait.
class SampleTally {
 public:
  SampleTally(const Tiling& tiling, std::vector<LevelEntry> levels);

  /// Blocks of all leaf tiles have to be added, each once, in any order that is always the same.
  void add(const BlockFindings& findings);

  const Tally& of(const Slot& slot) const;

  /// One line per tile and time with a sample that fails, up to a thousand.
  std::vector<std::string> problems() const;

 private:
  struct Waiting {
    int blocks_to_come = 0;
    std::vector<Verdict> verdicts;  // per slot, in the order of slots
  };
  int blocks_with(const SamplePlace& place) const;
  void add_rim_sample(const BlockFindings& findings, std::size_t rim_index);
  void note_failure(const Slot& slot, const TileKey& leaf, const Tally& tally);
  double limit_m(const Slot& slot) const;

  Tiling tiling_;
  std::vector<LevelEntry> levels_;
  std::map<Slot, Tally> tallies_;
  std::unordered_map<std::int64_t, Waiting> waiting_;
  std::map<std::pair<TileKey, int>, Tally> failing_;  // by tile and time
};

/// The error that a level may have: its own tolerance at rest, the next one's while it morphs.
double tolerance_m(const std::vector<LevelEntry>& levels, const Slot& slot);

}  // namespace terrane::verify
