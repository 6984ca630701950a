#include "archive/tile_path.h"

#include <gtest/gtest.h>

namespace terrane::archive {
namespace {

TEST(ParseTileName, ReadsTheThreeNumbersAtTheEnd) {
  const auto name = parse_tile_name("tiles/2/31/7.glb");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->before, "tiles/");
  EXPECT_EQ(name->extension, ".glb");
  EXPECT_EQ(name->numbers.level, 2u);
  EXPECT_EQ(name->numbers.x, 31u);
  EXPECT_EQ(name->numbers.y, 7u);
  EXPECT_EQ(parse_tile_name("0/0/0.terrain")->before, "");
  EXPECT_EQ(parse_tile_name("a/b/0/1/2.tar.gz")->extension, ".tar.gz");
}

TEST(ParseTileName, RefusesOtherNames) {
  for (const char* name :
       {"", "tileset.json", "1/2.glb", "a/1/2.glb", "1/2/a.glb", "1/2/3", "1/2/3.", "01/2/3.glb",
        "1/2/03.glb", "-1/2/3.glb", "1/2/99999999999.glb"}) {
    EXPECT_FALSE(parse_tile_name(name)) << name;
  }
}

TEST(TilePath, GoesThereAndBack) {
  const TilePath path("tiles/", ".glb", 3, -1);
  EXPECT_EQ(path.pattern(), "tiles/{l}/{x}/{y}.glb");
  EXPECT_EQ(path.place_of("tiles/0/7/5.glb"), (ZoomTile{3, 7, 5}));
  EXPECT_EQ(path.place_of("tiles/3/0/0.glb"), (ZoomTile{0, 0, 0}));
  EXPECT_EQ(path.name_of({3, 7, 5}), "tiles/0/7/5.glb");
  const auto parsed = TilePath::parse(path.pattern(), 3, -1);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->name_of({0, 0, 0}), "tiles/3/0/0.glb");
}

TEST(TilePath, KnowsNoPlaceOutsideTheQuadtree) {
  const TilePath path("tiles/", ".glb", 3, -1);
  for (const char* name : {"tiles/0/8/0.glb", "tiles/4/0/0.glb", "tiles/3/1/0.glb", "0/0/0.glb",
                           "tiles/0/0/0.png", "tiles/0/0/0"}) {
    EXPECT_FALSE(path.place_of(name)) << name;
  }
  EXPECT_FALSE(path.name_of({4, 0, 0}));
}

TEST(TilePath, RefusesPatternsWithoutNumbers) {
  EXPECT_FALSE(TilePath::parse("tiles/{z}/{x}/{y}.glb", 0, 1));
  EXPECT_FALSE(TilePath::parse("{l}/{x}/{y}.glb", 0, 2));
  EXPECT_FALSE(TilePath::parse("{l}/{x}/{y}.glb", 99, 1));
}

}  // namespace
}  // namespace terrane::archive
