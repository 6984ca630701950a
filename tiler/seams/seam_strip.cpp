#include "tiler/seams/seam_strip.h"

#include <algorithm>
#include <cmath>

#include "tiler/seams/join_tiles.h"
#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {
namespace {

using hierarchy::BorderPlace;
using hierarchy::Corners;
using hierarchy::Place;

/// Keeps the triangles that touch the line, and their vertices.
Strip cut_strip(const Strip& all, const Window& line) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(all.borders.size(), kUnused);
  Strip strip;
  for (const Corners& corners : all.triangles) {
    const auto touches = [&](std::uint32_t v) { return contains(line, all.borders[v]); };
    if (std::ranges::none_of(corners, touches)) continue;
    Corners& kept = strip.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& v = number[corners[k]];
      if (v == kUnused) {
        v = static_cast<std::uint32_t>(strip.borders.size());
        strip.borders.push_back(all.borders[corners[k]]);
        strip.is_on_line.push_back(all.is_on_line[corners[k]]);
        if (!all.line_heights_m.empty()) {
          strip.line_heights_m.push_back(all.line_heights_m[corners[k]]);
        }
        if (!all.points.empty()) strip.points.push_back(all.points[corners[k]]);
      }
      kept[k] = v;
    }
  }
  return strip;
}

/// The cells of a tile next to a seam: two on its side, so that the diagonals in the tile's corners
/// run as in the tile itself.
Window beside(Window tile, const SeamId& seam, bool is_first) {
  constexpr std::int64_t kSamples = 3;
  std::int64_t& begin = seam.is_column ? tile.column : tile.row;
  std::int64_t& count = seam.is_column ? tile.columns : tile.rows;
  const std::int64_t kept = std::min(count, kSamples);
  if (is_first) begin += count - kept;
  count = kept;
  return tile;
}

Window unite(const Window& a, const Window& b) {
  const std::int64_t column = std::min(a.column, b.column), row = std::min(a.row, b.row);
  return {column, row, std::max(a.column + a.columns, b.column + b.columns) - column,
          std::max(a.row + a.rows, b.row + b.rows) - row};
}

/// The samples that the triangles of a strip may cover.
Window bounds_of(const Strip& strip, const TileSource& source, const SeamId& seam) {
  const Window both = both_sides(source.pyramid, seam);
  const TileFrame frame(source.world, source.lattice, both, seam.first.level);
  double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
  for (const LatticePoint& point : strip.points) {
    const Place place = frame.place_of_finer(point);
    left = std::min(left, hierarchy::column_of(place.plan));
    right = std::max(right, hierarchy::column_of(place.plan));
    top = std::min(top, hierarchy::row_of(place.plan));
    bottom = std::max(bottom, hierarchy::row_of(place.plan));
  }
  const auto low = [](double at) {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(at)));
  };
  const auto high = [](double at, std::int64_t count) {
    return std::min<std::int64_t>(count - 1, static_cast<std::int64_t>(std::ceil(at)));
  };
  const std::int64_t column = low(left), row = low(top);
  return {both.column + column, both.row + row, high(right, both.columns) - column + 1,
          high(bottom, both.rows) - row + 1};
}

/// All triangles of the tiles, to be cut.
Strip strip_of(JoinedTiles&& joined) {
  Strip strip{.borders = std::move(joined.borders),
              .line_heights_m = {},
              .points = std::move(joined.points),
              .triangles = std::move(joined.triangles),
              .is_on_line = {}};
  strip.is_on_line.resize(strip.borders.size(), 0);
  for (const hierarchy::LineEdge& edge : joined.lines) {
    for (const std::uint32_t v : edge) strip.is_on_line[v] = 1;
  }
  return strip;
}

/// What one tile has beside a seam at full resolution.
struct FullSide {
  TileMesh mesh;
  std::vector<double> line_heights_m;  // of each vertex that a line has between samples; else NaN
};

FullSide full_side(const TileSource& source, const TileId& tile, const HeightGrid& grid,
                   const Window& side) {
  hierarchy::LinedTriangles full =
      hierarchy::triangulate_with_lines(grid, side, lines_of(source, tile), water_of(source));
  FullSide result;
  result.mesh.borders = places_of(full, side);
  result.mesh.points.resize(result.mesh.borders.size());
  result.mesh.water_m.resize(result.mesh.borders.size());
  result.mesh.triangles = std::move(full.triangles);
  result.mesh.lines = std::move(full.edges);
  result.line_heights_m.resize(full.samples.size(), NAN);
  for (const hierarchy::LineVertex& v : full.line_vertices) {
    result.line_heights_m.push_back(v.height_m);
  }
  return result;
}

}  // namespace

bool contains(const Window& window, const BorderPlace& place) {
  const auto left = static_cast<double>(window.column), top = static_cast<double>(window.row);
  return place.column >= left && place.column <= left + static_cast<double>(window.columns - 1) &&
         place.row >= top && place.row <= top + static_cast<double>(window.rows - 1);
}

StripOnGrid leaf_strip(const TileSource& source, const SeamId& seam) {
  const Window sides[] = {beside(source.pyramid.window(seam.first), seam, true),
                          beside(source.pyramid.window(seam.second()), seam, false)};
  const Window window = unite(sides[0], sides[1]);
  const HeightGrid grid = source.heights.read(window);
  std::vector<TileMesh> meshes;
  std::vector<std::vector<double>> heights_m;
  const TileId tiles[] = {seam.first, seam.second()};
  for (std::size_t k = 0; k < 2; ++k) {
    FullSide side = full_side(source, tiles[k], grid, sides[k]);
    meshes.push_back(std::move(side.mesh));
    heights_m.push_back(std::move(side.line_heights_m));
  }
  JoinedTiles joined = join(meshes);
  const std::vector<std::vector<std::uint32_t>> number = std::move(joined.number);
  Strip all = strip_of(std::move(joined));
  all.points.clear();
  all.line_heights_m.resize(all.borders.size(), NAN);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t v = 0; v < heights_m[k].size(); ++v) {
      all.line_heights_m[number[k][v]] = heights_m[k][v];
    }
  }
  return {cut_strip(all, samples_of(source.pyramid, seam)), window};
}

StripOnGrid parent_strip(const TileSource& source, const SeamId& seam,
                         const std::vector<TileMesh>& beside) {
  StripOnGrid result{cut_strip(strip_of(join(beside)), samples_of(source.pyramid, seam)), {}};
  if (!result.strip.triangles.empty()) result.window = bounds_of(result.strip, source, seam);
  return result;
}

}  // namespace terrane::tiler
