#include "tiler/seams/seam.h"

#include "tiler/files/work_file.h"

namespace terrane::tiler {
namespace {

constexpr std::uint64_t kMagic = 0x346d616573727274;  // "trrseam4"

bool holds(const Pyramid& pyramid, const TileId& tile) {
  return tile.x >= 0 && tile.y >= 0 && pyramid.holds(tile);
}

}  // namespace

std::string path_of(const SeamId& seam) {
  return path_of(seam.first) + (seam.is_column ? "/right" : "/below");
}

std::vector<SeamId> seams(const Pyramid& pyramid, int level) {
  std::vector<SeamId> result;
  for (const TileId& tile : pyramid.tiles(level)) {
    for (const bool is_column : {true, false}) {
      const SeamId seam{tile, is_column};
      if (holds(pyramid, seam.second())) result.push_back(seam);
    }
  }
  return result;
}

std::vector<SeamId> seams_of(const Pyramid& pyramid, const TileId& tile) {
  const TileId left{tile.level, tile.x - 1, tile.y}, above{tile.level, tile.x, tile.y - 1};
  std::vector<SeamId> result;
  for (const SeamId& seam :
       {SeamId{left, true}, SeamId{above, false}, SeamId{tile, true}, SeamId{tile, false}}) {
    if (holds(pyramid, seam.first) && holds(pyramid, seam.second())) result.push_back(seam);
  }
  return result;
}

Window samples_of(const Pyramid& pyramid, const SeamId& seam) {
  Window line = pyramid.window(seam.second());
  (seam.is_column ? line.columns : line.rows) = 1;
  return line;
}

Window both_sides(const Pyramid& pyramid, const SeamId& seam) {
  Window both = pyramid.window(seam.first);
  const Window second = pyramid.window(seam.second());
  if (seam.is_column) {
    both.columns += second.columns - 1;
  } else {
    both.rows += second.rows - 1;
  }
  return both;
}

void write_finished_seam(const SeamChain& chain, const std::filesystem::path& file) {
  WorkFileWriter writer;
  writer.add(kMagic);
  writer.add(chain);
  writer.write(file);
}

SeamChain read_finished_seam(const std::filesystem::path& file) {
  WorkFileReader reader(file);
  if (reader.get<std::uint64_t>() != kMagic) reader.refuse();
  return reader.get_vector<SeamVertex>();
}

}  // namespace terrane::tiler
