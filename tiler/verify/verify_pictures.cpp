#include "tiler/verify/verify_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/errors.h"
#include "tiler/verify/picture_heights.h"
#include "tiler/verify/picture_set.h"

namespace terrane::verify {
namespace {

constexpr std::size_t kMostLines = 100;

class Verification {
 public:
  Verification(PictureSet set, double fill_m)
      : set_(std::move(set)), fill_m_(set_.stored_m(fill_m)) {
    for (int zoom = 0; zoom <= set_.finest(); ++zoom) report_.zooms.push_back({.zoom = zoom});
    for (const std::string& fault : set_.faults) note(0, PictureFault::kMisstated, 1, fault);
  }

  void check_files(Progress& progress) {
    find_unexpected();
    progress.begin("verifying pictures", set_.finest() + 1);
    for (int zoom = 0; zoom <= set_.finest(); ++zoom) {
      for (const PictureKey& key : set_.wanted(zoom)) check_tile(key);
      check_stated(zoom);
      progress.advance(1);
    }
  }

  void check_errors(const PictureErrors& errors) {
    PictureZoomReport& finest = report_.zooms.back();
    finest.pixels = errors.pixels;
    finest.max_difference_m = errors.max_m;
    if (errors.pixels > 0) {
      finest.rms_difference_m =
          std::sqrt(errors.square_sum_m2 / static_cast<double>(errors.pixels));
    }
    if (errors.off == 0) return;
    note(set_.finest(), PictureFault::kOffDem, errors.off,
         fmt::format("{} ({} pixels in all)", errors.worst_place, errors.off));
  }

  PictureReport take() { return std::move(report_); }

 private:
  void note(int zoom, PictureFault fault, std::int64_t count, std::string what) {
    report_.zooms[static_cast<std::size_t>(zoom)].faults[static_cast<std::size_t>(fault)] += count;
    if (report_.problems.size() < kMostLines) {
      report_.problems.push_back(std::move(what));
    } else {
      ++report_.problems_left_out;
    }
  }

  void find_unexpected() {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(set_.folder)) {
      if (!entry.is_regular_file() || entry.path().extension() != ".png") continue;
      const auto path = entry.path().lexically_relative(set_.folder).generic_string();
      PictureKey key;
      long long x = 0, y = 0;
      int end = 0;
      const bool is_tile =
          std::sscanf(path.c_str(), "%d/%lld/%lld.png%n", &key.zoom, &x, &y, &end) == 3 &&
          end == static_cast<int>(path.size());
      key.x = x, key.y = y;
      if (is_tile && set_.may_have(key)) continue;
      const bool is_of_a_zoom = is_tile && key.zoom >= 0 && key.zoom <= set_.finest();
      note(is_of_a_zoom ? key.zoom : 0, PictureFault::kUnexpected, 1,
           fmt::format("{}: lies beside the bounds", path));
    }
  }

  /// None if it is missing or unreadable.
  std::optional<std::vector<double>> heights_at(const PictureKey& key) const {
    try {
      const Picture picture = read_png(set_.file_of(key));
      if (picture.side_px != set_.tile_px) return std::nullopt;
      return set_.heights_of(picture);
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  void check_tile(const PictureKey& key) {
    PictureZoomReport& zoom = report_.zooms[static_cast<std::size_t>(key.zoom)];
    if (!std::filesystem::exists(set_.file_of(key))) {
      note(key.zoom, PictureFault::kMissing, 1, to_string(key) + ": there is no file");
      return;
    }
    try {
      const Picture picture = read_png(set_.file_of(key));
      ++zoom.tiles;
      zoom.bytes += picture.bytes;
      if (picture.side_px != set_.tile_px) {
        note(key.zoom, PictureFault::kUnreadable, 1,
             fmt::format("{}: has {} pixels a side, stated are {}", to_string(key), picture.side_px,
                         set_.tile_px));
      } else if (key.zoom < set_.finest()) {
        check_means(key, set_.heights_of(picture));
      }
    } catch (const InputError& error) {
      note(key.zoom, PictureFault::kUnreadable, 1, error.what());
    }
  }

  void check_means(const PictureKey& key, const std::vector<double>& heights) {
    std::int64_t wrong = 0;
    std::string first;
    const std::int64_t half = set_.tile_px / 2;
    for (const std::int64_t quarter : {0, 1, 2, 3}) {
      const PictureKey child{key.zoom + 1, 2 * key.x + quarter % 2, 2 * key.y + quarter / 2};
      const bool is_there = set_.may_have(child) && std::filesystem::exists(set_.file_of(child));
      const auto below = is_there ? heights_at(child) : std::nullopt;
      if (is_there && !below) continue;  // said where it was looked at
      for (std::int64_t y = 0; y < half; ++y) {
        for (std::int64_t x = 0; x < half; ++x) {
          const double height_m = heights[static_cast<std::size_t>(
              (y + quarter / 2 * half) * set_.tile_px + x + quarter % 2 * half)];
          if (below ? is_a_mean(height_m, *below, x, y) : height_m == fill_m_) continue;
          if (++wrong > 1) continue;
          first = fmt::format("pixel {}, {} is at {:.3f} m, which is no mean of the four below",
                              x + quarter % 2 * half, y + quarter / 2 * half, height_m);
        }
      }
    }
    if (wrong == 0) return;
    note(key.zoom, PictureFault::kMeans, wrong,
         fmt::format("{}: {} ({} pixels in all)", to_string(key), first, wrong));
  }

  /// Of those of the four that have data. What has the fill's height may be data or none.
  bool is_a_mean(double height_m, const std::vector<double>& below, std::int64_t x,
                 std::int64_t y) const {
    double sum_m = 0;
    int count = 0, filled = 0;
    for (const std::int64_t k : {0, 1, 2, 3}) {
      const double of_four =
          below[static_cast<std::size_t>((2 * y + k / 2) * set_.tile_px + 2 * x + k % 2)];
      if (of_four == fill_m_) {
        ++filled;
      } else {
        sum_m += of_four;
        ++count;
      }
    }
    // both are rounded, and a pixel may be missing that is a hair beside the fill
    const double slack_m = 1.001 * set_.step_m();
    for (int with = 0; with <= filled; ++with) {
      if (count + with == 0) continue;
      if (std::abs(height_m - (sum_m + with * fill_m_) / (count + with)) <= slack_m) return true;
    }
    return false;
  }

  void check_stated(int zoom) {
    const PictureSet::Zoom& stated = set_.zooms[static_cast<std::size_t>(zoom)];
    const PictureZoomReport& found = report_.zooms[static_cast<std::size_t>(zoom)];
    if (stated.tiles == found.tiles && stated.bytes == found.bytes) return;
    note(zoom, PictureFault::kMisstated, 1,
         fmt::format("terrane.json: zoom {} states {} tiles of {} bytes, there are {} of {}", zoom,
                     stated.tiles, stated.bytes, found.tiles, found.bytes));
  }

  PictureSet set_;
  double fill_m_;
  PictureReport report_;
};

}  // namespace

PictureReport verify_pictures(const std::filesystem::path& folder, const HeightSource& heights,
                              const Georeference& place, double fill_m, Progress& progress) {
  const PictureSet set = read_picture_set(folder);
  Verification verification(set, fill_m);
  verification.check_files(progress);
  verification.check_errors(measure_pictures(set, heights, place, progress));
  return verification.take();
}

}  // namespace terrane::verify
