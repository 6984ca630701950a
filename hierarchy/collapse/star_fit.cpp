#include "hierarchy/collapse/star_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <experimental/simd>
#include <limits>

namespace terrane::hierarchy {
namespace {

namespace stdx = std::experimental;
// four lanes on every machine: sums then add up in the same order, and bytes do not depend on it
using Lanes = stdx::simd<float, stdx::simd_abi::deduce_t<float, Star::kLanes>>;
static_assert(Lanes::size() == Star::kLanes);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// below this weight the centre cannot mend what the fixed border of the star decides
constexpr float kSmallestWeight = 1e-4F;

Lanes load(const float* from) { return Lanes(from, stdx::element_aligned); }

float sum(const Lanes& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

/// The spokes and sectors of a star around one centre.
struct Spokes {
  float* x;      // from the centre to the corners
  float* y;      //
  float* scale;  // 1 / twice the area of a sector

  Spokes(const Star& star, std::vector<float>& memory) {
    const std::size_t each = star.sector_count() + 2 * Star::kLanes;
    if (memory.size() < 3 * each) memory.resize(6 * each);
    x = memory.data();
    y = x + each;
    scale = y + each;
  }

  /// \return false if the polygon does not see the centre, or a sector is too thin.
  bool set(const Star& star, Star::Centre centre, float smallest_altitude) {
    const std::size_t count = star.sector_count();
    for (std::size_t k = 0; k <= count; k += Star::kLanes) {
      (load(star.corner_x() + k) - centre.x).copy_to(x + k, stdx::element_aligned);
      (load(star.corner_y() + k) - centre.y).copy_to(y + k, stdx::element_aligned);
    }
    const float altitude2 = smallest_altitude * smallest_altitude;
    const Lanes lane([](auto k) { return static_cast<float>(k); });
    for (std::size_t k = 0; k < count; k += Star::kLanes) {
      const Lanes ax = load(x + k), ay = load(y + k), bx = load(x + k + 1), by = load(y + k + 1);
      const Lanes area = ax * by - ay * bx;
      const Lanes dx = bx - ax, dy = by - ay;
      const Lanes longest2 =
          stdx::max(stdx::max(ax * ax + ay * ay, bx * bx + by * by), dx * dx + dy * dy);
      const auto is_bad = area <= 0.0F || area * area < longest2 * altitude2;
      if (stdx::any_of(is_bad && lane < static_cast<float>(count - k))) return false;
      (1.0F / area).copy_to(scale + k, stdx::element_aligned);
    }
    return true;
  }
};

/// What decides on four samples: their sector, and the cross products with its two spokes.
struct Located {
  Lanes before, after;
  std::array<std::size_t, Star::kLanes> sector;
};

/// A sample that lies in no sector, by rounding beside an open fan: in the first or in the last.
void put_beside(const Star& star, const Spokes& spokes, float x, float y, std::size_t lane,
                Located& at) {
  const std::size_t last = star.sector_count() - 1;
  const auto along = [&](std::size_t k) {
    return (spokes.x[k] * x + spokes.y[k] * y) / std::hypot(spokes.x[k], spokes.y[k]);
  };
  const auto cross = [&](std::size_t k) { return spokes.x[k] * y - spokes.y[k] * x; };
  const std::size_t sector = along(0) > along(last + 1) ? 0 : last;
  at.sector[lane] = sector;
  at.before[lane] = cross(sector);
  at.after[lane] = cross(sector + 1);
}

Located locate(const Star& star, const Spokes& spokes, const Lanes& x, const Lanes& y) {
  Located at{0.0F, 0.0F, {}};
  typename Lanes::mask_type found(false);
  Lanes before = spokes.x[0] * y - spokes.y[0] * x;
  Lanes sector(0.0F), index(0.0F);
  for (std::size_t k = 0; k < star.sector_count(); ++k) {
    const Lanes after = spokes.x[k + 1] * y - spokes.y[k + 1] * x;
    const auto inside = before >= 0.0F && after < 0.0F;
    stdx::where(inside, at.before) = before;
    stdx::where(inside, at.after) = after;
    stdx::where(inside, sector) = index;
    found = found || inside;
    before = after;
    index += 1.0F;
  }
  for (std::size_t lane = 0; lane < Star::kLanes; ++lane) {
    at.sector[lane] = static_cast<std::size_t>(sector[lane]);
  }
  // of a closed fan, only the centre itself is in no sector; the zeros above are right for it
  if (!star.is_closed() && !stdx::all_of(found)) {
    for (std::size_t lane = 0; lane < Star::kLanes; ++lane) {
      if (!found[lane]) put_beside(star, spokes, x[lane], y[lane], lane, at);
    }
  }
  return at;
}

/// What four samples say about the height of the centre.
struct Said {
  Lanes weight;      // of the centre's height
  Lanes difference;  // to the sample, of what the polygon alone makes of it
};

Said ask(const Star& star, const Spokes& spokes, Star::Centre centre, std::size_t first) {
  const Lanes x = load(star.sample_x() + first) - centre.x;
  const Lanes y = load(star.sample_y() + first) - centre.y;
  const Located at = locate(star, spokes, x, y);
  const Lanes scale([&](auto lane) { return spokes.scale[at.sector[lane]]; });
  const Lanes z([&](auto lane) { return star.corner_z()[at.sector[lane]]; });
  const Lanes next_z([&](auto lane) { return star.corner_z()[at.sector[lane] + 1]; });

  const Lanes of_corner = -at.after * scale, of_next = at.before * scale;
  Said said{1.0F - of_corner - of_next,
            load(star.sample_z() + first) - of_corner * z - of_next * next_z};
  const std::size_t count = star.sample_count();
  if (first + Star::kLanes > count) {
    const Lanes lane([](auto k) { return static_cast<float>(k); });
    const auto is_padding = lane >= static_cast<float>(count - first);
    stdx::where(is_padding, said.weight) = 0.0F;
    stdx::where(is_padding, said.difference) = 0.0F;
  }
  return said;
}

/// The heights of the centre that some samples allow.
struct Interval {
  Lanes lowest = -kInfinity, highest = kInfinity;

  void narrow(const Said& said, float tolerance_m) {
    const auto decides = said.weight > kSmallestWeight;
    const Lanes per_weight = 1.0F / said.weight;
    stdx::where(decides, lowest) = stdx::max(lowest, (said.difference - tolerance_m) * per_weight);
    stdx::where(decides, highest) =
        stdx::min(highest, (said.difference + tolerance_m) * per_weight);
  }
  float greatest_lowest() const {
    return std::max(std::max(lowest[0], lowest[1]), std::max(lowest[2], lowest[3]));
  }
  float least_highest() const {
    return std::min(std::min(highest[0], highest[1]), std::min(highest[2], highest[3]));
  }
  bool is_empty() const { return greatest_lowest() > least_highest(); }
};

}  // namespace

StarVerdict StarJudge::fit(const Star& star, Star::Centre centre, float tolerance_m,
                           float smallest_altitude_cells, StarHeights& heights) {
  Spokes spokes(star, spokes_);
  if (!spokes.set(star, centre, smallest_altitude_cells)) return StarVerdict::kNotStarShaped;

  Interval interval;
  for (std::size_t i = 0; i < contrary_.count; ++i) {
    interval.narrow(ask(star, spokes, centre, contrary_.first[i]), tolerance_m);
  }
  if (interval.is_empty()) return StarVerdict::kOverTolerance;

  Lanes ww(0.0F), wd(0.0F), dd(0.0F);
  const std::size_t count = star.sample_count();
  if (bounds_.size() < 2 * (count + Star::kLanes)) bounds_.resize(4 * (count + Star::kLanes));
  for (std::size_t first = 0; first < count; first += Star::kLanes) {
    const Said said = ask(star, spokes, centre, first);
    interval.narrow(said, tolerance_m);
    interval.lowest.copy_to(&bounds_[2 * first], stdx::element_aligned);
    interval.highest.copy_to(&bounds_[2 * first + Star::kLanes], stdx::element_aligned);
    if (interval.is_empty()) {
      remember_contrary(first, interval.greatest_lowest(), interval.least_highest());
      return StarVerdict::kOverTolerance;
    }
    ww += said.weight * said.weight;
    wd += said.weight * said.difference;
    dd += said.difference * said.difference;
  }
  heights.lowest = interval.greatest_lowest();
  heights.highest = interval.least_highest();
  const float weights = sum(ww), wished = weights > 0 ? sum(wd) / weights : 0;
  heights.best = std::clamp(wished, heights.lowest, heights.highest);
  heights.squared_error =
      sum(dd) - 2 * heights.best * sum(wd) + heights.best * heights.best * weights;
  return StarVerdict::kFeasible;
}

/// Finds the first fours, up to \p last, after which the interval had these bounds.
void StarJudge::remember_contrary(std::size_t last, float lowest, float highest) {
  const auto first_with = [&](float bound, std::size_t offset) {
    for (std::size_t first = 0; first < last; first += Star::kLanes) {
      const float* four = &bounds_[2 * first + offset];
      if (std::find(four, four + Star::kLanes, bound) != four + Star::kLanes) return first;
    }
    return last;
  };
  contrary_ = {2, {first_with(lowest, 0), first_with(highest, Star::kLanes)}};
}

namespace {

/// The star around a written place, in double precision.
class ExactStar {
 public:
  ExactStar(const Star& star, const Place& centre) : star_(star), centre_(centre) {}

  /// Height of the star at a place, counted from its centre in grid units.
  /// \param[in,out] sector  a guess; where the place is found to be.
  double height_m(double x, double y, std::size_t& sector) const {
    const std::size_t count = star_.sector_count();
    for (std::size_t steps = 0;; ++steps) {
      const Spoke from = spoke(sector), to = spoke(sector + 1);
      const double scale = 1 / (from.x * to.y - from.y * to.x);
      const double of_next = (from.x * y - from.y * x) * scale;
      const double of_corner = (x * to.y - y * to.x) * scale;
      std::size_t neighbour = sector;
      if (of_next < 0 && (sector > 0 || star_.is_closed())) {
        neighbour = sector > 0 ? sector - 1 : count - 1;
      } else if (of_corner < 0 && (sector + 1 < count || star_.is_closed())) {
        neighbour = sector + 1 < count ? sector + 1 : 0;
      }
      if (neighbour == sector || steps > count) {
        return (1 - of_next - of_corner) * centre_.height_m +
               of_corner * star_.corner(sector).height_m +
               of_next * star_.corner(sector + 1).height_m;
      }
      sector = neighbour;
    }
  }

 private:
  struct Spoke {
    double x, y;
  };
  Spoke spoke(std::size_t k) const {
    const GridPoint corner = star_.corner(k).plan;
    return {static_cast<double>(corner.x) - centre_.plan.x,
            static_cast<double>(corner.y) - centre_.plan.y};
  }

  const Star& star_;
  const Place& centre_;
};

}  // namespace

bool StarJudge::holds(const Star& star, const Place& centre, double tolerance_m) {
  Spokes spokes(star, spokes_);
  const Star::Centre at = star.centre(centre.plan);
  if (!spokes.set(star, at, 0)) return false;
  const ExactStar exact(star, centre);

  if (sectors_.size() < star.sample_count()) sectors_.resize(2 * star.sample_count());
  for (std::size_t first = 0; first < star.sample_count(); first += Star::kLanes) {
    const Located located = locate(star, spokes, load(star.sample_x() + first) - at.x,
                                   load(star.sample_y() + first) - at.y);
    const std::size_t end = std::min(first + Star::kLanes, star.sample_count());
    for (std::size_t k = first; k < end; ++k) {
      const CoveredSample& sample = star.sample(k);
      auto sector = located.sector[k - first];
      const double z = exact.height_m(double{sample.column} * kUnitsPerCell - centre.plan.x,
                                      -double{sample.row} * kUnitsPerCell - centre.plan.y, sector);
      if (!(std::abs(z - sample.height_m) <= tolerance_m)) return false;
      sectors_[k] = static_cast<std::uint32_t>(sector);
    }
  }
  return true;
}

}  // namespace terrane::hierarchy
