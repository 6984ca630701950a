#include "hierarchy/mesh/lined_triangles.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <functional>
#include <map>
#include <set>

#include "hierarchy/mesh/cell_triangulation.h"

namespace terrane::hierarchy {
namespace {

static_assert(kLinePartsPerCell == kUnitsPerCell, "lines are laid on what GridPoint counts");

/// A cell by its first sample.
struct CellId {
  std::int64_t row, column;
  auto operator<=>(const CellId&) const = default;
};

/// One straight part of a line, inside a cell or on its side.
struct Piece {
  GridPoint from, to;
  std::optional<double> height_m;
};

/// What lines do in one cell.
struct CellLines {
  std::vector<GridPoint> points;
  std::vector<Piece> pieces;
  std::vector<Corners> triangles;  ///< those of the cell before, by sample vertices
};

struct PlanOrder {
  bool operator()(GridPoint a, GridPoint b) const {
    return std::pair{a.y, a.x} < std::pair{b.y, b.x};
  }
};

class LinedMesh {
 public:
  LinedMesh(const HeightGrid& grid, const Window& window, const WaterHeight& water)
      : grid_(grid), window_(window), water_(water) {
    GridTriangles full = triangulate(grid, window);
    result_.samples = std::move(full.vertices);
    plain_ = std::move(full.triangles);
    number_.resize(static_cast<std::size_t>(window.columns * window.rows), kNone);
    for (std::uint32_t v = 0; v < result_.samples.size(); ++v) {
      number_[place(result_.samples[v].column - window.column,
                    result_.samples[v].row - window.row)] = v;
    }
  }

  void add(const FeatureLine& line) {
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      const Piece piece{grid_point(line.points[i]), grid_point(line.points[i + 1]), line.height_m};
      for (const CellId& cell : cells_of(piece)) {
        const std::optional<Piece> part = clipped(piece, cell);
        if (!part) continue;
        for (const GridPoint p : {part->from, part->to}) touch(p, line.height_m);
        cells_[cell].pieces.push_back(*part);
        break;
      }
      // what a line beside the window does on its border is done on both sides of that
      for (const GridPoint p : {piece.from, piece.to}) {
        if (is_on_border(p)) touch(p, line.height_m);
      }
    }
  }

  LinedTriangles finish() {
    for (const Corners& t : plain_) {
      const auto at = cells_.find(cell_of(t));
      (at == cells_.end() ? result_.triangles : at->second.triangles).push_back(t);
    }
    for (auto& [id, cell] : cells_) triangulate_cell(cell);
    result_.edges.assign(edges_.begin(), edges_.end());
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::size_t place(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * window_.columns + column);
  }

  GridPoint grid_point(const GridPosition& p) const {
    return {static_cast<std::int32_t>(
                std::lround((p.column - static_cast<double>(window_.column)) * kUnitsPerCell)),
            static_cast<std::int32_t>(
                -std::lround((p.row - static_cast<double>(window_.row)) * kUnitsPerCell))};
  }

  bool is_on_border(GridPoint p) const {
    const std::int64_t last_x = (window_.columns - 1) * kUnitsPerCell;
    const std::int64_t last_y = (window_.rows - 1) * kUnitsPerCell;
    const std::int64_t x = p.x, y = -std::int64_t{p.y};
    return x >= 0 && y >= 0 && x <= last_x && y <= last_y &&
           (x == 0 || y == 0 || x == last_x || y == last_y);
  }

  GridPoint plan_of(std::uint32_t vertex) const {
    const auto samples = static_cast<std::uint32_t>(result_.samples.size());
    if (vertex >= samples) return result_.line_vertices[vertex - samples].plan;
    const SampleId& s = result_.samples[vertex];
    return {static_cast<std::int32_t>((s.column - window_.column) * kUnitsPerCell),
            static_cast<std::int32_t>(-(s.row - window_.row) * kUnitsPerCell)};
  }

  bool is_sample(std::int64_t column, std::int64_t row) const {
    return column >= 0 && row >= 0 && column < window_.columns && row < window_.rows &&
           number_[place(column, row)] != kNone;
  }

  /// The cells that a piece lies in or on the side of, those with four samples first.
  std::vector<CellId> cells_of(const Piece& piece) const {
    const std::int64_t x = std::int64_t{piece.from.x} + piece.to.x;
    const std::int64_t y = -(std::int64_t{piece.from.y} + piece.to.y);
    constexpr std::int64_t kTwoCells = 2 * kUnitsPerCell;
    const CellId cell{floor_div(y, kTwoCells), floor_div(x, kTwoCells)};
    std::vector<CellId> cells{cell};
    if (piece.from.x == piece.to.x && x % kTwoCells == 0) {
      cells.push_back({cell.row, cell.column - 1});
    }
    if (piece.from.y == piece.to.y && y % kTwoCells == 0) {
      cells.push_back({cell.row - 1, cell.column});
    }
    std::ranges::stable_sort(cells, std::greater{},
                             [this](const CellId& c) { return missing_of(c).size() == 0; });
    return cells;
  }

  /// Corners of a cell without data, as steps from its first sample.
  std::vector<SampleId> missing_of(const CellId& cell) const {
    std::vector<SampleId> missing;
    for (const SampleId step : {SampleId{0, 0}, SampleId{1, 0}, SampleId{0, 1}, SampleId{1, 1}}) {
      if (!is_sample(cell.column + step.column, cell.row + step.row)) missing.push_back(step);
    }
    return missing;
  }

  /// What of a piece lies on the triangles of a cell: all of it, or what is on this side of the
  /// diagonal beyond which a sample is missing.
  std::optional<Piece> clipped(Piece piece, const CellId& cell) const {
    const std::vector<SampleId> missing = missing_of(cell);
    if (missing.empty()) return piece;
    if (missing.size() > 1) return std::nullopt;
    const bool at_last_column = missing[0].column == 1, at_last_row = missing[0].row == 1;
    // steps from the corner opposite to the missing one, along columns and rows
    const auto steps = [&](GridPoint p) {
      const std::int64_t u = p.x - cell.column * kUnitsPerCell;
      const std::int64_t v = -p.y - cell.row * kUnitsPerCell;
      return std::pair{at_last_column ? u : kUnitsPerCell - u, at_last_row ? v : kUnitsPerCell - v};
    };
    const auto beyond = [&](GridPoint p) {
      const auto [u, v] = steps(p);
      return u + v - kUnitsPerCell;
    };
    const std::int64_t from = beyond(piece.from), to = beyond(piece.to);
    if (from <= 0 && to <= 0) return piece;
    if (from >= 0 && to >= 0) return std::nullopt;
    const double t = static_cast<double>(from) / static_cast<double>(from - to);
    const auto x = static_cast<std::int32_t>(
        std::lround(piece.from.x + t * (static_cast<double>(piece.to.x) - piece.from.x)));
    // exactly on the diagonal, whatever the rounding
    const std::int64_t u = steps({x, 0}).first, v = kUnitsPerCell - u;
    const std::int64_t row = cell.row * kUnitsPerCell + (at_last_row ? v : kUnitsPerCell - v);
    (from > 0 ? piece.from : piece.to) = {x, static_cast<std::int32_t>(-row)};
    if (piece.from == piece.to) return std::nullopt;
    return piece;
  }

  static std::int64_t floor_div(std::int64_t a, std::int64_t b) {
    return a / b - (a % b != 0 && a < 0 ? 1 : 0);
  }

  /// Tells every cell that a point lies in or on. Where another line meets a shore, the water's
  /// height stands; where two shores do, that of the later.
  void touch(GridPoint p, const std::optional<double>& shore_m) {
    if (shore_m) shore_[p] = *shore_m;
    const std::int64_t x = p.x, y = -std::int64_t{p.y};
    const std::int64_t column = floor_div(x, kUnitsPerCell), row = floor_div(y, kUnitsPerCell);
    for (std::int64_t r = y % kUnitsPerCell == 0 ? row - 1 : row; r <= row; ++r) {
      for (std::int64_t c = x % kUnitsPerCell == 0 ? column - 1 : column; c <= column; ++c) {
        cells_[{r, c}].points.push_back(p);
      }
    }
  }

  CellId cell_of(const Corners& t) const {
    CellId cell{window_.rows, window_.columns};
    for (const std::uint32_t v : t) {
      cell.row = std::min<std::int64_t>(cell.row, result_.samples[v].row - window_.row);
      cell.column = std::min<std::int64_t>(cell.column, result_.samples[v].column - window_.column);
    }
    return cell;
  }

  void triangulate_cell(CellLines& cell) {
    if (cell.triangles.empty()) return;
    std::vector<std::uint32_t> vertices;  // of the mesh, by local number
    std::vector<GridPoint> corners;
    std::vector<Corners> local = cell.triangles;
    for (Corners& t : local) {
      for (std::uint32_t& v : t) {
        const auto known = std::ranges::find(vertices, v);
        const auto number = static_cast<std::uint32_t>(known - vertices.begin());
        if (known == vertices.end()) {
          vertices.push_back(v);
          corners.push_back(plan_of(v));
        }
        v = number;
      }
    }
    CellTriangulation work(corners, std::move(local));
    // a point on a side may have come from the cell beside it, where this one has no triangle
    for (const GridPoint p : cell.points) {
      if (work.covers(p)) work.insert(p);
    }
    for (const Piece& piece : cell.pieces)
      work.join(work.insert(piece.from), work.insert(piece.to));
    work.make_delaunay();
    for (std::size_t i = vertices.size(); i < work.points().size(); ++i) {
      vertices.push_back(vertex_at(work.points()[i], cell));
    }
    for (const Corners& t : work.triangles()) {
      result_.triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
    }
    for (const auto& [a, b] : work.edges()) {
      edges_.insert({std::min(vertices[a], vertices[b]), std::max(vertices[a], vertices[b])});
    }
  }

  std::uint32_t vertex_at(GridPoint plan, const CellLines& cell) {
    const auto next =
        static_cast<std::uint32_t>(result_.samples.size() + result_.line_vertices.size());
    const auto [at, is_new] = line_vertex_.emplace(plan, next);
    if (is_new) {
      const std::optional<double> water_m = water_height_m(plan, cell);
      result_.line_vertices.push_back({plan, water_m ? *water_m : height_on(cell.triangles, plan)});
    }
    return at->second;
  }

  /// Of a point on a shore, or where another line has crossed one (rounding puts that beside it),
  /// or in water.
  std::optional<double> water_height_m(GridPoint plan, const CellLines& cell) const {
    if (const auto known = shore_.find(plan); known != shore_.end()) return known->second;
    constexpr double kRounding = 2;
    for (const Piece& piece : cell.pieces) {
      const double length = std::hypot(static_cast<double>(piece.to.x) - piece.from.x,
                                       static_cast<double>(piece.to.y) - piece.from.y);
      const auto area = static_cast<double>(orient2d(piece.from, piece.to, plan));
      if (piece.height_m && std::abs(area) <= kRounding * length) return piece.height_m;
    }
    // beside a shore the cell's triangle leads up from it
    if (!water_) return std::nullopt;
    return water_({static_cast<double>(window_.column) + column_of(plan),
                   static_cast<double>(window_.row) + row_of(plan)});
  }

  /// The height at a point of the triangle that it lies in or on.
  double height_on(std::span<const Corners> triangles, GridPoint p) const {
    for (const Corners& t : triangles) {
      const GridPoint a = plan_of(t[0]), b = plan_of(t[1]), c = plan_of(t[2]);
      const std::int64_t wa = orient2d(b, c, p), wb = orient2d(c, a, p), wc = orient2d(a, b, p);
      if (wa < 0 || wb < 0 || wc < 0) continue;
      return (static_cast<double>(wa) * height_m(t[0]) + static_cast<double>(wb) * height_m(t[1]) +
              static_cast<double>(wc) * height_m(t[2])) /
             static_cast<double>(wa + wb + wc);
    }
    return 0;  // insert() has refused it
  }

  double height_m(std::uint32_t sample) const {
    return grid_.at(result_.samples[sample].column, result_.samples[sample].row);
  }

  const HeightGrid& grid_;
  Window window_;
  const WaterHeight& water_;
  LinedTriangles result_;
  std::vector<Corners> plain_;
  std::vector<std::uint32_t> number_;
  std::map<CellId, CellLines> cells_;
  std::map<GridPoint, double, PlanOrder> shore_;
  std::map<GridPoint, std::uint32_t, PlanOrder> line_vertex_;
  std::set<LineEdge> edges_;
};

}  // namespace

LinedTriangles triangulate_with_lines(const HeightGrid& grid, const Window& window,
                                      std::span<const FeatureLine> lines,
                                      const WaterHeight& water) {
  if (lines.empty()) {
    GridTriangles full = triangulate(grid, window);
    return {std::move(full.vertices), {}, std::move(full.triangles), {}};
  }
  LinedMesh mesh(grid, window, water);
  for (const FeatureLine& line : lines) mesh.add(line);
  return mesh.finish();
}

std::vector<BorderPlace> places_of(const LinedTriangles& full, const Window& window) {
  std::vector<BorderPlace> places(full.samples.begin(), full.samples.end());
  for (const LineVertex& vertex : full.line_vertices) {
    places.emplace_back(static_cast<double>(window.column) + column_of(vertex.plan),
                        static_cast<double>(window.row) + row_of(vertex.plan));
  }
  return places;
}

}  // namespace terrane::hierarchy
