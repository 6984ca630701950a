#include "ingest/separate_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/errors.h"
#include "core/grid_features.h"

namespace terrane::ingest {
namespace {

/// A place inside a cell, in parts of it from its first sample.
struct Point {
  std::int64_t x = 0, y = 0;
  auto operator<=>(const Point&) const = default;
};

constexpr auto kParts = static_cast<std::int64_t>(kLinePartsPerCell);

using Path = std::vector<Point>;

std::int64_t orient(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int sign(std::int64_t value) { return (value > 0) - (value < 0); }

/// Do ab and cd cross in a point that is an end of neither?
bool cross(Point a, Point b, Point c, Point d) {
  return sign(orient(a, b, c)) * sign(orient(a, b, d)) < 0 &&
         sign(orient(c, d, a)) * sign(orient(c, d, b)) < 0;
}

/// The lines of one cell.
class CellSeparation {
 public:
  CellSeparation(const CellSize& cell, double gap_m)
      : x_m_(cell.column_m / kLinePartsPerCell),
        y_m_(cell.row_m / kLinePartsPerCell),
        gap_m_(gap_m),
        points_{{0, 0}, {kParts, 0}, {0, kParts}, {kParts, kParts}} {}

  void add_point(Point p) {
    if (std::ranges::find(points_, p) == points_.end()) points_.push_back(p);
  }
  /// \return its number.
  std::size_t add_piece(Point from, Point to) {
    paths_.push_back({from, to});
    return paths_.size() - 1;
  }
  const Path& path(std::size_t number) const { return paths_[number]; }

  /// \return whether it came to an end.
  bool run() {
    constexpr int kMostSteps = 10'000;
    for (int step = 0; step < kMostSteps; ++step) {
      if (!lead_one_through() && !join_one_crossing()) return true;
    }
    return false;
  }

 private:
  double distance_m(Point p, Point a, Point b) const {
    const double dx = static_cast<double>(b.x - a.x) * x_m_;
    const double dy = static_cast<double>(b.y - a.y) * y_m_;
    const double px = static_cast<double>(p.x - a.x) * x_m_;
    const double py = static_cast<double>(p.y - a.y) * y_m_;
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
    return std::hypot(px - t * dx, py - t * dy);
  }

  /// A point that is nearer to a piece than the gap, and on it by no end: the nearest.
  std::optional<Point> too_near(Point a, Point b) const {
    std::optional<Point> nearest;
    double nearest_m = gap_m_;
    for (const Point p : points_) {
      if (p == a || p == b) continue;
      const double here_m = distance_m(p, a, b);
      if (here_m >= nearest_m) continue;
      nearest = p;
      nearest_m = here_m;
    }
    return nearest;
  }

  bool lead_one_through() {
    for (Path& path : paths_) {
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const std::optional<Point> through = too_near(path[i], path[i + 1]);
        if (!through) continue;
        insert(path, i + 1, *through);
        return true;
      }
    }
    return false;
  }

  bool join_one_crossing() {
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      for (std::size_t n = k + 1; n < paths_.size(); ++n) {
        if (join_crossing(paths_[k], paths_[n])) return true;
      }
    }
    return false;
  }

  bool join_crossing(Path& one, Path& other) {
    for (std::size_t i = 0; i + 1 < one.size(); ++i) {
      for (std::size_t j = 0; j + 1 < other.size(); ++j) {
        if (!cross(one[i], one[i + 1], other[j], other[j + 1])) continue;
        const Point at = crossing(one[i], one[i + 1], other[j], other[j + 1]);
        insert(one, i + 1, at);
        insert(other, j + 1, at);
        return true;
      }
    }
    return false;
  }

  /// Where they cross; a known point if there is one too near to that.
  Point crossing(Point a, Point b, Point c, Point d) {
    const auto from_a = static_cast<double>(orient(c, d, a));
    const auto from_b = static_cast<double>(orient(c, d, b));
    const double t = from_a / (from_a - from_b);
    const auto inside = [&](double at, double part_m) {
      const double margin = std::min(gap_m_ / part_m, 0.25 * kLinePartsPerCell);
      return std::lround(std::clamp(at, margin, kLinePartsPerCell - margin));
    };
    const Point at{inside(static_cast<double>(a.x) + t * static_cast<double>(b.x - a.x), x_m_),
                   inside(static_cast<double>(a.y) + t * static_cast<double>(b.y - a.y), y_m_)};
    for (const Point p : points_) {
      if (distance_m(p, at, at) < gap_m_) return p;
    }
    points_.push_back(at);
    return at;
  }

  static void insert(Path& path, std::size_t at, Point p) {
    // led back to where it comes from or goes to: nothing between
    if (path[at - 1] == p || path[at] == p) return;
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(at), p);
  }

  double x_m_, y_m_, gap_m_;
  std::vector<Point> points_;
  std::vector<Path> paths_;
};

/// A cell by its first sample.
struct CellId {
  std::int64_t row, column;
  auto operator<=>(const CellId&) const = default;
};

CellId cell_of(const GridPosition& a, const GridPosition& b) {
  return {static_cast<std::int64_t>(std::floor((a.row + b.row) / 2)),
          static_cast<std::int64_t>(std::floor((a.column + b.column) / 2))};
}

Point in_cell(const GridPosition& p, const CellId& cell) {
  return {std::llround((p.column - static_cast<double>(cell.column)) * kLinePartsPerCell),
          std::llround((p.row - static_cast<double>(cell.row)) * kLinePartsPerCell)};
}

GridPosition on_grid(const Point& p, const CellId& cell) {
  return {static_cast<double>(cell.column) + static_cast<double>(p.x) / kLinePartsPerCell,
          static_cast<double>(cell.row) + static_cast<double>(p.y) / kLinePartsPerCell};
}

/// Calls visit(cell) for each cell that a point lies in or on.
template <class Visit>
void for_each_cell_at(const GridPosition& p, Visit visit) {
  const auto last_row = static_cast<std::int64_t>(std::floor(p.row));
  const auto last_column = static_cast<std::int64_t>(std::floor(p.column));
  const std::int64_t first_row = p.row == std::floor(p.row) ? last_row - 1 : last_row;
  const std::int64_t first_column =
      p.column == std::floor(p.column) ? last_column - 1 : last_column;
  for (std::int64_t row = first_row; row <= last_row; ++row) {
    for (std::int64_t column = first_column; column <= last_column; ++column) {
      visit(CellId{row, column});
    }
  }
}

}  // namespace

void separate_lines(std::span<std::vector<GridPosition>* const> lines, const CellSize& cell,
                    double gap_m) {
  std::map<CellId, CellSeparation> cells;
  std::vector<std::vector<std::size_t>> numbers;  // for each line, for each piece
  const auto at = [&](const CellId& id) -> CellSeparation& {
    return cells.try_emplace(id, cell, gap_m).first->second;
  };
  for (const auto* line : lines) {
    std::vector<std::size_t>& of_line = numbers.emplace_back();
    for (std::size_t i = 0; i + 1 < line->size(); ++i) {
      const CellId id = cell_of((*line)[i], (*line)[i + 1]);
      of_line.push_back(at(id).add_piece(in_cell((*line)[i], id), in_cell((*line)[i + 1], id)));
    }
  }
  for (const auto* line : lines) {
    for (const GridPosition& p : *line) {
      for_each_cell_at(p, [&](const CellId& id) {
        if (const auto known = cells.find(id); known != cells.end()) {
          known->second.add_point(in_cell(p, id));
        }
      });
    }
  }
  for (auto& [id, separation] : cells) {
    if (separation.run()) continue;
    throw InputError(fmt::format(
        "lines and shores are too tangled at column {}, row {} of the DEM. Simplify them there",
        id.column, id.row));
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    std::vector<GridPosition>& line = *lines[k];
    if (line.empty()) continue;
    std::vector<GridPosition> separated{line.front()};
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const CellId id = cell_of(line[i], line[i + 1]);
      const Path& path = cells.at(id).path(numbers[k][i]);
      for (std::size_t p = 1; p < path.size(); ++p) separated.push_back(on_grid(path[p], id));
    }
    line = std::move(separated);
  }
}

}  // namespace terrane::ingest
