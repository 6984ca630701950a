#include "tiler/gltf/cut_texture.h"

#include <gtest/gtest.h>

namespace terrane::tiler {
namespace {

/// Says how many texels it was asked for.
class CountedTexels final : public TextureSource {
 public:
  double texels_per_cell() const override { return 2; }
  const std::string& media_type() const override { return type_; }
  const std::string& fingerprint() const override { return type_; }
  std::string cut(const Window&, int columns_px, int rows_px) const override {
    return std::to_string(columns_px) + " x " + std::to_string(rows_px);
  }

 private:
  std::string type_ = "image/jpeg";
};

TEST(CutTexture, HasATexelOnEachBorder) {
  // 65 samples, 64 cells: half a cell wide, texels 0, 0.5, ... 64
  EXPECT_EQ(cut_texture(std::make_unique<CountedTexels>().get(), {0, 0, 65, 33}, 0.5).bytes,
            "129 x 65");
}

TEST(CutTexture, HasNoMoreTexelsThanThePictureItself) {
  const CountedTexels source;
  EXPECT_EQ(cut_texture(&source, {0, 0, 65, 65}, 0.01).bytes, "129 x 129");
}

TEST(CutTexture, IsNotThereWithoutASource) {
  EXPECT_FALSE(cut_texture(nullptr, {0, 0, 65, 65}, 1).is_there());
}

TEST(TileTexture, OutermostSamplesAreInTheMiddleOfOutermostTexels) {
  const TileTexture texture{.bytes = "x", .columns_px = 5, .rows_px = 3, .window = {64, 64, 9, 5}};
  EXPECT_FLOAT_EQ(texture.place_of({.column = 0, .row = 0}).x(), 0.1F);
  EXPECT_FLOAT_EQ(texture.place_of({.column = 8, .row = 0}).x(), 0.9F);
  EXPECT_FLOAT_EQ(texture.place_of({.column = 4, .row = 4}).x(), 0.5F);
  EXPECT_FLOAT_EQ(texture.place_of({.column = 4, .row = 4}).y(), 2.5F / 3);
}

}  // namespace
}  // namespace terrane::tiler
