#include "tiler/tile/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/within_task.h"
#include "tiler/tile/inner_columns.h"
#include "tiler/tile/plane_along_row.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldPoint;
using hierarchy::FieldSample;

constexpr double kOnEdge = 1e-7;  // as a share of a triangle

// a vertex's place over the grid is rounded to whole units, so a triangle may lie beside its own
// plan by that: who looks for its samples looks as far
constexpr double kPlanRounding_cells = 1.0 / hierarchy::kUnitsPerCell;

/// A triangle in the world, met by plumb lines as by rays (Moeller and Trumbore 1997).
class PlumbTriangle {
 public:
  PlumbTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : corner_(a), side_b_(b - a), side_c_(c - a) {}

  /// Height along the plumb line at which the triangle is met; none if it is not.
  /// \param beside  where lines that pass beside the triangle count, as a share of it.
  std::optional<double> height_m(const Plumb& plumb, double beside = kOnEdge) const {
    const Eigen::Vector3d p = plumb.up.cross(side_c_);
    const Eigen::Vector3d s = plumb.base - corner_;
    const Eigen::Vector3d q = s.cross(side_b_);
    const double scale = 1 / side_b_.dot(p);
    const double u = s.dot(p) * scale, v = plumb.up.dot(q) * scale;
    if (u < -beside || v < -beside || u + v > 1 + beside) return std::nullopt;
    return side_c_.dot(q) * scale;
  }

  const Eigen::Vector3d& corner() const { return corner_; }
  Eigen::Vector3d normal() const { return side_b_.cross(side_c_); }

  /// How much it rises over a metre across the plumb line.
  double rise(const Eigen::Vector3d& up) const {
    const Eigen::Vector3d n = normal();
    const double upright = n.dot(up);
    return (n - upright * up).norm() / std::abs(upright);
  }
  /// Smallest altitude seen along the plumb line.
  double altitude_m(const Eigen::Vector3d& up) const {
    const double longest2 =
        std::max({side_b_.cross(up).squaredNorm(), side_c_.cross(up).squaredNorm(),
                  (side_c_ - side_b_).cross(up).squaredNorm()});
    return std::abs(normal().dot(up)) / std::sqrt(longest2);
  }

 private:
  Eigen::Vector3d corner_, side_b_, side_c_;
};

FieldSample field_sample(const LooseSample& loose, const TileFrame& frame) {
  return {static_cast<float>(loose.column), static_cast<float>(loose.row),
          loose.height_m - frame.drop_m(loose.column, loose.row)};
}

/// The samples of a patch, and where they stand in the world.
class Patch {
 public:
  Patch(const TileFrame& frame, const Window& tile, const Window& patch, const HeightGrid& grid)
      : window(patch),
        first_column(patch.column - tile.column),
        first_row(patch.row - tile.row),
        frame_(frame),
        grid_(grid) {
    for (std::int64_t row = 0; row < patch.rows; ++row) {
      rows_.push_back(frame.row(static_cast<double>(first_row + row)));
    }
  }

  /// Columns and rows count from the patch's first sample here.
  Plumb plumb(std::int64_t column, std::int64_t row) const {
    return rows_[static_cast<std::size_t>(row)].plumb(static_cast<double>(first_column + column));
  }
  double height_m(std::int64_t column, std::int64_t row) const {
    return grid_.at(window.column + column, window.row + row);
  }
  const TileFrame::Row& row(std::int64_t row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// Heights of a row from some column on.
  const float* heights_m(std::int64_t column, std::int64_t row) const {
    const Window& of_grid = grid_.window;
    return grid_.heights_m.data() + (window.row + row - of_grid.row) * of_grid.columns +
           window.column + column - of_grid.column;
  }
  /// The k-th sample, row by row, for a SampleField of the tile.
  FieldSample sample(std::size_t k) const {
    const auto column = static_cast<std::int64_t>(k) % window.columns;
    const auto row = static_cast<std::int64_t>(k) / window.columns;
    const auto c = static_cast<double>(first_column + column);
    const auto r = static_cast<double>(first_row + row);
    return {static_cast<float>(c), static_cast<float>(r),
            height_m(column, row) - frame_.drop_m(c, r)};
  }
  FieldPoint local(const FieldPoint& tile_place) const {
    return {tile_place.column - static_cast<double>(first_column),
            tile_place.row - static_cast<double>(first_row), 0};
  }

  const Window window;
  const std::int64_t first_column, first_row;  // in the tile

 private:
  const TileFrame& frame_;
  const HeightGrid& grid_;
  std::vector<TileFrame::Row> rows_;
};

/// The loose samples of a patch, cell by cell, and where they stand in the world.
class LoosePatch {
 public:
  LoosePatch(const TileFrame& frame, const TileSamples& samples, const Window& patch)
      : first_column_(patch.column - samples.window().column - kMargin),
        first_row_(patch.row - samples.window().row - kMargin),
        cells_{patch.columns + 2 * kMargin, patch.rows + 2 * kMargin},
        samples_(samples.loose_in(patch, kMargin)) {
    std::ranges::stable_sort(samples_, {}, [&](const LooseSample& s) { return cell_of(s); });
    first_.assign(static_cast<std::size_t>(cells_.columns * cells_.rows) + 1, 0);
    for (const LooseSample& sample : samples_) {
      ++first_[static_cast<std::size_t>(cell_of(sample)) + 1];
      plumbs_.push_back(frame.plumb(sample.column, sample.row));
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  const std::vector<LooseSample>& samples() const { return samples_; }
  const Plumb& plumb(std::size_t k) const { return plumbs_[k]; }

  /// Calls visit(k) for the samples that may lie under a triangle.
  template <class Visit>
  void for_each_near(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                     double slack_cells, const Visit& visit) const {
    if (samples_.empty()) return;
    // a cell reaches to the next post
    for_each_span(local(a), local(b), local(c), cells_, 1 + slack_cells,
                  [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                    const auto begin = static_cast<std::size_t>(row * cells_.columns + first);
                    const auto end = static_cast<std::size_t>(row * cells_.columns + last + 1);
                    for (std::size_t k = first_[begin]; k < first_[end]; ++k) visit(k);
                    return true;
                  });
  }

 private:
  // straight edges in the world lie beside the straight border over the grid: a neighbour's samples
  // may be under them
  static constexpr std::int64_t kMargin = 1;

  std::int64_t cell_of(const LooseSample& sample) const {
    const FieldPoint at = local({sample.column, sample.row, 0});
    return static_cast<std::int64_t>(at.row) * cells_.columns +
           static_cast<std::int64_t>(at.column);
  }
  FieldPoint local(const FieldPoint& tile_place) const {
    return {tile_place.column - static_cast<double>(first_column_),
            tile_place.row - static_cast<double>(first_row_), 0};
  }

  std::int64_t first_column_, first_row_;  // in the tile
  GridShape cells_;
  std::vector<LooseSample> samples_;  // by cell
  std::vector<Plumb> plumbs_;
  std::vector<std::size_t> first_;
};

/// How much the map of a tile bends in plan: a line that is straight over the grid lies beside the
/// straight one in the world by an eighth of its length squared times the second derivative.
class Bend {
 public:
  Bend(const TileFrame& frame, const Window& tile) {
    const auto columns = static_cast<double>(tile.columns - 1);
    const auto rows = static_cast<double>(tile.rows - 1);
    const double u = std::max(1.0, columns / kProbes), v = std::max(1.0, rows / kProbes);
    for (int j = 1; j < kProbes; ++j) {
      for (int i = 1; i < kProbes; ++i) add(frame, columns * i / kProbes, rows * j / kProbes, u, v);
    }
    const auto is_a_point = [&](double row) {
      const Eigen::Vector3d along = frame.plumb(columns, row).base - frame.plumb(0, row).base;
      return along.norm() < kShareAtPole * columns * frame.spacing_m();
    };
    meets_pole_ = is_a_point(0) || is_a_point(rows);
  }

  /// Is one of the tile's border rows a single place? Triangles there have other samples than over
  /// the grid, or none.
  bool meets_pole() const { return meets_pole_; }

  /// The most that an edge of so many columns and rows may lie beside, in cells.
  double cells(double columns, double rows) const {
    constexpr double kToBeSure = 2;
    return kToBeSure / 8 *
           (columns_ * columns * columns + 2 * both_ * std::abs(columns * rows) +
            rows_ * rows * rows);
  }

 private:
  static constexpr int kProbes = 6;
  static constexpr double kShareAtPole = 0.001;

  void add(const TileFrame& frame, double column, double row, double u, double v) {
    const Eigen::Vector3d up = frame.plumb(column, row).up;
    const auto base = [&](double i, double j) {
      return frame.plumb(column + i * u, row + j * v).base;
    };
    const auto flat_cells = [&](const Eigen::Vector3d& bend) {
      return (bend - bend.dot(up) * up).norm() / frame.spacing_m();
    };
    const Eigen::Vector3d here = base(0, 0);
    columns_ = std::max(columns_, flat_cells(base(1, 0) + base(-1, 0) - 2 * here) / (u * u));
    rows_ = std::max(rows_, flat_cells(base(0, 1) + base(0, -1) - 2 * here) / (v * v));
    both_ = std::max(
        both_, flat_cells(base(1, 1) + base(-1, -1) - base(1, -1) - base(-1, 1)) / (4 * u * v));
  }

  double columns_ = 0, both_ = 0, rows_ = 0;  // largest second derivatives, 1 / cell
  bool meets_pole_ = false;
};

/// The errors of one mesh at the samples of one patch.
class Measurement {
 public:
  Measurement(const TileFrame& frame, const Bend& bend, double step_m, const Patch& patch,
              const LoosePatch& loose)
      : frame_(frame),
        bend_(bend),
        step_m_(step_m),
        patch_(patch),
        loose_(loose),
        shape_{patch.window.columns, patch.window.rows},
        worst_m_(static_cast<std::size_t>(shape_.columns * shape_.rows), kUnmeasured),
        worst_at_loose_m_(loose.samples().size(), kUnmeasured) {}

  void add_triangle(const WorldVertex& a, const WorldVertex& b, const WorldVertex& c) {
    if (is_beside(a.plan, b.plan, c.plan)) return;
    const PlumbTriangle triangle(a.world, b.world, c.world);
    const double slack_cells =
        kPlanRounding_cells + std::max({bend_cells(a, b), bend_cells(b, c), bend_cells(c, a)});
    const FieldPoint p = patch_.local(a.plan), q = patch_.local(b.plan), r = patch_.local(c.plan);
    const Reach reach = reach_of(triangle, frame_.plumb(a.plan.column, a.plan.row).up);
    const InnerColumns inner(p, q, r, slack_cells);
    for_each_span(p, q, r, shape_, slack_cells,
                  [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                    const auto [begin, end] = inner.of_row(row, first, last);
                    if (end - begin < kFewColumns || bend_.meets_pole() || reach.is_steep) {
                      add_one_by_one(triangle, reach, row, first, last);
                    } else {
                      add_one_by_one(triangle, reach, row, first, begin - 1);
                      add_inner(triangle, row, begin, end);
                      add_one_by_one(triangle, reach, row, end + 1, last);
                    }
                    return true;
                  });
    loose_.for_each_near(a.plan, b.plan, c.plan, slack_cells, [&](std::size_t k) {
      const auto height_m = triangle.height_m(loose_.plumb(k), reach.beside);
      if (!height_m) return;
      const double error_m = std::abs(*height_m - loose_.samples()[k].height_m);
      worst_at_loose_m_[k] = std::max(worst_at_loose_m_[k], error_m);
      note_steep(reach, error_m);
    });
  }

  /// Measures what no triangle covers, but lies within a step of the rim: against its nearest
  /// point.
  void add_rim(const MeasuredMesh& mesh) {
    std::map<std::size_t, NearRim> near;
    for (const auto& [a, b] : mesh.rim) find_near(mesh.vertices[a], mesh.vertices[b], near);
    for (const auto& [sample, nearest] : near) worst_m_[sample] = nearest.error_m;
  }

  /// The samples that the mesh is farther from than this; loose ones count on from the grid's.
  std::vector<std::size_t> farther_than(double noted_m) const {
    std::vector<std::size_t> samples;
    for (std::size_t k = 0; k < worst_m_.size(); ++k) {
      if (worst_m_[k] > noted_m) samples.push_back(k);
    }
    for (std::size_t k = 0; k < worst_at_loose_m_.size(); ++k) {
      if (worst_at_loose_m_[k] > noted_m) samples.push_back(worst_m_.size() + k);
    }
    return samples;
  }

  MeasuredError result() const {
    MeasuredError result;
    for (const auto* worst_m : {&worst_m_, &worst_at_loose_m_}) {
      for (const double error_m : *worst_m) {
        if (error_m == kUnmeasured) continue;
        result.max_m = std::max(result.max_m, error_m);
        result.sum_of_squares_m2 += error_m * error_m;
        ++result.samples;
      }
    }
    // heights are taken at the frame's places, which are off by a little, and a slope adds as often
    // as much as it rises
    result.max_m += (1 + kGentle) * frame_.accuracy_m();
    result.max_m = std::max(result.max_m, steep_max_m_);
    return result;
  }

 private:
  static constexpr double kUnmeasured = -1;
  // in a row, that it does not pay to find a polynomial for
  static constexpr std::int64_t kFewColumns = 3;
  // what triangles rise over a metre that are measured as if all were so
  static constexpr double kGentle = 3;

  /// What the frame may be off where a triangle is met.
  struct Reach {
    bool is_steep = false;
    double off_m = 0;         ///< in height
    double beside = kOnEdge;  ///< in plan, as a share of the triangle
  };

  Reach reach_of(const PlumbTriangle& triangle, const Eigen::Vector3d& up) const {
    const double rise = triangle.rise(up);
    if (!(rise > kGentle)) return {};
    // written triangles are some lattice steps thick, but at a pole they have no area
    const double off_m = frame_.accuracy_m(), altitude_m = triangle.altitude_m(up);
    if (!(altitude_m > off_m)) return {};
    return {true, (1 + rise) * off_m, std::max(kOnEdge, off_m / altitude_m)};
  }

  void note_steep(const Reach& reach, double error_m) {
    if (reach.is_steep) steep_max_m_ = std::max(steep_max_m_, error_m + reach.off_m);
  }

  /// Those that the triangle may be beside of, too.
  void add_one_by_one(const PlumbTriangle& triangle, const Reach& reach, std::int64_t row,
                      std::int64_t first, std::int64_t last) {
    for (std::int64_t column = first; column <= last; ++column) {
      const auto height_m = triangle.height_m(patch_.plumb(column, row), reach.beside);
      if (height_m) add(column, row, *height_m, reach);
    }
  }

  void add_inner(const PlumbTriangle& triangle, std::int64_t row, std::int64_t first,
                 std::int64_t last) {
    const auto count = static_cast<std::size_t>(last - first + 1);
    const PlaneAlongRow plane(patch_.row(row), triangle.corner(), triangle.normal());
    plane.raise_errors(patch_.first_column + first, {patch_.heights_m(first, row), count},
                       {&worst_m(first, row), count});
  }

  /// The nearest point of the rim to a sample beside it.
  struct NearRim {
    double distance_m = std::numeric_limits<double>::infinity();
    double error_m = 0;
  };

  void find_near(const WorldVertex& a, const WorldVertex& b,
                 std::map<std::size_t, NearRim>& near) const {
    const FieldPoint from = patch_.local(a.plan), to = patch_.local(b.plan);
    const double reach = step_m_ / frame_.spacing_m();
    const auto first_column = std::ceil(std::min(from.column, to.column) - reach);
    const auto last_column = std::floor(std::max(from.column, to.column) + reach);
    const auto first_row = std::ceil(std::min(from.row, to.row) - reach);
    const auto last_row = std::floor(std::max(from.row, to.row) + reach);
    for (double row = std::max(0.0, first_row);
         row <= std::min(last_row, static_cast<double>(shape_.rows - 1)); ++row) {
      for (double column = std::max(0.0, first_column);
           column <= std::min(last_column, static_cast<double>(shape_.columns - 1)); ++column) {
        find_near(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row), a, b, near);
      }
    }
  }

  /// Does the triangle lie wholly beside the patch, with room to spare for slack?
  bool is_beside(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c) const {
    constexpr double kRoom = 2;
    const FieldPoint p = patch_.local(a), q = patch_.local(b), r = patch_.local(c);
    return std::min({p.column, q.column, r.column}) > static_cast<double>(shape_.columns) + kRoom ||
           std::max({p.column, q.column, r.column}) < -kRoom ||
           std::min({p.row, q.row, r.row}) > static_cast<double>(shape_.rows) + kRoom ||
           std::max({p.row, q.row, r.row}) < -kRoom;
  }

  double& worst_m(std::int64_t column, std::int64_t row) {
    return worst_m_[static_cast<std::size_t>(row * shape_.columns + column)];
  }

  /// How far the straight edge in the world may lie beside the straight line over the grid.
  double bend_cells(const WorldVertex& a, const WorldVertex& b) const {
    return bend_.cells(b.plan.column - a.plan.column, b.plan.row - a.plan.row);
  }

  /// A sample on an edge is under two triangles: the worse one stays, and it counts once.
  void add(std::int64_t column, std::int64_t row, double on_mesh_m, const Reach& reach) {
    const double height_m = patch_.height_m(column, row);
    if (std::isnan(height_m)) return;
    const double error_m = std::abs(on_mesh_m - height_m);
    worst_m(column, row) = std::max(worst_m(column, row), error_m);
    note_steep(reach, error_m);
  }

  void find_near(std::int64_t column, std::int64_t row, const WorldVertex& a, const WorldVertex& b,
                 std::map<std::size_t, NearRim>& near) const {
    const auto sample = static_cast<std::size_t>(row * shape_.columns + column);
    const double height_m = patch_.height_m(column, row);
    if (worst_m_[sample] != kUnmeasured || std::isnan(height_m)) return;
    const Plumb plumb = patch_.plumb(column, row);
    const auto flat = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
      return v - v.dot(plumb.up) * plumb.up;
    };
    const Eigen::Vector3d from = a.world, along = b.world - from;
    const double length2 = std::max(flat(along).squaredNorm(), 1e-30);
    const double t = std::clamp(flat(plumb.base - from).dot(flat(along)) / length2, 0.0, 1.0);
    const Eigen::Vector3d to_nearest = from + t * along - plumb.base;
    const double distance_m = flat(to_nearest).norm();
    if (distance_m > step_m_) return;
    NearRim& nearest = near[sample];
    if (distance_m >= nearest.distance_m) return;
    nearest = {distance_m, std::abs(to_nearest.dot(plumb.up) - height_m)};
  }

  const TileFrame& frame_;
  const Bend& bend_;
  double step_m_;
  const Patch& patch_;
  const LoosePatch& loose_;
  GridShape shape_;
  std::vector<double> worst_m_;
  std::vector<double> worst_at_loose_m_;
  double steep_max_m_ = 0;  // with what the frame may be off
};

Measurement measured(const MeasuredMesh& mesh, const Patch& patch, const LoosePatch& loose,
                     const TileFrame& frame, const Bend& bend, double step_m) {
  Measurement measurement(frame, bend, step_m, patch, loose);
  for (const auto& [a, b, c] : mesh.triangles) {
    measurement.add_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  }
  measurement.add_rim(mesh);
  return measurement;
}

}  // namespace

Measured measure(std::span<const MeasuredMesh> meshes, const TileSamples& samples,
                 const TileFrame& frame, double step_m, double noted_m) {
  // by patch, and put together in their order: the result then does not depend on the threads
  std::vector<Measured> in_patch(samples.patch_count());
  const Bend bend(frame, samples.window());
  samples.for_each_patch([&](std::size_t k, const Window& window, const HeightGrid& grid) {
    const Patch patch(frame, samples.window(), window, grid);
    const LoosePatch loose(frame, samples, window);
    in_patch[k].errors.resize(meshes.size());
    std::vector<std::vector<std::size_t>> noted(meshes.size());
    hierarchy::for_each_within_task(meshes.size(), [&](std::size_t m) {
      const Measurement measurement = measured(meshes[m], patch, loose, frame, bend, step_m);
      in_patch[k].errors[m] = measurement.result();
      noted[m] = measurement.farther_than(noted_m);
    });
    std::vector<std::size_t> by_any;
    for (const auto& of_mesh : noted) by_any.insert(by_any.end(), of_mesh.begin(), of_mesh.end());
    std::ranges::sort(by_any);
    by_any.erase(std::unique(by_any.begin(), by_any.end()), by_any.end());
    const auto grid_samples = static_cast<std::size_t>(window.columns * window.rows);
    for (const std::size_t i : by_any) {
      in_patch[k].noted.push_back(i < grid_samples
                                      ? patch.sample(i)
                                      : field_sample(loose.samples()[i - grid_samples], frame));
    }
  });
  Measured all{std::vector<MeasuredError>(meshes.size())};
  for (const Measured& patch : in_patch) {
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      all.errors[m].max_m = std::max(all.errors[m].max_m, patch.errors[m].max_m);
      all.errors[m].sum_of_squares_m2 += patch.errors[m].sum_of_squares_m2;
      all.errors[m].samples += patch.errors[m].samples;
    }
    all.noted.insert(all.noted.end(), patch.noted.begin(), patch.noted.end());
  }
  return all;
}

}  // namespace terrane::tiler
