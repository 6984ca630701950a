#include "hierarchy/collapse/star_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hierarchy/collapse/lanes.h"

namespace terrane::hierarchy {
namespace {

static_assert(Star::kPadding == kLanes);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// below this weight the centre cannot mend what the fixed border of the star decides
constexpr float kSmallestWeight = 1e-4F;

/// The spokes of a star around one centre, and its sectors: over a sample at (x, y) from the
/// centre, a sector is weight * height of the centre + border, where
/// weight = 1 + x weight_x + y weight_y, and border = x border_x + y border_y.
struct Sectors {
  std::size_t count;
  float* x;  // of the spokes, from the centre to the corners
  float* y;
  float* weight_x;
  float* weight_y;
  float* border_x;
  float* border_y;

  Sectors(std::size_t sector_count, std::vector<float>& memory) : count(sector_count) {
    const std::size_t each = sector_count + 2 * kLanes;
    if (memory.size() < 6 * each) memory.resize(12 * each);
    float** const parts[] = {&x, &y, &weight_x, &weight_y, &border_x, &border_y};
    for (std::size_t k = 0; k < 6; ++k) *parts[k] = memory.data() + k * each;
  }

  /// \return false if the polygon does not see the centre, or a sector is too thin.
  TERRANE_LANES_INLINE bool set(const Star& star, Star::Centre centre, float smallest_altitude) {
    for (std::size_t k = 0; k <= count; k += kLanes) {
      store(load(star.corner_x() + k) - centre.x, x + k);
      store(load(star.corner_y() + k) - centre.y, y + k);
    }
    const float altitude2 = smallest_altitude * smallest_altitude;
    for (std::size_t k = 0; k < count; k += kLanes) {
      const Lanes ax = load(x + k), ay = load(y + k), bx = load(x + k + 1), by = load(y + k + 1);
      const Lanes area = ax * by - ay * bx;
      const Lanes dx = bx - ax, dy = by - ay;
      const Lanes longest2 = max(max(ax * ax + ay * ay, bx * bx + by * by), dx * dx + dy * dy);
      const LaneMask is_bad = (area <= 0.0F) | (area * area < longest2 * altitude2);
      if (any(is_bad & (lane_numbers() < static_cast<float>(count - k)))) return false;
      const Lanes scale = 1.0F / area;
      const Lanes az = load(star.corner_z() + k), bz = load(star.corner_z() + k + 1);
      store((ay - by) * scale, weight_x + k);
      store((bx - ax) * scale, weight_y + k);
      store((by * az - ay * bz) * scale, border_x + k);
      store((ax * bz - bx * az) * scale, border_y + k);
    }
    return true;
  }
};

/// What some samples say about the height of the centre.
struct Said {
  Lanes weight;  // of the centre's height
  Lanes border;  // what the polygon adds
};

/// For samples that lie in no sector, by rounding beside an open fan: in the first or in the last.
std::size_t nearest_sector(const Sectors& sectors, float x, float y) {
  const std::size_t last = sectors.count - 1;
  const auto along = [&](std::size_t k) {
    return (sectors.x[k] * x + sectors.y[k] * y) / std::hypot(sectors.x[k], sectors.y[k]);
  };
  return along(0) > along(last + 1) ? 0 : last;
}

/// Calls visit(sector, mask of the samples in it); at most one sector has a sample.
/// \return the samples that lie in one.
template <class Visit>
TERRANE_LANES_INLINE LaneMask for_each_sector(const Sectors& sectors, const Lanes& x,
                                              const Lanes& y, const Visit& visit) {
  LaneMask found{};
  LaneMask is_left = sectors.x[0] * y - sectors.y[0] * x >= 0.0F;
  for (std::size_t k = 0; k < sectors.count; ++k) {
    const LaneMask is_left_of_next = sectors.x[k + 1] * y - sectors.y[k + 1] * x >= 0.0F;
    const LaneMask is_inside = is_left & ~is_left_of_next;
    visit(k, is_inside);
    found |= is_inside;
    is_left = is_left_of_next;
  }
  return found;
}

TERRANE_LANES_INLINE Said ask(const Sectors& sectors, bool is_closed, const Lanes& x,
                              const Lanes& y) {
  // of a closed fan, only the centre itself is in no sector: it has the whole weight
  Lanes weight = all_lanes(1), border{};
  const LaneMask found = for_each_sector(
      sectors, x, y, [&](std::size_t k, const LaneMask& is_inside) __attribute__((always_inline)) {
        const Lanes w = 1.0F + x * sectors.weight_x[k] + y * sectors.weight_y[k];
        const Lanes b = x * sectors.border_x[k] + y * sectors.border_y[k];
        weight = is_inside ? w : weight;
        border = is_inside ? b : border;
      });
  if (!is_closed && any(~found)) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (found[i]) continue;
      const std::size_t k = nearest_sector(sectors, x[i], y[i]);
      weight[i] = 1.0F + x[i] * sectors.weight_x[k] + y[i] * sectors.weight_y[k];
      border[i] = x[i] * sectors.border_x[k] + y[i] * sectors.border_y[k];
    }
  }
  return {weight, border};
}

/// The same, less the samples themselves; padding weighs nothing.
struct Asked {
  Lanes weight;
  Lanes difference;  // to the samples, of what the polygon alone makes of them
};

TERRANE_LANES_INLINE Asked ask(const Star& star, const Sectors& sectors, Star::Centre centre,
                               std::size_t first) {
  const Said said = ask(sectors, star.is_closed(), load(star.sample_x() + first) - centre.x,
                        load(star.sample_y() + first) - centre.y);
  const Lanes difference = load(star.sample_z() + first) - said.border;
  const std::size_t left = star.sample_count() - first;
  if (left >= kLanes) return {said.weight, difference};
  const LaneMask is_sample = lane_numbers() < static_cast<float>(left);
  return {is_sample ? said.weight : Lanes{}, is_sample ? difference : Lanes{}};
}

/// The heights of the centre that samples allow, lane by lane.
struct Interval {
  Lanes lowest = all_lanes(-kInfinity), highest = all_lanes(kInfinity);

  TERRANE_LANES_INLINE void narrow(const Asked& asked, float tolerance_m) {
    const LaneMask decides = asked.weight > kSmallestWeight;
    const Lanes per_weight = 1.0F / asked.weight;
    const Lanes low = (asked.difference - tolerance_m) * per_weight;
    const Lanes high = (asked.difference + tolerance_m) * per_weight;
    lowest = decides ? max(lowest, low) : lowest;
    highest = decides ? min(highest, high) : highest;
  }
  TERRANE_LANES_INLINE bool is_surely_empty() const { return any(lowest > highest); }
  TERRANE_LANES_INLINE bool is_empty() const { return greatest(lowest) > least(highest); }
};

/// The intervals after each group of samples, so that the groups that made one empty can be found.
struct Bounds {
  float* lowest;
  float* highest;

  Bounds(std::size_t sample_count, std::vector<float>& memory) {
    const std::size_t each = sample_count + kLanes;
    if (memory.size() < 2 * each) memory.resize(4 * each);
    lowest = memory.data();
    highest = lowest + each;
  }
  TERRANE_LANES_INLINE void note(const Interval& interval, std::size_t first) {
    store(interval.lowest, lowest + first);
    store(interval.highest, highest + first);
  }
};

/// The first group, up to that at \p last, with this bound.
std::size_t group_with(const float* bounds, float bound, std::size_t last) {
  const float* const end = bounds + last + kLanes;
  const auto at = static_cast<std::size_t>(std::find(bounds, end, bound) - bounds);
  return std::min(at / kLanes * kLanes, last);
}

}  // namespace

struct StarJudge::Fit {
  const Star& star;
  Star::Centre centre;
  float tolerance_m, smallest_altitude_cells;
  StarHeights& heights;
  StarJudge& judge;
  Known& known;

  TERRANE_LANES_INLINE StarVerdict run() const {
    Sectors sectors(star.sector_count(), known.memory);
    if (known.star_number != judge.star_number_) {
      if (!sectors.set(star, centre, smallest_altitude_cells)) return StarVerdict::kNotStarShaped;
      known.star_number = judge.star_number_;
    }
    Interval interval;
    const Contrary& contrary = judge.contrary_;
    for (std::size_t i = 0; i < contrary.count; ++i) {
      interval.narrow(ask(star, sectors, centre, contrary.first[i]), tolerance_m);
    }
    if (contrary.count > 0 && interval.is_empty()) return StarVerdict::kOverTolerance;

    Lanes ww{}, wd{}, dd{};
    const std::size_t count = star.sample_count();
    Bounds bounds(count, judge.bounds_memory_);
    for (std::size_t first = 0; first < count; first += kLanes) {
      const Asked asked = ask(star, sectors, centre, first);
      interval.narrow(asked, tolerance_m);
      bounds.note(interval, first);
      if (interval.is_surely_empty()) return refuse(interval, bounds, first);
      ww += asked.weight * asked.weight;
      wd += asked.weight * asked.difference;
      dd += asked.difference * asked.difference;
    }
    if (interval.is_empty()) return refuse(interval, bounds, (count - 1) / kLanes * kLanes);
    heights.lowest = greatest(interval.lowest);
    heights.highest = least(interval.highest);
    const float weights = sum(ww), wished = weights > 0 ? sum(wd) / weights : 0;
    heights.best = std::clamp(wished, heights.lowest, heights.highest);
    heights.squared_error =
        sum(dd) - 2 * heights.best * sum(wd) + heights.best * heights.best * weights;
    return StarVerdict::kFeasible;
  }

  TERRANE_LANES_INLINE StarVerdict refuse(const Interval& interval, const Bounds& bounds,
                                          std::size_t last) const {
    judge.contrary_ = {2,
                       {group_with(bounds.lowest, greatest(interval.lowest), last),
                        group_with(bounds.highest, least(interval.highest), last)}};
    return StarVerdict::kOverTolerance;
  }
};

StarJudge::StarJudge() : StarJudge(has_wide_lanes()) {}

StarVerdict StarJudge::fit(const Star& star, Star::Centre centre, float tolerance_m,
                           float smallest_altitude_cells, StarHeights& heights,
                           std::size_t number) {
  if (number >= known_.size()) known_.resize(number + 1);
  const Fit fit{star, centre, tolerance_m, smallest_altitude_cells, heights, *this, known_[number]};
  return is_wide_ ? run_wide(fit) : run_portable(fit);
}

/// Guesses the sector of each sample, in single precision.
/// \return false if the polygon does not see the centre.
struct StarJudge::Guess {
  const Star& star;
  Star::Centre centre;
  StarJudge& judge;

  TERRANE_LANES_INLINE bool run() const {
    Sectors sectors(star.sector_count(), judge.guess_.memory);
    if (!sectors.set(star, centre, 0)) return false;
    for (std::size_t first = 0; first < star.sample_count(); first += kLanes) {
      const Lanes x = load(star.sample_x() + first) - centre.x;
      const Lanes y = load(star.sample_y() + first) - centre.y;
      LaneMask sector{};
      const LaneMask found = for_each_sector(
          sectors, x,
          y, [&](std::size_t k, const LaneMask& is_inside) __attribute__((always_inline)) {
            sector |= is_inside & static_cast<std::int32_t>(k);
          });
      if (!star.is_closed() && any(~found)) {
        for (std::size_t i = 0; i < kLanes; ++i) {
          if (!found[i]) {
            sector[i] = static_cast<std::int32_t>(nearest_sector(sectors, x[i], y[i]));
          }
        }
      }
      std::memcpy(judge.sectors_.data() + first, &sector, sizeof sector);
    }
    return true;
  }
};

namespace {

/// The star around a written place, in double precision.
class ExactStar {
 public:
  ExactStar(const Star& star, const Place& centre, std::vector<StarJudge::ExactSector>& sectors)
      : sectors_(sectors), centre_m_(centre.height_m), is_closed_(star.is_closed()) {
    sectors_.clear();
    for (std::size_t k = 0; k < star.sector_count(); ++k) {
      const Place &from = star.corner(k), &to = star.corner(k + 1);
      StarJudge::ExactSector sector{};
      sector.from_x = static_cast<double>(from.plan.x) - centre.plan.x;
      sector.from_y = static_cast<double>(from.plan.y) - centre.plan.y;
      sector.to_x = static_cast<double>(to.plan.x) - centre.plan.x;
      sector.to_y = static_cast<double>(to.plan.y) - centre.plan.y;
      sector.scale = 1 / (sector.from_x * sector.to_y - sector.from_y * sector.to_x);
      sector.from_m = from.height_m;
      sector.to_m = to.height_m;
      sectors_.push_back(sector);
    }
  }

  /// Height of the star at a place, counted from its centre in grid units.
  /// \param[in,out] sector  a guess; where the place is found to be.
  double height_m(double x, double y, std::uint32_t& sector) const {
    const auto count = static_cast<std::uint32_t>(sectors_.size());
    for (std::uint32_t steps = 0;; ++steps) {
      const StarJudge::ExactSector& at = sectors_[sector];
      const double of_next = (at.from_x * y - at.from_y * x) * at.scale;
      const double of_corner = (x * at.to_y - y * at.to_x) * at.scale;
      std::uint32_t neighbour = sector;
      if (of_next < 0 && (sector > 0 || is_closed_)) {
        neighbour = sector > 0 ? sector - 1 : count - 1;
      } else if (of_corner < 0 && (sector + 1 < count || is_closed_)) {
        neighbour = sector + 1 < count ? sector + 1 : 0;
      }
      if (neighbour == sector || steps > count) {
        return (1 - of_next - of_corner) * centre_m_ + of_corner * at.from_m + of_next * at.to_m;
      }
      sector = neighbour;
    }
  }

 private:
  std::vector<StarJudge::ExactSector>& sectors_;
  double centre_m_;
  bool is_closed_;
};

}  // namespace

bool StarJudge::holds(const Star& star, const Place& centre, double tolerance_m) {
  if (sectors_.size() < star.sample_count() + kLanes) {
    sectors_.resize(2 * (star.sample_count() + kLanes));
  }
  const Guess guess{star, star.centre(centre.plan), *this};
  if (!(is_wide_ ? run_wide(guess) : run_portable(guess))) return false;
  const ExactStar exact(star, centre, exact_sectors_);
  for (std::size_t k = 0; k < star.sample_count(); ++k) {
    const CoveredSample& sample = star.sample(k);
    const double z =
        exact.height_m(double{sample.column} * kUnitsPerCell - centre.plan.x,
                       -double{sample.row} * kUnitsPerCell - centre.plan.y, sectors_[k]);
    if (!(std::abs(z - sample.height_m) <= tolerance_m)) return false;
  }
  return true;
}

}  // namespace terrane::hierarchy
