#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "tiler/build_tile.h"
#include "tiler/files/mesh_file.h"
#include "tiler/files/output_folder.h"

namespace terrane::tiler {

/// The tiles of a level's children as the work folder has them.
struct FinishedChildren {
  std::vector<TileId> tiles;
  std::vector<TileMesh> meshes;
  std::vector<std::vector<TileRecord>> descendants;  ///< of each
};

/// The two rounds that every level is built in: its seams, then its tiles. What is under way lies
/// in the work folder; a build that was killed goes on from there.
///
/// Guarantee: the items of a round are independent, so any number of threads gives the same bytes.
class LevelRounds {
 public:
  /// All must outlive the rounds.
  /// \param tolerance_m  of each level, the finest first; there are as many levels.
  LevelRounds(const TileSource& source, const OutputFolder& folder,
              const std::vector<double>& tolerance_m, int jobs, Progress& progress)
      : source_(source),
        folder_(folder),
        tolerance_m_(tolerance_m),
        jobs_(jobs),
        progress_(progress) {}

  /// Builds what is not there yet of a level.
  ///
  /// \param name  of the level, for the user.
  /// \param tile  builds one tile and puts it into the work folder; called from several threads.
  void build(int level, const std::string& name,
             const std::function<void(const TileId&)>& tile) const;

  /// What became of a tile's seams.
  std::vector<SeamChain> seams_of_tile(const TileId& tile) const;

  FinishedChildren children_of(const TileId& tile) const;

  /// Puts a tile into the work folder and takes its children away, which are in it.
  void keep(const TileId& tile, const FinishedTile& finished,
            const std::vector<TileId>& children) const;

 private:
  /// Few tiles in an order in which threads end together; many as they are, as neighbours read the
  /// same heights.
  std::vector<TileId> longest_first(std::vector<TileId> tiles) const;
  std::uintmax_t input_bytes(const TileId& tile) const;

  bool is_done(const SeamId& seam) const;
  bool is_done(const TileId& tile) const;
  void build_seam(const SeamId& seam) const;
  /// Takes the items one after the other, whichever thread is free.
  template <class Item, class Work>
  void for_each(const std::vector<Item>& items, const Work& work) const;

  const TileSource& source_;
  const OutputFolder& folder_;
  const std::vector<double>& tolerance_m_;
  int jobs_;
  Progress& progress_;
};

}  // namespace terrane::tiler
