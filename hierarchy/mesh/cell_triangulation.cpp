#include "hierarchy/mesh/cell_triangulation.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kSides = 3;

CellTriangulation::Edge sorted(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Is p on the straight line between a and b, and none of them?
bool is_between(GridPoint p, GridPoint a, GridPoint b) {
  if (orient2d(a, b, p) != 0 || p == a || p == b) return false;
  const auto within = [](std::int32_t v, std::int32_t from, std::int32_t to) {
    return std::min(from, to) <= v && v <= std::max(from, to);
  };
  return within(p.x, a.x, b.x) && within(p.y, a.y, b.y);
}

/// The corner of the triangle with side from -> to that lies opposite.
std::optional<std::uint32_t> apex(const Corners& t, std::uint32_t from, std::uint32_t to) {
  for (std::uint32_t k = 0; k < kSides; ++k) {
    if (t[k] == from && t[(k + 1) % kSides] == to) return t[(k + 2) % kSides];
  }
  return std::nullopt;
}

/// Does d lie inside the circle through a, b, c? Exact: 14 bits along a cell's side make 60 of the
/// determinant.
bool is_in_circle(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  struct Lifted {
    std::int64_t x, y, square;
  };
  const auto lift = [d](GridPoint p) {
    const std::int64_t x = std::int64_t{p.x} - d.x, y = std::int64_t{p.y} - d.y;
    return Lifted{x, y, x * x + y * y};
  };
  const Lifted p = lift(a), q = lift(b), r = lift(c);
  return p.square * (q.x * r.y - q.y * r.x) - q.square * (p.x * r.y - p.y * r.x) +
             r.square * (p.x * q.y - p.y * q.x) >
         0;
}

int sign(std::int64_t value) { return (value > 0) - (value < 0); }

/// A whole number of cells is a side of the cell, which belongs to its neighbour, too: one step
/// aside.
std::int32_t off_the_side(std::int32_t value, std::int32_t towards) {
  return value % kUnitsPerCell != 0 ? value : value + (towards > value ? 1 : -1);
}

/// Where the lines ab and cd cross inside a cell, to the nearest grid point that is on none of its
/// sides.
GridPoint crossing(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  const auto from_a = static_cast<double>(orient2d(c, d, a));
  const auto from_b = static_cast<double>(orient2d(c, d, b));
  const double t = from_a / (from_a - from_b);
  const auto x = static_cast<std::int32_t>(std::lround(a.x + t * (b.x - a.x)));
  const auto y = static_cast<std::int32_t>(std::lround(a.y + t * (b.y - a.y)));
  return {off_the_side(x, (a.x + b.x) / 2), off_the_side(y, (a.y + b.y) / 2)};
}

}  // namespace

bool CellTriangulation::has_edge(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::any_of(triangles_,
                             [=](const Corners& t) { return apex(t, a, b) || apex(t, b, a); });
}

bool CellTriangulation::is_joined(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::find(edges_, sorted(a, b)) != edges_.end();
}

bool CellTriangulation::covers(GridPoint point) const {
  return std::ranges::any_of(triangles_, [&](const Corners& t) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      if (orient2d(points_[t[k]], points_[t[(k + 1) % kSides]], point) < 0) return false;
    }
    return true;
  });
}

std::uint32_t CellTriangulation::insert(GridPoint point) {
  const auto same = std::ranges::find(points_, point);
  if (same != points_.end()) return static_cast<std::uint32_t>(same - points_.begin());
  const auto added = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  for (Corners& t : triangles_) {
    std::array<int, 3> side;
    for (std::uint32_t k = 0; k < kSides; ++k) {
      side[k] = sign(orient2d(points_[t[k]], points_[t[(k + 1) % kSides]], point));
    }
    if (std::ranges::any_of(side, [](int s) { return s < 0; })) continue;
    const auto on = std::ranges::find(side, 0) - side.begin();
    if (on < kSides) {
      split_edge(t[on], t[(on + 1) % kSides], added);
    } else {
      const Corners old = std::exchange(t, {t[0], t[1], added});
      triangles_.push_back({old[1], old[2], added});
      triangles_.push_back({old[2], old[0], added});
    }
    return added;
  }
  throw TopologyError("a point of a line lies outside its cell");
}

void CellTriangulation::split_edge(std::uint32_t from, std::uint32_t to, std::uint32_t at) {
  for (std::size_t i = 0, count = triangles_.size(); i < count; ++i) {
    for (const auto& [a, b] : {std::pair{from, to}, std::pair{to, from}}) {
      const auto c = apex(triangles_[i], a, b);
      if (!c) continue;
      triangles_[i] = {a, at, *c};
      triangles_.push_back({at, b, *c});
      break;
    }
  }
  const auto joined = std::ranges::find(edges_, sorted(from, to));
  if (joined == edges_.end()) return;
  *joined = sorted(from, at);
  edges_.push_back(sorted(at, to));
}

/// Do they cross in one point that is an end of neither?
bool CellTriangulation::crosses(Edge edge, std::uint32_t a, std::uint32_t b) const {
  const GridPoint &p = points_[edge[0]], &q = points_[edge[1]], &c = points_[a], &d = points_[b];
  return sign(orient2d(c, d, p)) * sign(orient2d(c, d, q)) < 0 &&
         sign(orient2d(p, q, c)) * sign(orient2d(p, q, d)) < 0;
}

std::vector<CellTriangulation::Edge> CellTriangulation::edges_across(std::uint32_t a,
                                                                     std::uint32_t b) const {
  std::vector<Edge> found;
  for (const Corners& t : triangles_) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const Edge edge = sorted(t[k], t[(k + 1) % kSides]);
      if (crosses(edge, a, b) && std::ranges::find(found, edge) == found.end()) {
        found.push_back(edge);
      }
    }
  }
  return found;
}

void CellTriangulation::join(std::uint32_t a, std::uint32_t b) {
  if (a == b || is_joined(a, b)) return;
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (!is_between(points_[v], points_[a], points_[b])) continue;
    join(a, v);
    join(v, b);
    return;
  }
  if (!has_edge(a, b)) {
    std::vector<Edge> crossing = edges_across(a, b);
    for (const Edge& edge : crossing) {
      if (is_joined(edge[0], edge[1])) return meet(edge, a, b);
    }
    flip_to(a, b, std::move(crossing));
  }
  edges_.push_back(sorted(a, b));
}

/// Flips the edges that cross ab until none does (Sloan 1993, A fast algorithm for generating
/// constrained Delaunay triangulations, section 3).
void CellTriangulation::flip_to(std::uint32_t a, std::uint32_t b, std::vector<Edge> crossing) {
  std::deque<Edge> left(crossing.begin(), crossing.end());
  // far more than the flips that so few triangles can need
  constexpr int kMostFlips = 100'000;
  for (int flips = 0; !left.empty(); ++flips) {
    if (flips == kMostFlips) throw TopologyError("a line cannot be joined across a cell");
    const auto [p, q] = left.front();
    left.pop_front();
    Corners *one = nullptr, *other = nullptr;
    std::uint32_t r = 0, s = 0;
    for (Corners& t : triangles_) {
      if (const auto c = apex(t, p, q)) {
        one = &t;
        r = *c;
      } else if (const auto d = apex(t, q, p)) {
        other = &t;
        s = *d;
      }
    }
    if (!crosses({p, q}, r, s)) {
      left.push_back({p, q});  // the quadrilateral is not convex: others have to go first
      continue;
    }
    *one = {r, p, s};
    *other = {s, q, r};
    if (crosses(sorted(r, s), a, b)) left.push_back(sorted(r, s));
  }
}

void CellTriangulation::make_delaunay() {
  // each flip lowers the surface over a paraboloid, so this ends
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      for (std::uint32_t k = 0; k < kSides; ++k) {
        if (flip_if_better(i, k)) is_done = false;
      }
    }
  }
}

/// \return whether the side k of triangle i was flipped.
bool CellTriangulation::flip_if_better(std::size_t i, std::uint32_t k) {
  const Corners t = triangles_[i];
  const std::uint32_t p = t[k], q = t[(k + 1) % kSides], r = t[(k + 2) % kSides];
  if (is_joined(p, q)) return false;
  for (Corners& other : triangles_) {
    const auto s = apex(other, q, p);
    if (!s) continue;
    if (!is_in_circle(points_[p], points_[q], points_[r], points_[*s])) return false;
    if (!crosses({p, q}, r, *s)) return false;
    triangles_[i] = {r, p, *s};
    other = {*s, q, r};
    return true;
  }
  return false;
}

void CellTriangulation::meet(Edge earlier, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t at =
      insert(crossing(points_[a], points_[b], points_[earlier[0]], points_[earlier[1]]));
  // rounding may have put the point beside the earlier edge, or onto one of the ends
  std::erase(edges_, earlier);
  join(earlier[0], at);
  join(at, earlier[1]);
  join(a, at);
  join(at, b);
}

}  // namespace terrane::hierarchy
