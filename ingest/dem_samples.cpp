#include "ingest/dem_samples.h"

#include <algorithm>
#include <cmath>

namespace terrane::ingest {
namespace {

// so few that a tile of 64 x 64 posts needs little more than it holds
constexpr std::int64_t kBlock = 32;

/// The samples along the four sides of a window, once around.
std::vector<GridPosition> around(const Window& w) {
  const auto left = static_cast<double>(w.column), top = static_cast<double>(w.row);
  const auto right = static_cast<double>(w.column + w.columns - 1);
  const auto bottom = static_cast<double>(w.row + w.rows - 1);
  std::vector<GridPosition> result;
  for (double c = left; c <= right; ++c) result.push_back({c, top});
  for (double r = top; r <= bottom; ++r) result.push_back({right, r});
  for (double c = right; c >= left; --c) result.push_back({c, bottom});
  for (double r = bottom; r >= top; --r) result.push_back({left, r});
  return result;
}

}  // namespace

DemSamples::DemSamples(const Dem& dem, int zoom, const Geoid* geoid)
    : dem_(dem),
      geoid_(geoid),
      zoom_{zoom},
      around_(static_cast<double>(zoom_.tiles_around() * kGeodeticTileCells)) {
  const GridShape shape = dem.heights().shape();
  for (std::int64_t row = 0; row < shape.rows; row += kBlock) {
    for (std::int64_t column = 0; column < shape.columns; column += kBlock) {
      blocks_.push_back(bounds_of({column, row, std::min(kBlock, shape.columns - column),
                                   std::min(kBlock, shape.rows - row)}));
    }
  }
}

std::vector<GridPosition> DemSamples::posts_of(const std::vector<LonLat>& places) const {
  std::vector<GridPosition> posts;
  posts.reserve(places.size());
  for (const LonLat& place : places) {
    GridPosition post{(place.longitude_deg + 180) / zoom_.cell_deg(),
                      (90 - place.latitude_deg) / zoom_.cell_deg()};
    if (!posts.empty()) {
      // no jump from one to the next
      const double before = posts.back().column;
      post.column = before + std::remainder(post.column - before, around_);
    }
    posts.push_back(post);
  }
  return posts;
}

DemSamples::Block DemSamples::bounds_of(const Window& window) const {
  const std::vector<GridPosition> posts = posts_of(dem_.place().to_lon_lat(around(window)));
  const auto [left, right] = std::ranges::minmax(posts, {}, &GridPosition::column);
  const auto [top, bottom] = std::ranges::minmax(posts, {}, &GridPosition::row);
  // what bulges out between the samples of a side
  constexpr double kRoom = 1;
  Block block{window, left.column - kRoom, right.column + kRoom, top.row - kRoom,
              bottom.row + kRoom};
  if (std::abs(posts.back().column - posts.front().column) < around_ / 2) return block;
  // once around a pole, which lies inside
  block.left = 0;
  block.right = around_;
  const bool is_north = top.row + bottom.row < around_ / 2;
  (is_north ? block.top : block.bottom) = is_north ? 0 : around_ / 2;
  return block;
}

std::vector<LooseSample> DemSamples::block(std::size_t k) const {
  const Window& w = blocks_[k].window;
  const HeightGrid grid = dem_.heights().read(w);
  std::vector<GridPosition> samples;
  for (std::int64_t row = w.row; row < w.row + w.rows; ++row) {
    for (std::int64_t column = w.column; column < w.column + w.columns; ++column) {
      if (!grid.has_data(column, row)) continue;
      samples.push_back({static_cast<double>(column), static_cast<double>(row)});
    }
  }
  if (samples.empty()) return {};
  const std::vector<LonLat> places = dem_.place().to_lon_lat(samples);
  const std::vector<GridPosition> posts = posts_of(places);
  std::vector<LooseSample> result;
  result.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double height_m = grid.at(static_cast<std::int64_t>(samples[i].column),
                                    static_cast<std::int64_t>(samples[i].row));
    const double undulation_m = geoid_ == nullptr ? 0 : geoid_->undulation_m(places[i]);
    result.push_back({posts[i].column, posts[i].row, height_m + undulation_m});
  }
  return result;
}

std::vector<LooseSample> DemSamples::in(const Window& posts) const {
  const auto left = static_cast<double>(posts.column), top = static_cast<double>(posts.row);
  const double right = left + static_cast<double>(posts.columns - 1);
  const double bottom = top + static_cast<double>(posts.rows - 1);
  std::vector<LooseSample> result;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& b = blocks_[k];
    if (b.bottom < top || b.top > bottom) continue;
    // turns of the Earth that bring the block's first column to the window's or beyond
    double turn = std::ceil((left - b.right) / around_) * around_;
    if (b.left + turn > right) continue;
    const std::vector<LooseSample> samples = block(k);
    for (; b.left + turn <= right; turn += around_) {
      for (const LooseSample& sample : samples) {
        const double column = sample.column + turn;
        if (column < left || column > right || sample.row < top || sample.row > bottom) continue;
        result.push_back({column, sample.row, sample.height_m});
      }
    }
  }
  return result;
}

}  // namespace terrane::ingest
