#include "hierarchy/mesh/grid_triangles.h"

#include <array>

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kUnused = ~std::uint32_t{0};

/// Samples of a cell:  0 ─ 3   (columns to the right, rows downward)
///                     │   │
///                     1 ─ 2
using Cell = std::array<SampleId, 4>;

Cell cell_at(std::int64_t column, std::int64_t row) {
  const auto c = static_cast<std::int32_t>(column), r = static_cast<std::int32_t>(row);
  return {{{c, r}, {c, r + 1}, {c + 1, r + 1}, {c + 1, r}}};
}

bool runs_against_the_rule(const Window& window, std::int64_t column, std::int64_t row) {
  const bool first_column = column == window.column;
  const bool last_column = column == window.column + window.columns - 2;
  const bool first_row = row == window.row;
  const bool last_row = row == window.row + window.rows - 2;
  return (last_column && first_row && !first_column) || (first_column && last_row && !last_column);
}

class Triangulation {
 public:
  explicit Triangulation(const Window& window)
      : window_(window), number_(static_cast<std::size_t>(window.columns * window.rows), kUnused) {}

  void add(SampleId a, SampleId b, SampleId c) {
    corners_.push_back({place(a), place(b), place(c)});
    for (const std::uint32_t p : corners_.back()) number_[p] = 0;
  }

  GridTriangles finish() {
    GridTriangles result;
    for (std::uint32_t p = 0; p < number_.size(); ++p) {
      if (number_[p] == kUnused) continue;
      number_[p] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back({static_cast<std::int32_t>(window_.column + p % window_.columns),
                                 static_cast<std::int32_t>(window_.row + p / window_.columns)});
    }
    for (Corners& corners : corners_) {
      for (std::uint32_t& corner : corners) corner = number_[corner];
    }
    result.triangles = std::move(corners_);
    return result;
  }

 private:
  std::uint32_t place(SampleId s) const {
    return static_cast<std::uint32_t>((s.row - window_.row) * window_.columns + s.column -
                                      window_.column);
  }

  Window window_;
  std::vector<std::uint32_t> number_;
  std::vector<Corners> corners_;
};

}  // namespace

GridTriangles triangulate(const HeightGrid& grid, const Window& window) {
  Triangulation result(window);
  for (std::int64_t row = window.row; row + 1 < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column + 1 < window.column + window.columns;
         ++column) {
      const Cell cell = cell_at(column, row);
      int missing = 0;
      int missing_count = 0;
      for (int k = 0; k < 4; ++k) {
        if (grid.has_data(cell[k].column, cell[k].row)) continue;
        missing = k;
        ++missing_count;
      }
      if (missing_count > 1) continue;
      if (missing_count == 1) {
        result.add(cell[(missing + 1) % 4], cell[(missing + 2) % 4], cell[(missing + 3) % 4]);
      } else if (runs_against_the_rule(window, column, row)) {
        result.add(cell[0], cell[1], cell[3]);
        result.add(cell[1], cell[2], cell[3]);
      } else {
        result.add(cell[0], cell[1], cell[2]);
        result.add(cell[0], cell[2], cell[3]);
      }
    }
  }
  return result.finish();
}

}  // namespace terrane::hierarchy
