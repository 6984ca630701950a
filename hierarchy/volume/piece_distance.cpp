#include "hierarchy/volume/piece_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;

// sides 1/16 as long: what is left undecided costs a split of the cell
constexpr int kQuarterings = 4;

struct Corner {
  Vector3d point;
  double distance = 0;
  std::uint32_t triangle = 0;  ///< the nearest one
};
using Part = std::array<Corner, 3>;

Corner corner_at(const Vector3d& p, const InterfaceSurface& surface) {
  const NearestTriangle nearest = surface.nearest_triangle(p);
  return {p, std::sqrt(nearest.at.squared_distance), nearest.triangle};
}

/// Largest distance of a part to whichever triangle serves it best.
double distance_to_one_triangle(const Part& part, const InterfaceSurface& surface) {
  double best = std::numeric_limits<double>::infinity();
  for (const Corner& near : part) {
    const auto triangle = surface.corners(near.triangle);
    double largest = 0;
    for (const Corner& corner : part) {
      largest = std::max(largest, closest_point(corner.point, triangle).squared_distance);
    }
    best = std::min(best, largest);
  }
  return std::sqrt(best);
}

double bound(const Part& part, const InterfaceSurface& surface, double good_enough,
             int quarterings) {
  const double least = std::max({part[0].distance, part[1].distance, part[2].distance});
  if (least > good_enough) return least;
  const double most = distance_to_one_triangle(part, surface);
  if (most <= good_enough || quarterings == 0) return most;
  Part middles;
  for (std::size_t k = 0; k < 3; ++k) {
    middles[k] = corner_at((part[k].point + part[(k + 1) % 3].point) / 2, surface);
  }
  double largest = bound(middles, surface, good_enough, quarterings - 1);
  for (std::size_t k = 0; k < 3 && largest <= good_enough; ++k) {
    const Part tip = {part[k], middles[k], middles[(k + 2) % 3]};
    largest = std::max(largest, bound(tip, surface, good_enough, quarterings - 1));
  }
  return largest;
}

}  // namespace

double largest_distance(const ZeroSet& piece, const InterfaceSurface& surface, double good_enough) {
  if (piece.is_empty()) return 0;
  std::array<Corner, 4> corners;
  for (int k = 0; k < 4; ++k) {
    corners[k] = k < piece.size ? corner_at(piece.points[k], surface) : corners[k - 1];
  }
  const double first =
      bound({corners[0], corners[1], corners[2]}, surface, good_enough, kQuarterings);
  if (piece.size < 4 || first > good_enough) return first;
  return std::max(first,
                  bound({corners[0], corners[2], corners[3]}, surface, good_enough, kQuarterings));
}

}  // namespace terrane::hierarchy::volume
