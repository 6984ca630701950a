#include "tiler/geodetic/layer_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace terrane::tiler {
namespace {

using nlohmann::json;

TEST(LayerJson, CountsRowsFromTheSouth) {
  // zoom 2, third row of four from the north
  const json layer =
      json::parse(layer_json({.available = {{0, 0, 0, 2, 1}, {1, 1, 1, 1, 1}, {2, 2, 2, 1, 1}}}));
  EXPECT_EQ(layer["scheme"], "tms");
  EXPECT_EQ(layer["available"][0], json::parse(R"([{"startX":0,"startY":0,"endX":1,"endY":0}])"));
  EXPECT_EQ(layer["available"][2], json::parse(R"([{"startX":2,"startY":1,"endX":2,"endY":1}])"));
  EXPECT_EQ(layer["bounds"], json::parse("[-90,-45,-45,0]"));
}

TEST(LayerJson, TilesAcross180DegreesAreTwoRanges) {
  const json layer = json::parse(layer_json({.available = {{0, 0, 0, 2, 1}, {1, 3, 0, 2, 1}}}));
  EXPECT_EQ(layer["available"][1], json::parse(R"([{"startX":0,"startY":1,"endX":0,"endY":1},
                                                   {"startX":3,"startY":1,"endX":3,"endY":1}])"));
  EXPECT_EQ(layer["bounds"], json::parse("[-180,0,180,90]"));
}

TEST(LayerJson, MetadataListsWhatIsBelowATileAndNoOthers) {
  const std::vector<GeodeticTiles> available{{0, 0, 0, 2, 1}, {1, 1, 0, 2, 1}};
  EXPECT_EQ(json::parse(tile_metadata({0, 0, 0}, available))["available"],
            json::parse(R"([[{"startX":1,"startY":1,"endX":1,"endY":1}]])"));
  EXPECT_EQ(json::parse(tile_metadata({0, 1, 0}, available))["available"],
            json::parse(R"([[{"startX":2,"startY":1,"endX":2,"endY":1}]])"));
  EXPECT_EQ(tile_metadata({1, 1, 1}, available), "");
}

}  // namespace
}  // namespace terrane::tiler
