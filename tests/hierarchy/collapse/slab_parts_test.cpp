#include "hierarchy/collapse/slab_parts.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace terrane::hierarchy {
namespace {

using Samples = std::set<std::pair<std::int64_t, std::int64_t>>;

constexpr GridShape kShape{45, 38};  // the last blocks are cut off

/// The samples between sides that are not in a clear block, from a look at each row.
Samples samples_not_clear(std::span<const FieldSide> sides, std::int64_t side,
                          const Samples& clear_blocks) {
  Samples samples;
  for_each_span_between(sides, kShape, 1e-7,
                        [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                          for (; first <= last; ++first) {
                            if (clear_blocks.contains({first / side, row / side})) continue;
                            samples.emplace(first, row);
                          }
                          return true;
                        });
  return samples;
}

TEST(SlabParts, AreTheSamplesOfBlocksThatAreNotClearAndNoOthers) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> corner(-8, 50);
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<FieldPoint> points(3 + static_cast<std::size_t>(trial) % 4);
    for (FieldPoint& p : points) p = {corner(random), corner(random), 0};
    const HullSides hull(points);
    const HeightSlabs slabs(kShape, std::int64_t{2} << trial % 4);
    Samples clear_blocks, found;
    for (std::int64_t row = 0; row < slabs.shape().rows; ++row) {
      for (std::int64_t column = 0; column < slabs.shape().columns; ++column) {
        if (random() % 3 == 0) clear_blocks.emplace(column, row);
      }
    }
    for_each_part_not_clear(
        hull.sides(), kShape, 1e-7, slabs,
        [&](std::int64_t column, std::int64_t row) {
          return clear_blocks.contains({column, row});
        },
        [&](const RowSpan& part) {
          EXPECT_EQ(part.first / slabs.side(), part.last / slabs.side());
          for (std::int64_t column = part.first; column <= part.last; ++column) {
            EXPECT_TRUE(found.emplace(column, part.row).second) << column << ", " << part.row;
          }
          return true;
        });
    EXPECT_EQ(found, samples_not_clear(hull.sides(), slabs.side(), clear_blocks)) << trial;
  }
}

TEST(SlabParts, EndWithTheFirstRefusal) {
  const FieldPoint corners[] = {{0, 0, 0}, {40, 0, 0}, {0, 37, 0}};
  int visits = 0;
  EXPECT_FALSE(for_each_part_not_clear(
      HullSides(corners).sides(), kShape, 1e-7, HeightSlabs(kShape, 8),
      [](std::int64_t, std::int64_t) { return false; },
      [&](const RowSpan&) { return ++visits < 3; }));
  EXPECT_EQ(visits, 3);
}

}  // namespace
}  // namespace terrane::hierarchy
