#include "hierarchy/merge/tree_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/errors.h"
#include "hierarchy/levels/build_levels.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

/// CRC-32, bit by bit.
std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0xffffffff;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (0xedb88320 & (0 - (sum & 1)));
  }
  return ~sum;
}

void expect_same(const MergeTree& a, const MergeTree& b) {
  EXPECT_TRUE(a.points == b.points);
  EXPECT_TRUE(a.normals == b.normals);
  EXPECT_TRUE(a.triangles == b.triangles);
  EXPECT_TRUE(a.bounds == b.bounds);
  EXPECT_TRUE(a.colours == b.colours);
  EXPECT_TRUE(a.coarser_merges == b.coarser_merges);
  EXPECT_TRUE(a.finer_merges == b.finer_merges);
  EXPECT_TRUE(a.coarse_triangles == b.coarse_triangles);
  EXPECT_EQ(a.lattice.origin(), b.lattice.origin());
  EXPECT_EQ(a.lattice.exponent(), b.lattice.exponent());
  EXPECT_EQ(a.measure, b.measure);
  EXPECT_EQ(a.region, b.region);
}

TEST(TreeFile, ComesBackAsItWas) {
  for (const MergeTree& tree :
       {build_merge_tree(sphere(4)), build_merge_tree(painted(sphere(4))),
        build_merge_tree(torn_torus(60, 24)),
        build_merge_tree(hills(65, 65), {.region = Region::kBothEnds}),
        merge_tree_of(build_levels(hills(33, 33))), merge_tree_of(build_levels(torus(30, 12)))}) {
    const std::string bytes = encode_tree(tree);
    const MergeTree back = decode_tree(bytes, "a.tree");
    expect_same(tree, back);
    EXPECT_TRUE(encode_tree(back) == bytes);
  }
}

TEST(TreeFile, OneOfTheVersionWithoutColoursIsReadAsWell) {
  const MergeTree tree = build_merge_tree(sphere(3));
  std::string bytes = encode_tree(tree);
  bytes[8] = 1;
  const std::uint32_t sum = checksum(std::string_view(bytes).substr(0, 60));
  std::memcpy(bytes.data() + 60, &sum, 4);
  expect_same(tree, decode_tree(bytes, "a.tree"));
}

TEST(TreeFile, EveryShortenedFileIsRefused) {
  const std::string bytes = encode_tree(build_merge_tree(painted(torn_torus(20, 8))));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(decode_tree(bytes.substr(0, size), "a.tree"), InputError) << size;
  }
  EXPECT_THROW(decode_tree(bytes + '\0', "a.tree"), InputError);
}

TEST(TreeFile, EveryFlippedByteIsRefused) {
  const std::string bytes = encode_tree(build_merge_tree(painted(sphere(2))));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    EXPECT_THROW(decode_tree(flipped, "a.tree"), InputError) << i;
  }
}

TEST(TreeFile, APrefixIsACoarserTreeWithTheSameBounds) {
  const MergeTree whole = build_merge_tree(hills(101, 101));
  const std::string bytes = encode_tree(whole);
  const MergeTree part = decode_tree(std::string_view(bytes).substr(0, bytes.size() * 2 / 3),
                                     "a.tree", TreeEnd::kAnywhere);
  EXPECT_EQ(part.merge_count(), 4096U);
  EXPECT_TRUE(std::ranges::equal(part.bounds, std::span(whole.bounds).first(4096)));
  MergeFront front(part);
  front.update(ViewJudge(part, RandomViews(part, 1).camera(), {.tolerance_px = 0}));
  EXPECT_TRUE(Oracle(shown_triangles(part, front)).is_manifold);
}

void reseal(std::string& bytes, std::size_t begin, std::size_t size) {
  const std::uint32_t sum = checksum(std::string_view(bytes).substr(begin, size));
  std::memcpy(bytes.data() + begin + size, &sum, 4);
}

/// A tree whose checksums are right is still no tree if what they seal is not.
TEST(TreeFile, DamageUnderRightChecksumsIsRefusedOrHarmless) {
  std::mt19937 random(99);
  int refused = 0, read = 0;
  for (const MergeTree& tree : {build_merge_tree(torn_torus(20, 8)), build_merge_tree(sphere(2)),
                                merge_tree_of(build_levels(torus(20, 10)))}) {
    const std::string bytes = encode_tree(tree);
    std::uint32_t coarsest_bytes = 0;
    std::memcpy(&coarsest_bytes, bytes.data() + 56, 4);
    for (int round = 0; round < 4000; ++round) {
      std::string damaged = bytes;
      const int flips = 1 + static_cast<int>(random() % 3);
      for (int i = 0; i < flips; ++i) {
        damaged[8 + random() % (damaged.size() - 8)] = static_cast<char>(random());
      }
      reseal(damaged, 0, 60);
      reseal(damaged, 64, coarsest_bytes);
      const std::size_t block = 64 + coarsest_bytes + 4;
      reseal(damaged, block, damaged.size() - block - 4);
      try {
        const MergeTree back = decode_tree(damaged, "a.tree");
        MergeFront front(back);  // whatever it is, it can be walked
        RandomViews views(back, 1);
        for (int frame = 0; frame < 3; ++frame) {
          front.update(ViewJudge(back, views.camera(), views.criteria()));
        }
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 100);
}

TEST(TreeFile, SaysWhatIsWrongWithAFileThatIsNoTree) {
  try {
    decode_tree("PLY", "bunny.ply");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bunny.ply"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("terrane merge-tree"), std::string::npos);
  }
}

}  // namespace
}  // namespace terrane::hierarchy
