#include "tiler/geodetic/quantized_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tiler/geodetic/grid_lattice.h"

namespace terrane::tiler {
namespace {

/// Two triangles over a whole tile.
TerrainTile square(std::int64_t low, std::int64_t high, double step_m) {
  constexpr auto kEnd = static_cast<std::int32_t>(kTileSteps);
  TerrainTile tile{.tile = {3, 5, 2}, .height_step_m = step_m};
  tile.vertices = {{0, 0, low}, {kEnd, 0, high}, {kEnd, kEnd, low}, {0, kEnd, high}};
  tile.normals.assign(4, Eigen::Vector3f::UnitZ());
  tile.triangles = {{0, 1, 2}, {0, 2, 3}};
  return tile;
}

template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

/// As the specification's reader interpolates.
double decoded(const HeightRange& range, std::int64_t height) {
  const auto q = static_cast<double>((height - range.lowest) * range.per_step);
  const double t = q / static_cast<double>(kTileSteps);
  return (1 - t) * range.min_m + t * range.max_m;
}

TEST(QuantizedMesh, HeightsDecodeToWholeStepsWhateverTheTilesOwnRange) {
  // neighbours with different ranges share the height of 400 steps
  for (const auto& [low, high] : {std::pair{400, 401}, {-3000, 400}, {400, 20000}, {0, 32767}}) {
    const HeightRange range = height_range(square(low, high, 0.125));
    EXPECT_EQ(decoded(range, low), low * 0.125);
    if (low <= 400 && 400 <= high) {
      EXPECT_NEAR(decoded(range, 400), 50, 1e-11);
      EXPECT_EQ(static_cast<float>(decoded(range, 400)), 50.0F);
    }
  }
}

TEST(QuantizedMesh, TheMaximumIsLessThanTwiceAsFarUpAsTheHighestVertex) {
  const HeightRange range = height_range(square(1000, 1700, 0.25));
  EXPECT_EQ(range.min_m, 250);
  EXPECT_GE(range.max_m, 425);
  EXPECT_LT(range.max_m - range.min_m, 2 * 175.01);
}

TEST(QuantizedMesh, AFlatTileHasOneHeight) {
  const HeightRange range = height_range(square(12, 12, 0.5));
  EXPECT_EQ(range.min_m, 6);
  EXPECT_EQ(range.max_m, 6);
}

TEST(QuantizedMesh, IndicesAreCodedFromTheHighestSoFar) {
  const std::string bytes = encode_quantized_mesh(square(0, 100, 1));
  constexpr std::size_t kHeader = 88;
  ASSERT_EQ(at<std::uint32_t>(bytes, kHeader), 4U);
  const std::size_t triangles = kHeader + 4 + 3 * 2 * 4;
  ASSERT_EQ(at<std::uint32_t>(bytes, triangles), 2U);
  // the first triangle uses three new vertices; the second one more
  int news = 0;
  for (std::size_t k = 0; k < 6; ++k) news += at<std::uint16_t>(bytes, triangles + 4 + 2 * k) == 0;
  EXPECT_EQ(news, 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, triangles + 4), 0);
}

TEST(QuantizedMesh, ThirtyTwoBitIndicesBeginOnAMultipleOfFour) {
  TerrainTile tile{.tile = {0, 0, 0}};
  constexpr std::int32_t kSide = 257;  // 66,049 vertices, an odd number
  for (std::int32_t row = 0; row < kSide; ++row) {
    for (std::int32_t column = 0; column < kSide; ++column) {
      tile.vertices.push_back({column * 100, row * 100, 0});
    }
  }
  tile.normals.assign(tile.vertices.size(), Eigen::Vector3f::UnitZ());
  for (std::uint32_t k = 0; k + kSide + 1 < tile.vertices.size(); ++k) {
    if (k % kSide + 1 == kSide) continue;
    tile.triangles.push_back({k, k + 1, k + kSide});
    tile.triangles.push_back({k + 1, k + kSide + 1, k + kSide});
  }
  const std::string bytes = encode_quantized_mesh(tile);
  std::size_t triangles = 88 + 4 + 3 * 2 * tile.vertices.size();
  ASSERT_EQ(triangles % 4, 2U);
  triangles += 2;
  EXPECT_EQ(at<std::uint32_t>(bytes, triangles), tile.triangles.size());
}

TEST(QuantizedMesh, NormalsTakeTwoBytesAVertexAndTheirExtensionSaysSo) {
  const std::string bytes = encode_quantized_mesh(square(0, 100, 1));
  // header, vertices, triangles, four borders of two vertices
  const std::size_t extension = 88 + 4 + 24 + 4 + 12 + 4 * (4 + 4);
  ASSERT_EQ(at<std::uint8_t>(bytes, extension), 1);
  EXPECT_EQ(at<std::uint32_t>(bytes, extension + 1), 8U);
  // the pole's direction is the middle of the square
  EXPECT_EQ(at<std::uint8_t>(bytes, extension + 5), 128);
  EXPECT_EQ(bytes.size(), extension + 5 + 8);
}

}  // namespace
}  // namespace terrane::tiler
