#include "tiler/seams/build_seam.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hierarchy/collapse/chain_collapse.h"
#include "tiler/seams/seam_strip.h"
#include "tiler/tile/blend_check.h"
#include "tiler/tile/measure.h"
#include "tiler/tile/reference.h"
#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {
namespace {

using hierarchy::BorderPlace;
using hierarchy::ChainOptions;
using hierarchy::ChainResult;
using hierarchy::Corners;
using hierarchy::FinerLevel;
using hierarchy::Place;
using hierarchy::SampleId;
using hierarchy::TerrainMesh;
using hierarchy::TerrainVertex;
using hierarchy::VertexKind;

/// A seam on its way: the samples around it, its map to the world, its strip.
class SeamBuild {
 public:
  SeamBuild(const TileSource& source, const SeamId& seam, Strip strip, const Window& window)
      : source_(source),
        seam_(seam),
        strip_(std::move(strip)),
        samples_(source.heights, window, 0, strip_.triangles.size(), source.loose,
                 Behind::kNothing),  // chains know the samples that are kept alone
        frame_(source.world, source.lattice, window, seam.first.level),
        reference_(samples_, frame_, step_m() / frame_.spacing_m()) {
    place_vertices();
    list_chain();
    if (source_.features == nullptr) find_line();
  }

  SeamChain run(double tolerance_m) {
    const double step_cells = step_m() / frame_.spacing_m();
    // as in build_tile: the grid frame's straight lines are not quite the world's
    ChainOptions options{.tolerance_m = kShare * 0.999 * tolerance_m,
                         .blend_tolerance_m = 0.999 * tolerance_m,
                         .smallest_altitude_cells = smallest_altitude_steps() * step_cells,
                         .largest_bend_m = std::min(kLargestBend * tolerance_m,
                                                    kLargestBend_cells * frame_.spacing_m()),
                         .place_at = {}};
    // water keeps its height, and so do the lines that end on a seam
    if (source_.features == nullptr) {
      options.place_at = [this](const SampleId& at, double height_m) {
        return frame_.place_of(source_.lattice.of_sample(BorderPlace(at).position(), line_plumb(at),
                                                         over_ellipsoid_m(at, height_m),
                                                         seam_.first.level));
      };
    }
    constexpr int kMostTries = 8;
    for (int tries = 0; tries < kMostTries; ++tries) {
      const ChainResult result =
          hierarchy::collapse_chain(mesh_, chain_, finer_, reference_.field(), frame_, options);
      if (result.collapses == 0) return as_it_was();
      auto [errors, noted] =
          measure(measured_meshes(result), samples_, frame_, step_m(), kNotedShare * tolerance_m);
      const double worst_m = std::ranges::max(errors, {}, &MeasuredError::max_m).max_m;
      if (worst_m <= kLargestShare * tolerance_m) {
        noted = left_by_blend(result, options.blend_tolerance_m);
        if (noted.empty()) return chain_of(result);
      }
      if (reference_.learn(noted)) continue;
      const double factor = std::min(0.98, kLargestShare * tolerance_m / worst_m);
      options.tolerance_m *= factor;
      options.blend_tolerance_m *= factor;
      options.largest_bend_m *= factor;
    }
    return as_it_was();
  }

 private:
  static constexpr double kShare = 0.95;
  static constexpr double kLargestBend = 0.25;
  // as measured over the strip; over a tile the frame may be off by a little more
  static constexpr double kLargestShare = 0.99;
  static constexpr double kLargestBend_cells = 0.4;
  static constexpr double kShareOfAltitude = 0.25;

  /// At level 0 the triangles beside a long edge of a seam are one cell wide, until their tiles
  /// replace them. Held to the altitude of those that stay, no edge could be long.
  double smallest_altitude_steps() const {
    const int level = seam_.first.level;
    const Lattice& lattice = source_.lattice;
    const bool is_rounded_again =
        level + 1 == lattice.level_count() || lattice.step_m(level + 1) != lattice.step_m(level);
    const double steps = source_.lattice.smallest_altitude_steps();
    const bool is_for_now = level == 0 && !is_rounded_again && source_.features == nullptr;
    return is_for_now ? kShareOfAltitude * steps : steps;
  }

  double step_m() const { return source_.lattice.step_m(seam_.first.level).x(); }

  void place_vertices() {
    mesh_.triangles = finer_.triangles = strip_.triangles;
    for (const LatticePoint& point : strip_.points) {
      finer_.places.push_back(frame_.place_of_finer(point));
    }
    ask_heights();
    for (std::size_t v = 0; v < strip_.borders.size(); ++v) {
      const LatticePoint point =
          is_placed_by_sample(v) ? written(v, std::isnan(raised_m_[v]) ? own_m_[v] : raised_m_[v])
                                 : finer_.places[v].lattice;
      mesh_.vertices.push_back({.place = frame_.place_of(point), .border = strip_.borders[v]});
    }
  }

  /// As in build_tile: by the sample, or at level 0 by the place on a line.
  bool is_placed_by_sample(std::size_t v) const {
    return strip_.points.empty() || strip_.borders[v].is_sample();
  }

  /// Finds where the samples of the strip stand, and at which height the finer level has them.
  void ask_heights() {
    std::vector<std::size_t> numbers;
    std::vector<SampleId> samples;
    std::vector<GridPosition> positions;
    for (std::size_t v = 0; v < strip_.borders.size(); ++v) {
      if (!is_placed_by_sample(v)) continue;
      const BorderPlace& border = strip_.borders[v];
      numbers.push_back(v);
      samples.push_back(border.is_sample() ? border.sample() : some_sample());
      positions.push_back(border.position());
    }
    const std::vector<Plumb> plumbs = source_.world.plumbs(positions);
    const std::vector<double> heights_m = samples_.heights_m(samples);
    plumbs_.resize(strip_.borders.size());
    own_m_.resize(strip_.borders.size(), NAN);
    raised_m_.resize(strip_.borders.size(), NAN);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t v = numbers[i];
      plumbs_[v] = plumbs[i];
      own_m_[v] = strip_.borders[v].is_sample() ? heights_m[i] : strip_.line_heights_m[v];
      if (finer_.places.empty() || source_.features != nullptr) continue;
      const double finer_m = over_ellipsoid_m(strip_.borders[v], finer_.places[v].height_m);
      const double rounding_m = source_.lattice.step_m(seam_.first.level - 1).norm();
      if (std::abs(finer_m - own_m_[v]) > rounding_m) raised_m_[v] = finer_m;
    }
  }

  /// Asks the world where the samples of the line stand.
  void find_line() {
    const Window line = samples_of(source_.pyramid, seam_);
    std::vector<GridPosition> positions;
    for (std::int64_t k = 0; k < line.columns * line.rows; ++k) {
      positions.push_back({static_cast<double>(line.column + (line.columns == 1 ? 0 : k)),
                           static_cast<double>(line.row + (line.columns == 1 ? k : 0))});
    }
    line_plumbs_ = source_.world.plumbs(positions);
  }

  const Plumb& line_plumb(const SampleId& at) const {
    const Window line = samples_of(source_.pyramid, seam_);
    return line_plumbs_[static_cast<std::size_t>(at.column - line.column + at.row - line.row)];
  }

  LatticePoint written(std::size_t v, double height_m) const {
    return source_.lattice.of_sample(strip_.borders[v].position(), plumbs_[v], height_m,
                                     seam_.first.level);
  }

  /// \param height_m  over the datum of the places.
  double over_ellipsoid_m(const BorderPlace& at, double height_m) const {
    return height_m + frame_.drop_m(at.column - static_cast<double>(samples_.window().column),
                                    at.row - static_cast<double>(samples_.window().row));
  }

  SampleId some_sample() const {
    return {static_cast<std::int32_t>(samples_.window().column),
            static_cast<std::int32_t>(samples_.window().row)};
  }

  void list_chain() {
    const Window line = samples_of(source_.pyramid, seam_);
    for (std::uint32_t v = 0; v < strip_.borders.size(); ++v) {
      if (!contains(line, strip_.borders[v])) continue;
      chain_.push_back(v);
      // a line's vertex on a border stays until the tiles are merged
      mesh_.vertices[v].kind =
          strip_.is_on_line[v] != 0 ? VertexKind::kLocked : VertexKind::kOutline;
    }
    std::ranges::sort(chain_, {}, [&](std::uint32_t v) {
      return std::pair{strip_.borders[v].row, strip_.borders[v].column};
    });
    for (const Corners& corners : strip_.triangles) {
      if (std::ranges::none_of(corners, [&](std::uint32_t v) { return is_on_another_seam(v); })) {
        continue;
      }
      for (const std::uint32_t v : corners) lock(v);
    }
    for (const std::uint32_t v : chain_) {
      if (is_corner(strip_.borders[v])) lock(v);
    }
  }

  void lock(std::uint32_t v) { mesh_.vertices[v].kind = VertexKind::kLocked; }

  /// Corners of tiles stay at their level.
  bool is_corner(const BorderPlace& place) const {
    const Window line = samples_of(source_.pyramid, seam_);
    const BorderPlace first(static_cast<double>(line.column), static_cast<double>(line.row));
    const BorderPlace last(static_cast<double>(line.column + line.columns - 1),
                           static_cast<double>(line.row + line.rows - 1));
    return place == first || place == last;
  }

  /// May another seam remove this vertex? Then each seam must leave their triangles alone.
  bool is_on_another_seam(std::uint32_t v) const {
    const BorderPlace& s = strip_.borders[v];
    if (s.is_none() || contains(samples_of(source_.pyramid, seam_), s)) return false;
    for (const TileId& tile : {seam_.first, seam_.second()}) {
      const Window w = source_.pyramid.window(tile);
      const auto left = static_cast<double>(w.column), top = static_cast<double>(w.row);
      const auto right = static_cast<double>(w.column + w.columns - 1);
      const auto bottom = static_cast<double>(w.row + w.rows - 1);
      const bool is_at_side = s.column == left || s.column == right;
      if (is_at_side && (s.row == top || s.row == bottom)) return false;
    }
    return source_.pyramid.is_on_seam(seam_.first, s.column, s.row) ||
           source_.pyramid.is_on_seam(seam_.second(), s.column, s.row);
  }

  /// The strip as it will be, and the finer level on its way there.
  std::vector<MeasuredMesh> measured_meshes(const ChainResult& result) {
    collapsed_ = collapsed(result);
    std::vector<MeasuredMesh> meshes{{{}, collapsed_, {}}};
    for (const Place& place : result.places) meshes[0].vertices.push_back(at(place));
    if (finer_.places.empty()) return meshes;
    constexpr double t = kMeasuredMoment;
    std::vector<WorldVertex> moving;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      const WorldVertex& to = meshes[0].vertices[result.target[v]];
      const WorldVertex from = at_finer(v);
      moving.push_back({{from.plan.column + t * (to.plan.column - from.plan.column),
                         from.plan.row + t * (to.plan.row - from.plan.row), 0},
                        from.world + t * (to.world - from.world)});
    }
    meshes.push_back({std::move(moving), strip_.triangles, {}});
    return meshes;
  }

  /// What a reduced reference let the blend leave.
  std::vector<hierarchy::FieldSample> left_by_blend(const ChainResult& result,
                                                    double tolerance_m) const {
    if (reference_.is_whole() || finer_.places.empty()) return {};
    std::vector<Place> to;
    for (const std::uint32_t v : result.target) to.push_back(result.places[v]);
    return samples_left_by({finer_.places, to, strip_.triangles}, samples_, frame_,
                           reference_.field().slack_cells, tolerance_m);
  }

  WorldVertex at(const Place& place) const {
    return {{hierarchy::column_of(place.plan), hierarchy::row_of(place.plan), 0},
            source_.lattice.world(place.lattice, seam_.first.level)};
  }

  WorldVertex at_finer(std::size_t v) const {
    WorldVertex vertex = at(finer_.places[v]);
    vertex.world = source_.lattice.world(strip_.points[v], seam_.first.level - 1);
    return vertex;
  }

  std::vector<Corners> collapsed(const ChainResult& result) const {
    std::vector<Corners> triangles;
    for (const Corners& c : strip_.triangles) {
      const Corners moved{result.target[c[0]], result.target[c[1]], result.target[c[2]]};
      if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) {
        triangles.push_back(moved);
      }
    }
    return triangles;
  }

  SeamChain chain_of(const ChainResult& result) const {
    SeamChain chain;
    for (const std::uint32_t v : chain_) {
      const std::uint32_t onto = result.target[v];
      const double height_m = std::isnan(result.raised_m[onto])
                                  ? raised_m_[onto]
                                  : over_ellipsoid_m(result.borders[onto], result.raised_m[onto]);
      if (onto == v && std::isnan(height_m)) continue;
      chain.push_back({strip_.borders[v], strip_.borders[onto], result.borders[onto], height_m});
    }
    return chain;
  }

  /// All vertices stay where the finer level has them.
  SeamChain as_it_was() const {
    SeamChain chain;
    for (const std::uint32_t v : chain_) {
      if (std::isnan(raised_m_[v])) continue;
      chain.push_back({strip_.borders[v], strip_.borders[v], strip_.borders[v], raised_m_[v]});
    }
    return chain;
  }

  const TileSource& source_;
  SeamId seam_;
  Strip strip_;
  TileSamples samples_;
  TileFrame frame_;
  Reference reference_;
  TerrainMesh mesh_;
  FinerLevel finer_;
  std::vector<Plumb> plumbs_;       // of the strip's samples
  std::vector<Plumb> line_plumbs_;  // of the line's samples
  std::vector<double> own_m_;       // their heights over the ellipsoid
  std::vector<double> raised_m_;    // at the finer level, where it has them at others; else NaN
  std::vector<std::uint32_t> chain_;
  std::vector<Corners> collapsed_;  // of the last try
};

}  // namespace

SeamChain build_leaf_seam(const TileSource& source, const SeamId& seam, double tolerance_m) {
  auto [strip, window] = leaf_strip(source, seam);
  if (strip.triangles.empty()) return {};
  return SeamBuild(source, seam, std::move(strip), window).run(tolerance_m);
}

SeamChain build_parent_seam(const TileSource& source, const SeamId& seam,
                            const std::vector<TileMesh>& beside, double tolerance_m) {
  auto [strip, window] = parent_strip(source, seam, beside);
  if (strip.triangles.empty()) return {};
  return SeamBuild(source, seam, std::move(strip), window).run(tolerance_m);
}

std::vector<TileId> tiles_beside(const Pyramid& pyramid, const SeamId& seam) {
  std::vector<TileId> result;
  const Window line = samples_of(pyramid, seam);
  for (const TileId& tile : {seam.first, seam.second()}) {
    for (const TileId& child : pyramid.children(tile)) {
      const Window window = pyramid.window(child);
      const bool reaches =
          seam.is_column
              ? window.column <= line.column && line.column < window.column + window.columns
              : window.row <= line.row && line.row < window.row + window.rows;
      if (reaches) result.push_back(child);
    }
  }
  return result;
}

}  // namespace terrane::tiler
