#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "core/height_source.h"

namespace terrane::tiler {

/// A DEM whose heights are kept once they were read, square by square, as long as they are not too
/// many: a build asks for each a few times at every level.
///
/// The heights are those of the source, whatever is kept. Thread-safe.
class HeightCache final : public HeightSource {
 public:
  /// \param source        read window by window; must outlive the cache.
  /// \param most_samples  that are kept at a time, four bytes each; those asked for last.
  HeightCache(const HeightSource& source, std::int64_t most_samples);
  ~HeightCache() override;

  GridShape shape() const override { return source_.shape(); }
  HeightGrid read(const Window& window) const override;

 private:
  struct Square;

  std::shared_ptr<const HeightGrid> square(std::size_t number) const;
  Window window_of(std::size_t number) const;

  const HeightSource& source_;
  std::size_t most_squares_;
  std::int64_t squares_along_row_;
  mutable std::mutex mutex_;  // of all below, but not held while the source is read
  mutable std::vector<Square> squares_;
  mutable std::list<std::size_t> kept_;  // those asked for last come first
};

}  // namespace terrane::tiler
