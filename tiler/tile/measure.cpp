#include "tiler/tile/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/within_task.h"
#include "tiler/tile/inner_columns.h"
#include "tiler/tile/map_bend.h"
#include "tiler/tile/measured_patch.h"
#include "tiler/tile/plane_along_row.h"
#include "tiler/tile/plumb_triangle.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldPoint;
using hierarchy::FieldSample;

// a vertex's place over the grid is rounded to whole units, so a triangle may lie beside its own
// plan by that: who looks for its samples looks as far
constexpr double kPlanRounding_cells = 1.0 / hierarchy::kUnitsPerCell;

FieldSample field_sample(const LooseSample& loose, const TileFrame& frame) {
  return {static_cast<float>(loose.column), static_cast<float>(loose.row),
          loose.height_m - frame.drop_m(loose.column, loose.row)};
}

/// The errors of one mesh at the samples of one patch.
class Measurement {
 public:
  Measurement(const TileFrame& frame, const MapBend& bend, double step_m,
              const MeasuredPatch& patch, const LoosePatch& loose)
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
    const Eigen::Vector3d up = frame_.plumb(a.plan.column, a.plan.row).up;
    // written triangles are some lattice steps thick, but where corners meet at a pole
    if (bend_.meets_pole() && !(triangle.altitude_m(up) > frame_.accuracy_m())) return;
    const double slack_cells =
        kPlanRounding_cells + std::max({bend_cells(a, b), bend_cells(b, c), bend_cells(c, a)});
    const FieldPoint p = patch_.local(a.plan), q = patch_.local(b.plan), r = patch_.local(c.plan);
    const Reach reach = reach_of(triangle, up);
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
    const double off_m = frame_.accuracy_m();
    return {true, (1 + rise) * off_m, std::max(kOnEdge, off_m / triangle.altitude_m(up))};
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
  const MapBend& bend_;
  double step_m_;
  const MeasuredPatch& patch_;
  const LoosePatch& loose_;
  GridShape shape_;
  std::vector<double> worst_m_;
  std::vector<double> worst_at_loose_m_;
  double steep_max_m_ = 0;  // with what the frame may be off
};

Measurement measured(const MeasuredMesh& mesh, const MeasuredPatch& patch, const LoosePatch& loose,
                     const TileFrame& frame, const MapBend& bend, double step_m) {
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
  const MapBend bend(frame, samples.window());
  samples.for_each_patch([&](std::size_t k, const Window& window, const HeightGrid& grid) {
    const MeasuredPatch patch(frame, samples.window(), window, grid);
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
