#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/height_source.h"
#include "core/loose_samples.h"
#include "hierarchy/mesh/grid_triangles.h"

namespace terrane::tiler {

/// What is behind a reduced reference (reference.h): nothing, or all samples or slabs of them. In
/// that case it can do with fewer, as it learns those that it needs.
enum class Behind : std::uint8_t { kNothing, kAllSamples };

/// The samples under a mesh (a tile or a strip along a seam) and of a margin around it, read patch
/// by patch: memory does not grow with their number.
///
/// Few samples are one patch, and read once.
class TileSamples {
 public:
  /// \param window           columns and rows of the DEM.
  /// \param margin           samples that every patch holds beyond its own, as far as the DEM goes.
  /// \param input_triangles  of the mesh that is to be simplified over them.
  /// \param loose            what lies between them; null: nothing.
  /// \param behind           the reduced reference, if there are no loose ones.
  TileSamples(const HeightSource& heights, const Window& window, std::int64_t margin,
              std::size_t input_triangles, const LooseSamples* loose = nullptr,
              Behind behind = Behind::kNothing);

  const Window& window() const { return window_; }

  /// Cells along a block of the reduced reference: a power of two, the smallest that leaves not too
  /// many samples, and at least some to each input triangle; 1 where every sample is kept.
  std::int64_t block_cells() const { return block_cells_; }
  /// Patches begin at multiples of this many blocks.
  static constexpr std::int64_t kBlocksPerTrend = 4;

  std::size_t patch_count() const { return patches_.size(); }

  /// Calls visit(number, patch, grid) once for each patch, several at a time; grid holds the patch
  /// and its margin. Patches cover the tile and share no sample.
  /// \throws InputError if the file cannot be read.
  void for_each_patch(
      const std::function<void(std::size_t, const Window&, const HeightGrid&)>& visit) const;

  /// Samples for each input triangle.
  double samples_per_triangle() const;

  bool has_loose() const { return loose_ != nullptr; }
  /// What is to be behind the reference; nothing where there are loose samples.
  Behind behind() const { return behind_; }

  /// The loose samples of a patch, and of \p margin cells around it; columns and rows count from
  /// the tile's first sample.
  std::vector<LooseSample> loose_in(const Window& patch, std::int64_t margin) const;

  /// Heights in metres of some samples of the tile.
  std::vector<double> heights_m(std::span<const hierarchy::SampleId> samples) const;

  /// The number of the patch that a sample of the DEM is in; of the nearest if it is beside the
  /// tile.
  std::size_t patch_of(std::int64_t column, std::int64_t row) const;

  /// All samples at once.
  /// \pre patch_count() == 1
  const HeightGrid& whole() const { return *whole_; }

 private:
  HeightGrid read(const Window& patch) const;

  const HeightSource& heights_;
  const LooseSamples* loose_;
  Window window_;
  std::int64_t margin_;
  std::size_t input_triangles_;
  Behind behind_;
  std::int64_t block_cells_;
  std::int64_t patch_columns_ = 0, patch_rows_ = 0, patches_along_row_ = 0;
  std::vector<Window> patches_;
  std::optional<HeightGrid> whole_;
};

}  // namespace terrane::tiler
