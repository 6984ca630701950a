#include "ingest/mosaic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"

namespace terrane::ingest {
namespace {

// a process may have 1024 files open, and some formats need two each
constexpr std::size_t kOpenFiles = 128;

// formats round origins in the ninth digit and so; a real shift is a good part of a cell
constexpr double kLargestMisfit_cells = 0.01;

Window intersection(const Window& a, const Window& b) {
  const std::int64_t column = std::max(a.column, b.column);
  const std::int64_t row = std::max(a.row, b.row);
  return {column, row, std::min(a.column + a.columns, b.column + b.columns) - column,
          std::min(a.row + a.rows, b.row + b.rows) - row};
}

void paste(const HeightGrid& part, const Window& place, HeightGrid& whole) {
  for (std::int64_t r = 0; r < place.rows; ++r) {
    for (std::int64_t c = 0; c < place.columns; ++c) {
      const float height_m = part.heights_m[static_cast<std::size_t>(r * place.columns + c)];
      if (std::isnan(height_m)) continue;
      const std::int64_t column = place.column + c - whole.window.column;
      const std::int64_t row = place.row + r - whole.window.row;
      whole.heights_m[static_cast<std::size_t>(row * whole.window.columns + column)] = height_m;
    }
  }
}

void refuse_unlike(const RasterFile& first, const RasterFile& other) {
  const auto refuse = [&](const std::string& difference) {
    throw InputError(fmt::format("{}: does not fit {}: {}. Bring them to one grid with gdalwarp",
                                 other.file(), first.file(), difference));
  };
  const RasterFacts& a = first.facts();
  const RasterFacts& b = other.facts();
  if (a.description.band_count != b.description.band_count) {
    refuse(
        fmt::format("it has {} bands, not {}", b.description.band_count, a.description.band_count));
  }
  if (a.crs.IsEmpty() != b.crs.IsEmpty() || (!a.crs.IsEmpty() && !a.crs.IsSame(&b.crs))) {
    const auto name = [](const OGRSpatialReference& crs) {
      return crs.IsEmpty() || crs.GetName() == nullptr ? "none" : crs.GetName();
    };
    refuse(fmt::format("its CRS is {}, not {}", name(b.crs), name(a.crs)));
  }
  if (!a.geotransform || !b.geotransform) refuse("files without a geotransform make no mosaic");
}

// Columns and rows from the first file's origin to the other's.
std::pair<double, double> offset_of(const Geotransform& t, const Geotransform& other) {
  const double x = other[0] - t[0];
  const double y = other[3] - t[3];
  const double area = t[1] * t[5] - t[2] * t[4];
  return {(x * t[5] - y * t[2]) / area, (y * t[1] - x * t[4]) / area};
}

Window window_in(const RasterFile& first, const RasterFile& other) {
  const Geotransform& t = *first.facts().geotransform;
  const Geotransform& u = *other.facts().geotransform;
  const GridShape shape = other.facts().shape;
  const auto [column, row] = offset_of(t, u);
  // the far corner tells whether the cells are alike over the whole file
  const auto cells = static_cast<double>(shape.columns);
  const auto lines = static_cast<double>(shape.rows);
  const Geotransform far = {u[0] + u[1] * cells + u[2] * lines, 0, 0,
                            u[3] + u[4] * cells + u[5] * lines, 0, 0};
  const auto [far_column, far_row] = offset_of(t, far);
  const double misfit_cells =
      std::max({std::abs(column - std::round(column)), std::abs(row - std::round(row)),
                std::abs(far_column - std::round(column) - cells),
                std::abs(far_row - std::round(row) - lines)});
  // NaN is refused too
  if (!(misfit_cells <= kLargestMisfit_cells)) {
    throw InputError(
        fmt::format("{}: does not fit {}: its samples lie {:.3g} cells beside the "
                    "other's grid. Bring them to one grid with gdalwarp",
                    other.file(), first.file(), misfit_cells));
  }
  return {std::llround(column), std::llround(row), shape.columns, shape.rows};
}

}  // namespace

Mosaic::Mosaic(const std::vector<std::string>& sources, const OpenOptions& options) {
  for (const std::string& source : sources) {
    files_.push_back(std::make_unique<RasterFile>(source, options));
    keep_open(files_.size() - 1);
  }
  place_files();
}

void Mosaic::place_files() {
  const RasterFile& first = *files_.front();
  Window whole{0, 0, first.facts().shape.columns, first.facts().shape.rows};
  windows_.push_back(whole);
  for (std::size_t i = 1; i < files_.size(); ++i) {
    refuse_unlike(first, *files_[i]);
    const Window window = window_in(first, *files_[i]);
    windows_.push_back(window);
    const std::int64_t column = std::min(whole.column, window.column);
    const std::int64_t row = std::min(whole.row, window.row);
    whole = {column, row,
             std::max(whole.column + whole.columns, window.column + window.columns) - column,
             std::max(whole.row + whole.rows, window.row + window.rows) - row};
  }
  for (Window& window : windows_) {
    window.column -= whole.column;
    window.row -= whole.row;
  }
  shape_ = {whole.columns, whole.rows};
  geotransform_ = first.facts().geotransform;
  if (!geotransform_) return;
  Geotransform& t = *geotransform_;
  const auto column = static_cast<double>(whole.column);
  const auto row = static_cast<double>(whole.row);
  t[0] += t[1] * column + t[2] * row;
  t[3] += t[4] * column + t[5] * row;
}

HeightGrid Mosaic::read(const Window& window) const {
  if (files_.size() == 1) return files_.front()->read(window);
  HeightGrid grid{window, std::vector<float>(static_cast<std::size_t>(window.columns * window.rows),
                                             kNoHeight)};
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const Window common = intersection(window, windows_[i]);
    if (common.columns <= 0 || common.rows <= 0) continue;
    const HeightGrid part =
        files_[i]->read({common.column - windows_[i].column, common.row - windows_[i].row,
                         common.columns, common.rows});
    keep_open(i);
    paste(part, common, grid);
  }
  return grid;
}

void Mosaic::keep_open(std::size_t file) const {
  const std::lock_guard lock(mutex_);
  recent_.remove(file);
  recent_.push_front(file);
  if (recent_.size() <= kOpenFiles) return;
  files_[recent_.back()]->close();
  recent_.pop_back();
}

}  // namespace terrane::ingest
