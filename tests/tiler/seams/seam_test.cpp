#include "tiler/seams/seam.h"

#include <gtest/gtest.h>

#include <map>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"
#include "tiler/files/whole_file.h"

namespace terrane::tiler {
namespace {

using testing::TemporaryFolder;

TEST(Seams, EverySeamBelongsToItsTwoTilesAndToNoOther) {
  const Pyramid pyramid({200, 150}, 64);  // 4 x 3 leaf tiles
  for (int level = 0; level < pyramid.level_count(); ++level) {
    std::map<SeamId, int> tiles_with;
    for (const TileId& tile : pyramid.tiles(level)) {
      for (const SeamId& seam : seams_of(pyramid, tile)) {
        EXPECT_TRUE(seam.first == tile || seam.second() == tile);
        ++tiles_with[seam];
      }
    }
    EXPECT_EQ(tiles_with.size(), seams(pyramid, level).size());
    for (const SeamId& seam : seams(pyramid, level)) EXPECT_EQ(tiles_with[seam], 2);
  }
  EXPECT_EQ(seams(pyramid, 0).size(), 3U * 3 + 4 * 2);
  EXPECT_TRUE(seams(pyramid, pyramid.root_level()).empty());
}

TEST(Seams, LieOnTheLastColumnOrRowOfTheirFirstTile) {
  const Pyramid pyramid({200, 150}, 64);
  EXPECT_EQ(samples_of(pyramid, {{0, 1, 2}, true}), (Window{128, 128, 1, 22}));
  EXPECT_EQ(samples_of(pyramid, {{0, 3, 0}, false}), (Window{192, 64, 8, 1}));
  EXPECT_EQ(both_sides(pyramid, {{0, 3, 0}, false}), (Window{192, 0, 8, 129}));
}

TEST(Seams, ComeBackFromTheirFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "some.seam";
  write_finished_seam({{{3, 64}, {2, 64}, {2, 64}}, {{5, 64}, {7, 64}, {6, 64}, 812.5}}, file);
  const SeamChain read = read_finished_seam(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1].from, (hierarchy::BorderPlace{5, 64}));
  EXPECT_EQ(read[1].onto, (hierarchy::BorderPlace{7, 64}));
  EXPECT_EQ(read[1].at, (hierarchy::BorderPlace{6, 64}));
  EXPECT_EQ(read[1].height_m, 812.5);
  EXPECT_TRUE(std::isnan(read[0].height_m));
}

TEST(Seams, ADamagedFileIsAnInputErrorThatNamesIt) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "some.seam";
  write_finished_seam({{{3, 64}, {2, 64}, {2, 64}}}, file);
  const std::string whole = testing::content_of(file);
  for (const std::string& damaged : {whole.substr(0, whole.size() - 1), "x" + whole}) {
    write_whole_file(file, damaged);
    try {
      read_finished_seam(file);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("some.seam"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace terrane::tiler
