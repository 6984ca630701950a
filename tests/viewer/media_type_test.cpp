#include "viewer/server/media_type.h"

#include <gtest/gtest.h>

namespace terrane::viewer {
namespace {

TEST(MediaTypeOf, KnowsWhatAnOutputFolderHolds) {
  EXPECT_EQ(media_type_of("index.html").name, "text/html; charset=utf-8");
  EXPECT_EQ(media_type_of("assets/viewer.js").name, "text/javascript; charset=utf-8");
  EXPECT_EQ(media_type_of("assets/viewer.css").name, "text/css; charset=utf-8");
  EXPECT_EQ(media_type_of("tileset.json").name, "application/json");
  EXPECT_EQ(media_type_of("tiles/0/1/2.glb").name, "model/gltf-binary");
  EXPECT_EQ(media_type_of("0/0/0.terrain").name, "application/vnd.quantized-mesh");
  EXPECT_EQ(media_type_of("build.toml").name, "text/plain; charset=utf-8");
  EXPECT_EQ(media_type_of("decoder.wasm").name, "application/wasm");
  EXPECT_EQ(media_type_of("bunny.tree").name, "application/vnd.terrane.merge-tree");
  EXPECT_EQ(media_type_of("drape.PNG").name, "image/png");
  EXPECT_EQ(media_type_of("icon.svg").name, "image/svg+xml");
}

TEST(MediaTypeOf, TakesAnUnknownExtensionForPlainBytes) {
  EXPECT_EQ(media_type_of("a.exe").name, "application/octet-stream");
  EXPECT_EQ(media_type_of("json").name, "application/octet-stream");
  EXPECT_FALSE(media_type_of("a.exe").is_compressible);
}

TEST(MediaTypeOf, KnowsArchivesAndNeverCodesThem) {
  EXPECT_EQ(media_type_of("a.pmtiles").name, "application/vnd.pmtiles");
  EXPECT_FALSE(media_type_of("a.pmtiles").varies);
  EXPECT_FALSE(media_type_of("a.3tz").varies);
}

}  // namespace
}  // namespace terrane::viewer
