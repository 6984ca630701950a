#include "ingest/fit_posts.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/post_surface.h"

namespace terrane::ingest {
namespace {

constexpr int kPasses = 4;        // over the whole DEM: blocks share posts
constexpr int kSweeps = 8;        // over a block
constexpr double kRelaxed = 0.9;  // of the bound: a sweep ends inside it

class PostFit {
 public:
  PostFit(GDALRasterBand& band, const Window& posts, int zoom, double wanted_m)
      : band_(band),
        posts_(posts),
        around_(GeodeticZoom{zoom}.tiles_around() * kGeodeticTileCells),
        rows_(GeodeticZoom{zoom}.tiles_down() * kGeodeticTileCells + 1),
        wanted_m_(wanted_m) {}

  /// \return whether any post was moved.
  bool fit(const std::vector<LooseSample>& samples) {
    if (samples.empty()) return false;
    places_.clear();
    for (const LooseSample& sample : samples) {
      places_.push_back(on_surface(sample.column, sample.row, rows_));
    }
    read_around();
    bool is_moved = false;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      if (!sweep_over(samples)) break;
      is_moved = true;
    }
    if (is_moved) transfer(GF_Write);
    return is_moved;
  }

 private:
  /// Reads the posts of all the cells.
  void read_around() {
    const auto [left, right] = std::ranges::minmax(places_, {}, &PlaceOnSurface::column);
    const auto [top, bottom] = std::ranges::minmax(places_, {}, &PlaceOnSurface::row);
    window_ = {left.column, top.row, right.column + 2 - left.column, bottom.row + 2 - top.row};
    heights_m_.resize(static_cast<std::size_t>(window_.columns * window_.rows));
    transfer(GF_Read);
  }

  bool sweep_over(const std::vector<LooseSample>& samples) {
    bool is_moved = false;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto& share = places_[i].share;
      const std::size_t first = index_of(places_[i]);
      const auto width = static_cast<std::size_t>(window_.columns);
      const std::array<std::size_t, 4> corner{first, first + width, first + width + 1, first + 1};
      double on_surface_m = 0, squares = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        on_surface_m += share[k] * heights_m_[corner[k]];
        squares += share[k] * share[k];
      }
      const double off_m = samples[i].height_m - on_surface_m;
      if (!(std::abs(off_m) > wanted_m_)) continue;
      is_moved = true;
      const double step_m = off_m - std::copysign(kRelaxed * wanted_m_, off_m);
      for (std::size_t k = 0; k < 4; ++k) {
        heights_m_[corner[k]] += static_cast<float>(step_m * share[k] / squares);
      }
    }
    return is_moved;
  }

  std::size_t index_of(const PlaceOnSurface& place) const {
    return static_cast<std::size_t>((place.row - window_.row) * window_.columns + place.column -
                                    window_.column);
  }

  /// Reads or writes the window: in two parts where it crosses the band's end.
  void transfer(GDALRWFlag flag) {
    for (std::int64_t done = 0; done < window_.columns;) {
      const std::int64_t beyond = window_.column + done - posts_.column;
      const std::int64_t from = (beyond % around_ + around_) % around_;
      // the column that is there twice is read where the band begins
      const std::int64_t count =
          std::min(window_.columns - done, std::min(posts_.columns, around_) - from);
      if (count <= 0) throw_failed();
      if (band_.RasterIO(
              flag, static_cast<int>(from), static_cast<int>(window_.row - posts_.row),
              static_cast<int>(count), static_cast<int>(window_.rows), heights_m_.data() + done,
              static_cast<int>(count), static_cast<int>(window_.rows), GDT_Float32, 0,
              window_.columns * static_cast<GSpacing>(sizeof(float)), nullptr) != CE_None) {
        throw_failed();
      }
      done += count;
    }
  }

  [[noreturn]] static void throw_failed() {
    throw InputError(fmt::format("the resampled posts cannot be read or written ({}). Build again",
                                 CPLGetLastErrorMsg()));
  }

  GDALRasterBand& band_;
  Window posts_;
  std::int64_t around_, rows_;
  double wanted_m_;
  std::vector<PlaceOnSurface> places_;
  Window window_;
  std::vector<float> heights_m_;
};

/// Once round the Earth, the last column is the first one.
void close(GDALRasterBand& band, const Window& posts, int zoom) {
  if (posts.columns <= GeodeticZoom{zoom}.tiles_around() * kGeodeticTileCells) return;
  const int rows = static_cast<int>(posts.rows);
  std::vector<float> column(static_cast<std::size_t>(rows));
  if (band.RasterIO(GF_Read, 0, 0, 1, rows, column.data(), 1, rows, GDT_Float32, 0, 0, nullptr) !=
          CE_None ||
      band.RasterIO(GF_Write, static_cast<int>(posts.columns) - 1, 0, 1, rows, column.data(), 1,
                    rows, GDT_Float32, 0, 0, nullptr) != CE_None) {
    throw InputError("the resampled posts cannot be read or written. Build again");
  }
}

}  // namespace

void fit_posts(GDALRasterBand& band, const Window& posts, const DemSamples& samples, int zoom,
               double wanted_m) {
  PostFit fit(band, posts, zoom, wanted_m);
  bool is_moved = true;
  for (int pass = 0; is_moved && pass < kPasses; ++pass) {
    is_moved = false;
    for (std::size_t k = 0; k < samples.block_count(); ++k) {
      is_moved = fit.fit(samples.block(k)) || is_moved;
    }
  }
  close(band, posts, zoom);
}

}  // namespace terrane::ingest
