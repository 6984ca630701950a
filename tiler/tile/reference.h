#pragma once

#include <span>
#include <vector>

#include "hierarchy/collapse/sample_field.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_samples.h"

namespace terrane::tiler {

/// What collapses are held against: every sample, loose ones too; or, where there are very many, of
/// each block of the grid's those that stick out most above and below the trend of the terrain
/// around it, and above and below planes tilted against that; and what it was told to learn.
/// A mesh near those is held against all others, too, or against slabs that hold them if memory
/// does not allow that (CodedHeights, HeightSlabs).
///
/// The trend is a plane over TileSamples::kBlocksPerTrend blocks each way: over the block itself it
/// would follow what is rough in it.
class Reference {
 public:
  /// \param slack_cells     see SampleField.
  /// \param most_in_memory  samples that stay behind those kept, two bytes each; of a tile with
  ///                        more, their slabs do. None do if the samples say so (Behind).
  Reference(const TileSamples& samples, const TileFrame& frame, double slack_cells,
            std::int64_t most_in_memory = kMostInMemory);

  /// 220 MB.
  static constexpr std::int64_t kMostInMemory = 110'000'000;

  /// Heights over the curved datum of the frame.
  const hierarchy::SampleField& field() const { return field_; }

  /// Adds samples that a mesh within the tolerance of the reference was too far from.
  /// \return whether any of them was not held against already.
  bool learn(const std::vector<hierarchy::FieldSample>& samples);

  /// Whether every sample is held against in the end, or a slab that holds it.
  bool is_whole() const { return is_whole_; }

 private:
  hierarchy::SampleField field_;
  std::vector<hierarchy::FieldSample> kept_;  // if the field is reduced: what it holds
  bool is_whole_ = true;
};

/// The moment of a blend at which it is measured in the world; over the grid it is judged at every
/// moment, where nothing is behind a reduced reference by blend_check.h.
inline constexpr double kMeasuredMoment = 0.5;

/// Share of the tolerance beyond which samples are worth learning: they are over it soon.
inline constexpr double kNotedShare = 0.9;

}  // namespace terrane::tiler
