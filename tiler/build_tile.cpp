#include "tiler/build_tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "core/errors.h"
#include "hierarchy/collapse/strict_collapse.h"
#include "hierarchy/mesh/boundary_vertices.h"
#include "tiler/gltf/terrain_normals.h"
#include "tiler/seams/join_tiles.h"
#include "tiler/tile/blend_check.h"
#include "tiler/tile/measure.h"
#include "tiler/tile/reference.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_samples.h"
#include "tiler/tile/triangles_in_water.h"

namespace terrane::tiler {
namespace {

using hierarchy::BorderPlace;
using hierarchy::Corners;
using hierarchy::FinerLevel;
using hierarchy::Place;
using hierarchy::SampleId;
using hierarchy::StrictOptions;
using hierarchy::StrictResult;
using hierarchy::TerrainMesh;
using hierarchy::TerrainVertex;
using hierarchy::VertexKind;

hierarchy::FieldPoint plan_of(const Place& place) {
  return {hierarchy::column_of(place.plan), hierarchy::row_of(place.plan), 0};
}

hierarchy::FieldPoint blend(const hierarchy::FieldPoint& a, const hierarchy::FieldPoint& b,
                            double t) {
  return {a.column + t * (b.column - a.column), a.row + t * (b.row - a.row), 0};
}

/// Edges with a triangle on one side only.
std::vector<Edge> rim_of(const std::vector<TerrainVertex>& vertices,
                         const std::vector<Corners>& triangles) {
  std::set<Edge> open;
  for (const Corners& corners : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
      const auto is_inside = [&](std::uint32_t v) { return vertices[v].border.is_none(); };
      if (is_inside(from) || is_inside(to)) continue;
      if (open.erase({to, from}) == 0) open.insert({from, to});
    }
  }
  return {open.begin(), open.end()};
}

/// Puts the heights of samples at what their seams made of them.
void raise(const std::vector<SeamChain>& seams, const std::vector<SampleId>& samples,
           std::vector<double>& heights_m) {
  std::map<std::pair<double, double>, double> raised_m;
  for (const SeamChain& seam : seams) {
    for (const SeamVertex& vertex : seam) {
      if (std::isnan(vertex.height_m)) continue;
      raised_m[{vertex.at.column, vertex.at.row}] = vertex.height_m;
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto found = raised_m.find({samples[i].column, samples[i].row});
    if (found != raised_m.end()) heights_m[i] = found->second;
  }
}

/// One tile on its way: its samples, its map to the world, its options.
class TileBuild {
 public:
  TileBuild(const TileSource& source, const TileId& tile, std::size_t input_triangles)
      : source_(source),
        tile_(tile),
        samples_(source.heights, source.pyramid.window(tile),
                 normal_reach(source.pyramid.octave(tile.level)), input_triangles, source.loose,
                 Behind::kAllSamples),
        frame_(source.world, source.lattice, samples_.window(), tile.level),
        reference_(samples_, frame_, step_m() / frame_.spacing_m()) {}

  const TileSamples& samples() const { return samples_; }
  const TileFrame& frame() const { return frame_; }

  /// Where a sample that no other tile shares is written.
  /// \pre a leaf tile
  Place place_inner_sample(const SampleId& sample) const {
    const std::int64_t column = sample.column - samples_.window().column;
    const std::int64_t row = sample.row - samples_.window().row;
    const hierarchy::GridPoint plan{static_cast<std::int32_t>(column * hierarchy::kUnitsPerCell),
                                    static_cast<std::int32_t>(-row * hierarchy::kUnitsPerCell)};
    const double drop_m = frame_.drop_m(static_cast<double>(column), static_cast<double>(row));
    return frame_.place(plan, samples_.whole().at(sample.column, sample.row) - drop_m);
  }

  Place place_line_vertex(const hierarchy::LineVertex& vertex) const {
    return frame_.place(vertex.plan, frame_.over_datum_m(vertex.plan, vertex.height_m));
  }

  /// Puts the vertices of rim and seams where their samples are written, at the height that a seam
  /// gave them if it did: the same in every tile and never by way of the tile's own frame. Those
  /// that lines brought are put so at level 0; later each level rounds what the finer one wrote.
  /// \param line_vertices  of a leaf tile: the last vertices.
  void fix_rim(TerrainMesh& mesh, const std::vector<SeamChain>& seams,
               std::span<const hierarchy::LineVertex> line_vertices = {}) const {
    std::vector<TerrainVertex*> rim, between;
    std::vector<SampleId> samples;
    std::vector<GridPosition> positions, positions_between;
    std::vector<double> heights_between_m;
    const std::size_t first_of_lines = mesh.vertices.size() - line_vertices.size();
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      TerrainVertex& vertex = mesh.vertices[v];
      if (vertex.border.is_sample()) {
        rim.push_back(&vertex);
        samples.push_back(vertex.border.sample());
        positions.push_back(vertex.border.position());
      } else if (!vertex.border.is_none() && v >= first_of_lines) {
        between.push_back(&vertex);
        positions_between.push_back(vertex.border.position());
        heights_between_m.push_back(line_vertices[v - first_of_lines].height_m);
      }
    }
    std::vector<double> heights_m = samples_.heights_m(samples);
    raise(seams, samples, heights_m);
    put(rim, positions, heights_m);
    put(between, positions_between, heights_between_m);
  }

  /// Collapses and measures; again with a smaller tolerance while the world says it is too much.
  ///
  /// \param finer_points  where the finer level's places are written there.
  std::pair<TileMesh, std::vector<LatticePoint>> finish(
      const TerrainMesh& input, const FinerLevel& finer,
      const std::vector<LatticePoint>& finer_points, double tolerance_m) {
    // the grid frame's straight lines are not quite the world's: 0.1 % saves most second tries
    StrictOptions options{.tolerance_m = 0.999 * tolerance_m, .effort = source_.effort};
    if (source_.features != nullptr) options.lines = source_.features->tolerance(tile_.level);
    options.shape.smallest_altitude_cells =
        source_.lattice.smallest_altitude_steps() * step_m() / frame_.spacing_m();
    options.shape.steepest_m = source_.steepest * frame_.spacing_m();

    for (int tries = 1;; ++tries) {
      const StrictResult result =
          hierarchy::collapse_strictly(input, reference_.field(), frame_, finer, options);
      Measured measured = measure(measured_meshes(input, finer, finer_points, result), samples_,
                                  frame_, step_m(), kNotedShare * tolerance_m);
      const double worst_m = worst_of(measured);
      // what seams decided was held to the whole tolerance, and cannot be held to less
      const auto left = left_by_blend(finer, result, tolerance_m);
      if (worst_m <= tolerance_m && left.empty()) {
        return {written_mesh(result.mesh, measured.errors[0]), targets(result)};
      }
      if (tries == kMostTries) refuse(worst_m, tolerance_m);
      options.has_polish = tries < kTriesWithPolish;
      measured.noted.insert(measured.noted.end(), left.begin(), left.end());
      reference_.learn(measured.noted);
      options.tolerance_m *= tightening(tries, worst_m, tolerance_m);
    }
  }

 private:
  static constexpr int kMostTries = 12, kTriesWithPolish = 3;

  /// What becomes of the tolerance after a try. A reduced reference has then learnt, and often
  /// needs no more; and how far off its mesh was somewhere tells nothing about the next one.
  double tightening(int tries, double worst_m, double tolerance_m) const {
    constexpr int kTriesToLearn = 2;
    const bool is_whole = reference_.is_whole();
    if (!is_whole && tries <= kTriesToLearn) return 1;
    // leaves the finer level as it is, which is within its own tolerance
    if (!is_whole && tries + 1 == kMostTries) return 0;
    // gently at first: most are over by a thousandth
    const int doublings = std::min(tries - (is_whole ? 0 : kTriesToLearn), 5);
    const double gentle = 1 - 0.005 * (1 << doublings);
    return is_whole ? std::min(gentle, 0.999 * tolerance_m / worst_m) : gentle;
  }

  double step_m() const { return source_.lattice.step_m(tile_.level).x(); }

  void put(const std::vector<TerrainVertex*>& vertices, const std::vector<GridPosition>& positions,
           const std::vector<double>& heights_m) const {
    const std::vector<Plumb> plumbs = source_.world.plumbs(positions);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      vertices[i]->place = frame_.place_of(
          source_.lattice.of_sample(positions[i], plumbs[i], heights_m[i], tile_.level));
    }
  }

  static double worst_of(const Measured& measured) {
    return std::ranges::max(measured.errors, {}, &MeasuredError::max_m).max_m;
  }

  TileMesh written_mesh(const TerrainMesh& terrain, const MeasuredError& error) const {
    TileMesh mesh{.triangles = terrain.triangles,
                  .in_water = terrain.in_water,
                  .lines = terrain.lines,
                  .error = error};
    std::vector<Place> places;
    for (const TerrainVertex& vertex : terrain.vertices) {
      mesh.points.push_back(vertex.place.lattice);
      mesh.borders.push_back(vertex.border);
      mesh.water_m.push_back(vertex.water_m);
      places.push_back(vertex.place);
    }
    mesh.normals = terrain_normals(places, frame_, source_.pyramid.octave(tile_.level), samples_);
    for (std::size_t v = 0; v < places.size(); ++v) {
      mesh.grounds.push_back(ground_of(places[v], mesh.normals[v]));
    }
    return mesh;
  }

  Ground ground_of(const Place& place, const Eigen::Vector3f& normal) const {
    const double column = hierarchy::column_of(place.plan), row = hierarchy::row_of(place.plan);
    return {.column = static_cast<float>(column),
            .row = static_cast<float>(row),
            .height_m = static_cast<float>(place.height_m + frame_.drop_m(column, row)),
            .slope = normal.dot(frame_.plumb(column, row).up.cast<float>())};
  }

  /// The result, and the finer level on its way to it.
  std::vector<MeasuredMesh> measured_meshes(const TerrainMesh& input, const FinerLevel& finer,
                                            const std::vector<LatticePoint>& finer_points,
                                            const StrictResult& result) const {
    std::vector<MeasuredMesh> meshes(1);
    meshes[0].triangles = result.mesh.triangles;
    meshes[0].rim = rim_of(result.mesh.vertices, result.mesh.triangles);
    for (const TerrainVertex& vertex : result.mesh.vertices) {
      meshes[0].vertices.push_back({plan_of(vertex.place), world_of(vertex.place)});
    }
    if (finer.places.empty()) return meshes;
    constexpr double t = kMeasuredMoment;
    meshes.push_back({{}, finer.triangles, rim_of(input.vertices, finer.triangles)});
    for (std::size_t v = 0; v < finer.places.size(); ++v) {
      const Place& target = result.mesh.vertices[result.target[v]].place;
      const Eigen::Vector3d from = source_.lattice.world(finer_points[v], tile_.level - 1);
      meshes.back().vertices.push_back({blend(plan_of(finer.places[v]), plan_of(target), t),
                                        from + t * (world_of(target) - from)});
    }
    return meshes;
  }

  /// What a reduced reference let the blend leave.
  std::vector<hierarchy::FieldSample> left_by_blend(const FinerLevel& finer,
                                                    const StrictResult& result,
                                                    double tolerance_m) const {
    if (reference_.is_whole() || finer.places.empty()) return {};
    std::vector<Place> to;
    for (const std::uint32_t v : result.target) to.push_back(result.mesh.vertices[v].place);
    return samples_left_by({finer.places, to, finer.triangles}, samples_, frame_,
                           reference_.field().slack_cells, tolerance_m);
  }

  Eigen::Vector3d world_of(const Place& place) const {
    return source_.lattice.world(place.lattice, tile_.level);
  }

  static std::vector<LatticePoint> targets(const StrictResult& result) {
    std::vector<LatticePoint> points;
    for (const std::uint32_t v : result.target) {
      points.push_back(result.mesh.vertices[v].place.lattice);
    }
    return points;
  }

  [[noreturn]] void refuse(double measured_m, double tolerance_m) const {
    if (measured_m <= tolerance_m) {
      throw ConfigError(fmt::format(
          "tile {}: leaves the {:.3g} m around the DEM on its way to the next level. Use a larger "
          "--tolerance, or a smaller --tile-cells",
          path_of(tile_), tolerance_m));
    }
    throw ConfigError(fmt::format(
        "tile {}: is {:.3g} m from the DEM where {:.3g} m is asked for, as its positions are "
        "rounded to {:.3g} m in plan and {:.3g} m in height. Use a larger --tolerance, or a "
        "smaller "
        "--tile-cells",
        path_of(tile_), measured_m, tolerance_m, source_.lattice.step_m(tile_.level).x(),
        source_.lattice.step_m(tile_.level).z()));
  }

  const TileSource& source_;
  TileId tile_;
  TileSamples samples_;
  TileFrame frame_;
  Reference reference_;
};

/// Inside, a vertex is free; on the rim it keeps its sample, and on a seam its place as well.
void set_kind(TerrainVertex& vertex, bool is_boundary, const BorderPlace& border,
              const Pyramid& pyramid, const TileId& tile) {
  if (!is_boundary) return;
  vertex.border = border;
  const bool may_slide = border.is_sample() && !pyramid.is_on_seam(tile, border.column, border.row);
  vertex.kind = may_slide ? VertexKind::kOutline : VertexKind::kLocked;
}

/// A vertex on a line stays on it; where the line comes to the rim, it stays altogether.
void set_line_kinds(TerrainMesh& mesh) {
  for (const hierarchy::LineEdge& edge : mesh.lines) {
    for (const std::uint32_t v : edge) {
      VertexKind& kind = mesh.vertices[v].kind;
      kind = mesh.vertices[v].border.is_none() ? VertexKind::kFeature : VertexKind::kLocked;
    }
  }
}

/// The vertices of a tile that its seams are about.
class SeamVertices {
 public:
  SeamVertices(const std::vector<BorderPlace>& borders, const std::vector<SeamChain>& seams) {
    for (const SeamChain& seam : seams) {
      for (const SeamVertex& vertex : seam) {
        numbers_.emplace(Key{vertex.from.column, vertex.from.row}, kNone);
        numbers_.emplace(Key{vertex.onto.column, vertex.onto.row}, kNone);
      }
    }
    for (std::uint32_t v = 0; v < borders.size(); ++v) {
      const auto found = numbers_.find(Key{borders[v].column, borders[v].row});
      if (found != numbers_.end() && found->second == kNone) found->second = v;
    }
  }

  std::optional<std::uint32_t> find(const BorderPlace& border) const {
    const std::uint32_t v = numbers_.at(Key{border.column, border.row});
    return v == kNone ? std::nullopt : std::optional(v);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  using Key = std::pair<double, double>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return std::hash<double>()(key.first) * 0x9E3779B97F4A7C15U ^ std::hash<double>()(key.second);
    }
  };

  std::unordered_map<Key, std::uint32_t, Hash> numbers_;
};

/// Takes the vertices out of a tile that its seams leave out: as their triangles' corners become
/// others, those that lose one vanish.
FinerLevel leave_out(std::vector<BorderPlace>& borders, const std::vector<SeamChain>& seams,
                     std::vector<Corners>& triangles, std::vector<std::uint8_t>& in_water) {
  const SeamVertices seam_vertices(borders, seams);
  FinerLevel finer{.places = {}, .triangles = triangles, .target = {}};
  for (std::uint32_t v = 0; v < borders.size(); ++v) finer.target.push_back(v);
  for (const SeamChain& seam : seams) {
    for (const SeamVertex& vertex : seam) {
      const auto from = seam_vertices.find(vertex.from), to = seam_vertices.find(vertex.onto);
      // where only the neighbour has triangles, there is nothing to take out
      if (from && to) finer.target[*from] = *to;
      if (to) borders[*to] = vertex.at;
    }
  }
  for (Corners& corners : triangles) {
    for (std::uint32_t& v : corners) v = finer.target[v];
  }
  const auto is_nothing = [](const Corners& c) {
    return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
  };
  std::size_t left = 0;
  for (std::size_t t = 0; t < in_water.size(); ++t) {
    if (!is_nothing(triangles[t])) in_water[left++] = in_water[t];
  }
  in_water.resize(left);
  std::erase_if(triangles, is_nothing);
  return finer;
}

std::vector<std::uint8_t> in_water_of(const TileSource& source, const TileId& leaf,
                                      const hierarchy::LinedTriangles& full,
                                      const std::vector<BorderPlace>& places) {
  if (source.features == nullptr) return {};
  const auto is_water = [&](const SampleId& sample) {
    return !std::isnan(source.features->water_m(sample));
  };
  return triangles_in_water(full, places, lines_of(source, leaf), is_water,
                            source.features->water());
}

/// Lines were laid so that rounding turns none of their triangles over: see ingest/features.h.
void check_upright(const TerrainMesh& mesh, const TileId& tile) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Place* corners[] = {&mesh.vertices[a].place, &mesh.vertices[b].place,
                              &mesh.vertices[c].place};
    if (hierarchy::orient2d(corners[0]->plan, corners[1]->plan, corners[2]->plan) > 0) continue;
    throw TopologyError(
        fmt::format("tile {}: lines are so near to each other at column {:.2f}, row {:.2f} of it "
                    "that rounding folds the terrain. Simplify them there, or use a larger "
                    "--tolerance",
                    path_of(tile), hierarchy::column_of(corners[0]->plan),
                    hierarchy::row_of(corners[0]->plan)));
  }
}

}  // namespace

std::span<const FeatureLine> lines_of(const TileSource& source, const TileId& leaf) {
  if (source.features == nullptr) return {};
  return source.features->lines_of(leaf);
}

hierarchy::WaterHeight water_of(const TileSource& source) {
  if (source.features == nullptr) return {};
  return [&areas = source.features->water()](const GridPosition& place) {
    return areas.height_m(place);
  };
}

BuiltTile build_leaf(const TileSource& source, const TileId& tile,
                     const std::vector<SeamChain>& seams, double tolerance_m) {
  TileBuild build(source, tile, 0);
  const TileSamples& samples = build.samples();
  hierarchy::LinedTriangles full = hierarchy::triangulate_with_lines(
      samples.whole(), samples.window(), lines_of(source, tile), water_of(source));
  if (full.triangles.empty()) return {};

  std::vector<BorderPlace> places = places_of(full, samples.window());
  const std::vector<bool> boundary = hierarchy::boundary_vertices(places.size(), full.triangles);
  std::vector<std::uint8_t> in_water = in_water_of(source, tile, full, places);
  const FinerLevel finer = leave_out(places, seams, full.triangles, in_water);
  TerrainMesh mesh{{}, std::move(full.triangles), std::move(full.edges), std::move(in_water)};
  for (const SampleId& sample : full.samples) {
    mesh.vertices.push_back({.place = build.place_inner_sample(sample)});
    if (source.features != nullptr) {
      mesh.vertices.back().water_m = source.features->water_m(sample);
    }
  }
  for (const hierarchy::LineVertex& vertex : full.line_vertices) {
    mesh.vertices.push_back({.place = build.place_line_vertex(vertex)});
  }
  for (std::size_t v = 0; v < places.size(); ++v) {
    set_kind(mesh.vertices[v], boundary[v], places[v], source.pyramid, tile);
  }
  set_line_kinds(mesh);
  build.fix_rim(mesh, seams, full.line_vertices);
  if (!full.line_vertices.empty()) check_upright(mesh, tile);
  return {build.finish(mesh, finer, {}, tolerance_m).first, {}};
}

BuiltTile build_parent(const TileSource& source, const TileId& tile,
                       const std::vector<TileMesh>& children, const std::vector<SeamChain>& seams,
                       double tolerance_m) {
  BuiltTile result;
  JoinedTiles joined = join(children);
  result.child_targets.resize(children.size());
  if (joined.triangles.empty()) return result;

  TileBuild build(source, tile, joined.triangles.size());
  const std::vector<bool> boundary =
      hierarchy::boundary_vertices(joined.points.size(), joined.triangles);
  FinerLevel finer = leave_out(joined.borders, seams, joined.triangles, joined.in_water);
  TerrainMesh mesh{
      {}, std::move(joined.triangles), std::move(joined.lines), std::move(joined.in_water)};
  for (std::uint32_t v = 0; v < joined.points.size(); ++v) {
    finer.places.push_back(build.frame().place_of_finer(joined.points[v]));
    mesh.vertices.push_back({.place = build.frame().place_of(finer.places.back().lattice)});
    mesh.vertices.back().water_m = joined.water_m[v];
    set_kind(mesh.vertices.back(), boundary[v], joined.borders[v], source.pyramid, tile);
  }
  set_line_kinds(mesh);
  build.fix_rim(mesh, seams);

  auto [own, targets] = build.finish(mesh, finer, joined.points, tolerance_m);
  result.mesh = std::move(own);
  for (std::size_t c = 0; c < children.size(); ++c) {
    for (const std::uint32_t v : joined.number[c]) {
      result.child_targets[c].push_back(source.lattice.refine(targets[v], tile.level - 1));
    }
  }
  return result;
}

}  // namespace terrane::tiler
