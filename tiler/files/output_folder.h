#pragma once

#include <filesystem>
#include <string>

#include "tiler/tile_id.h"

namespace terrane::tiler {

struct SeamId;

/// Where things lie in an output folder (docs/formats.md).
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path finished_tile(const TileId& tile) const;
  std::filesystem::path finished_seam(const SeamId& seam) const;
  std::filesystem::path tileset() const { return root_ / "tileset.json"; }
  std::filesystem::path summary() const { return root_ / "terrane.json"; }

  /// Makes the folder, or takes it over.
  /// \throws OutputError if it cannot be made, is a file, or holds files but no output of terrane's
  ///         and \p force is not set. Nothing is changed then.
  void claim(bool force) const;

  /// The key of the data set that lies here complete, every tile and tileset with the size that
  /// terrane.json states; empty if there is none.
  std::string finished_key() const;

  /// Keeps the unfinished work of an earlier run if it has the same key; else clears the way:
  /// removes the files of any earlier data set, and of nobody else.
  void begin(const std::string& key) const;

  /// Removes the finished seams of a level.
  void forget_seams(int level) const;

  /// Removes the work folder.
  void end() const;

 private:
  std::filesystem::path work() const { return root_ / ".work"; }

  std::filesystem::path root_;
};

}  // namespace terrane::tiler
