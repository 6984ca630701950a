#include "tiler/tile/blend_check.h"

#include <array>

#include "hierarchy/collapse/moving_triangle.h"
#include "tiler/tile/datum_heights.h"
#include "tiler/tile/reference.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldPoint;
using hierarchy::FieldSample;
using hierarchy::SampleField;

/// A patch of a tile, and where it begins there.
class PatchField {
 public:
  PatchField(const TileSamples& samples, const Window& patch, const HeightGrid& grid,
             const TileFrame& frame, double slack_cells)
      : first_column_(static_cast<double>(patch.column - samples.window().column)),
        first_row_(static_cast<double>(patch.row - samples.window().row)),
        field_{patch.columns, patch.rows, {}} {
    field_.slack_cells = slack_cells;
    const DatumHeights heights{grid, samples.window(), frame};
    for (std::int64_t row = 0; row < patch.rows; ++row) {
      for (std::int64_t column = 0; column < patch.columns; ++column) {
        field_.heights_m.push_back(heights.at(patch.column + column, patch.row + row));
      }
    }
  }

  const SampleField& field() const { return field_; }
  FieldPoint local(const hierarchy::Place& place) const {
    return {hierarchy::column_of(place.plan) - first_column_,
            hierarchy::row_of(place.plan) - first_row_, place.height_m};
  }
  FieldSample in_tile(const FieldSample& sample) const {
    return {static_cast<float>(sample.column + first_column_),
            static_cast<float>(sample.row + first_row_), sample.height_m};
  }

 private:
  double first_column_, first_row_;
  SampleField field_;
};

void add_left(const std::array<FieldPoint, 3>& from, const std::array<FieldPoint, 3>& to,
              const PatchField& patch, double tolerance_m, std::vector<FieldSample>& left) {
  const SampleField& field = patch.field();
  const hierarchy::MovingTriangle moving(from, to, field.slack_cells);
  if (moving.stays_within(field, tolerance_m)) return;
  const FieldPoint corners[] = {from[0], from[1], from[2], to[0], to[1], to[2]};
  hierarchy::for_each_span_of_hull(
      corners, {field.columns, field.rows}, field.slack_cells,
      [&](std::int64_t row, std::int64_t first, std::int64_t last) {
        for (std::int64_t column = first; column <= last; ++column) {
          const FieldSample sample{static_cast<float>(column), static_cast<float>(row),
                                   field.row(row)[column]};
          const bool has_height = sample.height_m == sample.height_m;
          if (has_height && !moving.stays_within(sample, kNotedShare * tolerance_m)) {
            left.push_back(patch.in_tile(sample));
          }
        }
        return true;
      });
}

}  // namespace

std::vector<FieldSample> samples_left_by(const Blend& blend, const TileSamples& samples,
                                         const TileFrame& frame, double slack_cells,
                                         double tolerance_m) {
  std::vector<std::vector<FieldSample>> in_patch(samples.patch_count());
  samples.for_each_patch([&](std::size_t k, const Window& window, const HeightGrid& grid) {
    const PatchField patch(samples, window, grid, frame, slack_cells);
    for (const hierarchy::Corners& corners : blend.triangles) {
      std::array<FieldPoint, 3> from, to;
      for (std::size_t i = 0; i < 3; ++i) {
        from[i] = patch.local(blend.from[corners[i]]);
        to[i] = patch.local(blend.to[corners[i]]);
      }
      add_left(from, to, patch, tolerance_m, in_patch[k]);
    }
  });
  std::vector<FieldSample> left;
  for (const auto& part : in_patch) left.insert(left.end(), part.begin(), part.end());
  return left;
}

}  // namespace terrane::tiler
