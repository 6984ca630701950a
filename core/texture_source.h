#pragma once

#include <string>

#include "core/height_grid.h"

namespace terrane {

/// A picture that is laid over a DEM, cut tile by tile.
class TextureSource {
 public:
  virtual ~TextureSource() = default;

  /// Texels that the picture itself has along a cell of the DEM; more are made up.
  virtual double texels_per_cell() const = 0;

  /// "image/jpeg" or "image/webp".
  virtual const std::string& media_type() const = 0;

  /// Different for different pictures and ways to store them.
  virtual const std::string& fingerprint() const = 0;

  /// The part over some samples as a file: the middle of the first texel of the first row stands on
  /// the first sample, that of the last one of the last row on the last sample. So two windows
  /// with a common border have equal texels there, if they have as many.
  ///
  /// Thread-safe. The same arguments give the same bytes.
  /// \param columns_px, rows_px  texels, 2 or more.
  /// \throws InputError if the picture cannot be read.
  virtual std::string cut(const Window& samples, int columns_px, int rows_px) const = 0;
};

}  // namespace terrane
