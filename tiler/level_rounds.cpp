#include "tiler/level_rounds.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <system_error>

#include "tiler/seams/build_seam.h"

namespace terrane::tiler {

void LevelRounds::build(int level, const std::string& name,
                        const std::function<void(const TileId&)>& build_tile) const {
  const std::vector<TileId> tiles = source_.pyramid.tiles(level);
  const std::vector<SeamId> seams = tiler::seams(source_.pyramid, level);
  progress_.begin(name, static_cast<std::int64_t>(tiles.size() + seams.size()));
  // all seams before any tile: a tile needs its own, and takes away what its seams are made from
  for_each(seams, [&](const SeamId& seam) {
    if (!is_done(seam)) build_seam(seam);
  });
  for_each(longest_first(tiles), [&](const TileId& tile) {
    if (!is_done(tile)) build_tile(tile);
  });
  folder_.forget_seams(level);
}

std::vector<TileId> LevelRounds::longest_first(std::vector<TileId> tiles) const {
  constexpr std::size_t kFew = 64;
  if (tiles.size() > kFew) return tiles;
  std::ranges::stable_sort(tiles, std::greater(),
                           [&](const TileId& tile) { return input_bytes(tile); });
  return tiles;
}

std::uintmax_t LevelRounds::input_bytes(const TileId& tile) const {
  std::uintmax_t bytes = 0;
  for (const TileId& child : source_.pyramid.children(tile)) {
    std::error_code none;  // it may be done with
    const std::uintmax_t size = std::filesystem::file_size(folder_.finished_tile(child), none);
    if (!none) bytes += size;
  }
  return bytes;
}

template <class Item, class Work>
void LevelRounds::for_each(const std::vector<Item>& items, const Work& work) const {
  tbb::task_arena arena(jobs_);
  std::atomic<std::size_t> next = 0;
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, items.size(),
        [&](std::size_t) {
          work(items[next++]);
          progress_.advance(1);
        },
        tbb::simple_partitioner());
  });
}

bool LevelRounds::is_done(const SeamId& seam) const {
  return std::filesystem::exists(folder_.finished_seam(seam)) ||
         (is_done(seam.first) && is_done(seam.second()));
}

bool LevelRounds::is_done(const TileId& tile) const {
  if (static_cast<std::size_t>(tile.level) >= tolerance_m_.size()) return false;
  return std::filesystem::exists(folder_.finished_tile(tile)) ||
         is_done(source_.pyramid.parent(tile));
}

void LevelRounds::build_seam(const SeamId& seam) const {
  const double tolerance_m = tolerance_m_[static_cast<std::size_t>(seam.first.level)];
  SeamChain chain;
  if (seam.first.level == 0) {
    chain = build_leaf_seam(source_, seam, tolerance_m);
  } else {
    std::vector<TileMesh> beside;
    for (const TileId& tile : tiles_beside(source_.pyramid, seam)) {
      beside.push_back(read_finished_tile(folder_.finished_tile(tile)).mesh);
    }
    chain = build_parent_seam(source_, seam, beside, tolerance_m);
  }
  write_finished_seam(chain, folder_.finished_seam(seam));
}

std::vector<SeamChain> LevelRounds::seams_of_tile(const TileId& tile) const {
  std::vector<SeamChain> chains;
  for (const SeamId& seam : seams_of(source_.pyramid, tile)) {
    chains.push_back(read_finished_seam(folder_.finished_seam(seam)));
  }
  return chains;
}

FinishedChildren LevelRounds::children_of(const TileId& tile) const {
  FinishedChildren children{.tiles = source_.pyramid.children(tile)};
  for (const TileId& child : children.tiles) {
    FinishedTile read = read_finished_tile(folder_.finished_tile(child));
    children.meshes.push_back(std::move(read.mesh));
    children.descendants.push_back(std::move(read.descendants));
  }
  return children;
}

void LevelRounds::keep(const TileId& tile, const FinishedTile& finished,
                       const std::vector<TileId>& children) const {
  write_finished_tile(finished, folder_.finished_tile(tile));
  for (const TileId& child : children) std::filesystem::remove(folder_.finished_tile(child));
}

}  // namespace terrane::tiler
