#include "tiler/tile/height_cache.h"

#include <algorithm>

namespace terrane::tiler {
namespace {

constexpr std::int64_t kSide = 256;  // samples

std::int64_t squares_along(std::int64_t samples) { return (samples + kSide - 1) / kSide; }

/// Copies what two grids share into one of them.
void copy_common(const HeightGrid& from, HeightGrid& to) {
  const Window &a = from.window, &b = to.window;
  const std::int64_t first_column = std::max(a.column, b.column);
  const std::int64_t end_column = std::min(a.column + a.columns, b.column + b.columns);
  const std::int64_t first_row = std::max(a.row, b.row);
  const std::int64_t end_row = std::min(a.row + a.rows, b.row + b.rows);
  for (std::int64_t row = first_row; row < end_row; ++row) {
    const float* begin =
        from.heights_m.data() + (row - a.row) * a.columns + first_column - a.column;
    std::copy_n(begin, end_column - first_column,
                to.heights_m.data() + (row - b.row) * b.columns + first_column - b.column);
  }
}

}  // namespace

/// A square of samples, and who reads it.
struct HeightCache::Square {
  std::shared_ptr<const HeightGrid> grid;  // null: not kept
  std::shared_ptr<std::mutex> reading = std::make_shared<std::mutex>();
  std::list<std::size_t>::iterator place;  // in kept_, if kept
};

HeightCache::HeightCache(const HeightSource& source, std::int64_t most_samples)
    : source_(source),
      most_squares_(
          static_cast<std::size_t>(std::max<std::int64_t>(1, most_samples / kSide / kSide))),
      squares_along_row_(squares_along(source.shape().columns)),
      squares_(static_cast<std::size_t>(squares_along_row_ * squares_along(source.shape().rows))) {}

HeightCache::~HeightCache() = default;

Window HeightCache::window_of(std::size_t number) const {
  const std::int64_t column = static_cast<std::int64_t>(number) % squares_along_row_ * kSide;
  const std::int64_t row = static_cast<std::int64_t>(number) / squares_along_row_ * kSide;
  const GridShape all = source_.shape();
  return {column, row, std::min(kSide, all.columns - column), std::min(kSide, all.rows - row)};
}

std::shared_ptr<const HeightGrid> HeightCache::square(std::size_t number) const {
  std::unique_lock lock(mutex_);
  Square& square = squares_[number];
  if (!square.grid) {
    // one thread reads it, and those that want it as well wait
    const std::shared_ptr<std::mutex> reading = square.reading;
    lock.unlock();
    const std::lock_guard is_reading(*reading);
    lock.lock();
    if (!square.grid) {
      lock.unlock();
      auto grid = std::make_shared<const HeightGrid>(source_.read(window_of(number)));
      lock.lock();
      square.grid = std::move(grid);
      square.place = kept_.insert(kept_.begin(), number);
      if (kept_.size() > most_squares_) {
        squares_[kept_.back()].grid.reset();
        kept_.pop_back();
      }
      return square.grid;
    }
  }
  kept_.splice(kept_.begin(), kept_, square.place);
  return square.grid;
}

HeightGrid HeightCache::read(const Window& window) const {
  HeightGrid grid{window, {}};
  grid.heights_m.resize(static_cast<std::size_t>(window.columns * window.rows));
  for (std::int64_t row = window.row / kSide; row * kSide < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column / kSide;
         column * kSide < window.column + window.columns; ++column) {
      copy_common(*square(static_cast<std::size_t>(row * squares_along_row_ + column)), grid);
    }
  }
  return grid;
}

}  // namespace terrane::tiler
