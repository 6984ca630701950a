#include "tiler/verify/verify.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/errors.h"
#include "tiler/verify/block_judge.h"
#include "tiler/verify/listing_check.h"
#include "tiler/verify/output.h"
#include "tiler/verify/sample_tally.h"
#include "tiler/verify/tile_examination.h"

namespace terrane::verify {
namespace {

// 4 x 4 leaf tiles and the 5 above them are read and judged side by side
constexpr int kBatchOctave = 2;
constexpr std::size_t kMostLinesOfOneKind = 40;
constexpr double kStatedSlack = 1e-6;
constexpr double kStatedSlack_m = 1e-9;

bool is_understated(double stated_m, double measured_m) {
  return !(measured_m <= stated_m * (1 + kStatedSlack) + kStatedSlack_m);
}

void add_problems(const std::vector<std::string>& lines, VerifyReport& report) {
  const std::size_t shown = std::min(lines.size(), kMostLinesOfOneKind);
  report.problems.insert(report.problems.end(), lines.begin(),
                         lines.begin() + static_cast<std::ptrdiff_t>(shown));
  report.problems_left_out += static_cast<std::int64_t>(lines.size() - shown);
}

/// How many units of the finer lattice one of the coarser is, per axis.
Lattice steps_ratio(const LevelEntry& fine, const LevelEntry& coarse) {
  Lattice ratio;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<Eigen::Index>(axis);
    ratio[axis] = std::llround(coarse.step_m[n] / fine.step_m[n]);
  }
  return ratio;
}

Lattice scaled(const Lattice& place, const Lattice& ratio) {
  return {place[0] * ratio[0], place[1] * ratio[1], place[2] * ratio[2]};
}

/// Walks the quadtree depth first: in memory are one batch, the tiles above it and their siblings.
class Verification {
 public:
  Verification(const Output& output, const HeightSource& heights, const World& world,
               const ValidDomain& domain, const WaterJudge& water, Progress& progress)
      : output_(output),
        heights_(heights),
        world_(world),
        domain_(domain),
        water_(water),
        progress_(progress),
        samples_(output.tiling, output.levels) {
    for (std::size_t level = 0; level < output.levels.size(); ++level) {
      report_.levels.push_back(
          {.level = static_cast<int>(level), .tolerance_m = output.levels[level].tolerance_m});
      if (level + 1 == output.levels.size()) continue;
      for (const double t : kMorphTimes) report_.levels.back().morph.push_back({.t = t});
    }
  }

  VerifyReport run() {
    const Tiling& tiling = output_.tiling;
    const std::vector<std::string> listing = check_listing(output_, world_, domain_, report_);
    progress_.begin("verifying tiles", tiling.tile_columns(0) * tiling.tile_rows(0));
    const TileKey root{tiling.level_count() - 1, 0, 0};
    examine({root});
    visit(root);
    finish(root);
    take_samples();
    check_levels();
    add_problems(listing, report_);
    add_problems(samples_.problems(), report_);
    add_problems(problems_, report_);
    return std::move(report_);
  }

 private:
  LevelReport& level(const TileKey& key) {
    return report_.levels[static_cast<std::size_t>(key.level)];
  }

  /// Judges everything below a tile that has been examined, and finishes all tiles below it.
  void visit(const TileKey& key) {
    if (output_.tiling.octave(key.level) <= kBatchOctave) {
      visit_batch(key);
      return;
    }
    // all children first: while they morph, each covers samples of the others
    const std::vector<TileKey> children = output_.tiling.children(key);
    examine(children);
    for (const TileKey& child : children) visit(child);
    for (const TileKey& child : children) finish(child);
  }

  void visit_batch(const TileKey& key) {
    std::vector<TileKey> below = output_.tiling.subtree(key);
    std::vector<TileKey> leaves;
    std::copy_if(below.begin(), below.end(), std::back_inserter(leaves),
                 [](const TileKey& tile) { return tile.level == 0; });
    below.pop_back();  // the tile itself
    examine(below);
    judge_leaves(leaves);
    for (const TileKey& tile : below) finish(tile);
    progress_.advance(static_cast<std::int64_t>(leaves.size()));
  }

  void examine(const std::vector<TileKey>& keys) {
    std::vector<TileFindings> findings(keys.size());
    tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t n) {
      findings[n] = examine_tile(output_, world_, domain_, water_, keys[n]);
    });
    for (TileFindings& found : findings) open_.emplace(found.key, std::move(found));
  }

  void judge_leaves(const std::vector<TileKey>& leaves) {
    std::vector<BlockFindings> findings(leaves.size());
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
      findings[n] = judge_block(read_sample_block(heights_, world_, output_.tiling, leaves[n]),
                                output_, water_, open_);
    });
    // added up in the order of the walk, whoever judged them
    for (const BlockFindings& found : findings) {
      samples_.add(found);
      note_measured(found);
      note_sides(found);
    }
  }

  void note_measured(const BlockFindings& found) {
    for (const auto& of_slot : found.slots) {
      if (of_slot.slot.time != 0) continue;
      const int number = of_slot.slot.level;
      double& measured_m = open_.at(output_.tiling.above(found.leaf, number)).measured_error_m;
      measured_m = std::max(measured_m, of_slot.inside.max_error_m);
      for (const Verdict& verdict : of_slot.rim) measured_m = std::max(measured_m, verdict.error_m);
    }
  }

  void note_sides(const BlockFindings& found) {
    for (const auto& of_slot : found.slots) {
      if (of_slot.on_wrong_side == 0) continue;
      const TileKey tile = output_.tiling.above(found.leaf, of_slot.slot.level);
      level(tile).samples_on_wrong_side += of_slot.on_wrong_side;
      problems_.push_back(
          fmt::format("{}: {} samples on the wrong side of a shore, the first at (column {}, row "
                      "{})",
                      to_string(tile), of_slot.on_wrong_side, of_slot.first_on_wrong_side.column,
                      of_slot.first_on_wrong_side.row));
    }
  }

  /// Everything below the tile has been judged: compares it with its children and neighbours.
  void finish(const TileKey& key) {
    TileFindings& tile = open_.at(key);
    count(tile);
    for (const Side side : kSides) compare_seam(tile, side);
    if (key.level > 0) compare_children(tile);
    for (const TileKey& child : output_.tiling.children(key)) open_.erase(child);
    tile.placed.reset();
  }

  void count(const TileFindings& tile) {
    if (!tile.placed) return;
    LevelReport& of_level = level(tile.key);
    const TileMesh& mesh = tile.placed->mesh();
    ++of_level.tiles;
    of_level.triangles += static_cast<std::int64_t>(mesh.triangles.size());
    of_level.bytes += mesh.bytes;
    of_level.folded_triangles += tile.folded[0];
    for (std::size_t n = 0; n < of_level.morph.size(); ++n) {
      of_level.morph[n].folded_triangles += tile.folded[n + 1];
    }
    of_level.torn_edges += tile.torn_edges;
    of_level.water_triangles += tile.water_triangles;
    of_level.uneven_water_triangles += tile.uneven_water_triangles;
    of_level.boxes_violated += tile.vertices_outside_box > 0;
    of_level.facts_misstated += static_cast<std::int64_t>(tile.misstated.size());
    for (const std::string& what : tile.misstated) {
      problems_.push_back(fmt::format("{}: {}", to_string(tile.key), what));
    }
    problems_.insert(problems_.end(), tile.problems.begin(), tile.problems.end());
    check_root_morph(tile);
    check_stated_error(tile);
  }

  void check_root_morph(const TileFindings& tile) {
    if (level(tile.key).has_morph() || tile.vertices_with_morph == 0) return;
    level(tile.key).root_morphs += tile.vertices_with_morph;
    problems_.push_back(fmt::format("{}: {} vertices of the root have a _MORPH",
                                    to_string(tile.key), tile.vertices_with_morph));
  }

  void check_stated_error(const TileFindings& tile) {
    const double stated_m = output_.find(tile.key)->max_error_m;
    if (!is_understated(stated_m, tile.measured_error_m)) return;
    ++level(tile.key).stated_error_too_small;
    problems_.push_back(fmt::format("{}: its error is stated as {} m, measured are {} m",
                                    to_string(tile.key), stated_m, tile.measured_error_m));
  }

  /// The second of two neighbours to be finished compares; the first leaves its vertices behind.
  void compare_seam(TileFindings& tile, Side side) {
    const TileKey other = neighbour(tile.key, side);
    if (!output_.tiling.has(other)) return;
    const SeamVertices& mine = tile.sides[static_cast<std::size_t>(side)];
    const auto waiting = waiting_sides_.find({other, opposite(side)});
    if (waiting == waiting_sides_.end()) {
      waiting_sides_.emplace(std::pair(tile.key, side), mine);
      return;
    }
    LevelReport& of_level = level(tile.key);
    of_level.seam_vertices += static_cast<std::int64_t>(unite(mine, waiting->second).size());
    const SeamVertices differing = difference(mine, waiting->second);
    of_level.mismatched_same_level += static_cast<std::int64_t>(differing.size());
    note_mismatch(tile.key, side, differing, fmt::format("and {}", to_string(other)));
    waiting_sides_.erase(waiting);
  }

  void note_mismatch(const TileKey& key, Side side, const SeamVertices& differing,
                     const std::string& partner) {
    if (differing.empty()) return;
    const Line line = side_line(output_.tiling.window(key), side);
    problems_.push_back(
        fmt::format("{} {}: {} border vertices differ, the first at ({} {}, {} {:.2f})",
                    to_string(key), partner, differing.size(), line.is_column ? "column" : "row",
                    line.at, line.is_column ? "row" : "column", differing.front().along));
  }

  void compare_children(const TileFindings& tile) {
    const auto fine = static_cast<std::size_t>(tile.key.level) - 1;
    const Lattice ratio = steps_ratio(output_.levels[fine], output_.levels[fine + 1]);
    compare_triangles(tile, ratio);
    for (const Side side : kSides) compare_side_with_children(tile, side, ratio);
  }

  void compare_triangles(const TileFindings& tile, const Lattice& ratio) {
    std::vector<LatticeTriangle> expected = tile.at_rest;
    for (LatticeTriangle& triangle : expected) {
      for (Lattice& corner : triangle) corner = scaled(corner, ratio);
    }
    std::vector<LatticeTriangle> found;
    for (const TileKey& child : output_.tiling.children(tile.key)) {
      const auto& triangles = open_.at(child).at_next_level;
      found.insert(found.end(), triangles.begin(), triangles.end());
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    std::vector<LatticeTriangle> missing;
    std::vector<LatticeTriangle> extra;
    std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                        std::back_inserter(missing));
    std::set_difference(found.begin(), found.end(), expected.begin(), expected.end(),
                        std::back_inserter(extra));
    note_shape(tile.key, missing.size(), extra.size());
  }

  void note_shape(const TileKey& parent, std::size_t missing, std::size_t extra) {
    if (missing == 0 && extra == 0) return;
    LevelReport& of_children = report_.levels[static_cast<std::size_t>(parent.level) - 1];
    of_children.parent_triangles_missing += static_cast<std::int64_t>(missing);
    of_children.parent_triangles_extra += static_cast<std::int64_t>(extra);
    problems_.push_back(fmt::format(
        "{}: its children at t = 1 lack {} of its triangles and have {} that it has not",
        to_string(parent), missing, extra));
  }

  void compare_side_with_children(const TileFindings& tile, Side side, const Lattice& ratio) {
    SeamVertices expected = tile.sides[static_cast<std::size_t>(side)];
    for (SeamVertex& vertex : expected) {
      vertex.place = scaled(vertex.place, ratio);
      vertex.morph = {};  // the parent's own way on does not matter here
    }
    expected = at_next_level(expected);
    SeamVertices found;
    for (const TileKey& child : output_.tiling.children(tile.key)) {
      if (!output_.tiling.is_on_side(child, side)) continue;
      const SeamVertices& vertices = open_.at(child).sides[static_cast<std::size_t>(side)];
      found = unite(found, at_next_level(vertices));
    }
    const SeamVertices differing = difference(expected, found);
    report_.levels[static_cast<std::size_t>(tile.key.level) - 1].mismatched_across_levels +=
        static_cast<std::int64_t>(differing.size());
    note_mismatch(tile.key, side, differing, "and its children at t = 1");
  }

  void take_samples() {
    for (LevelReport& of_level : report_.levels) {
      const Tally& tally = samples_.of({of_level.level, 0});
      of_level.max_error_m = tally.max_error_m;
      of_level.samples = tally.samples;
      of_level.uncovered_samples = tally.uncovered;
      of_level.samples_over_tolerance = tally.over_tolerance;
      const auto covered = static_cast<double>(tally.samples - tally.uncovered);
      of_level.rms_error_m = covered > 0 ? std::sqrt(tally.square_sum_m2 / covered) : 0;
      for (std::size_t n = 0; n < of_level.morph.size(); ++n) {
        const Tally& morphing = samples_.of({of_level.level, static_cast<int>(n) + 1});
        MorphReport& morph = of_level.morph[n];
        morph.max_error_m = morphing.max_error_m;
        morph.samples_over_tolerance = morphing.over_tolerance;
        morph.uncovered_samples = morphing.uncovered;
      }
    }
  }

  void check_levels() {
    for (LevelReport& found : report_.levels) {
      const LevelEntry& stated = output_.levels[static_cast<std::size_t>(found.level)];
      check_count(found, "tiles", stated.tiles, found.tiles);
      check_count(found, "triangles", stated.triangles, found.triangles);
      check_count(found, "bytes", stated.bytes, found.bytes);
      if (!is_understated(stated.max_error_m, found.max_error_m)) continue;
      ++found.facts_misstated;
      problems_.push_back(
          fmt::format("terrane.json: level {} states an error of {} m, measured are {} m",
                      found.level, stated.max_error_m, found.max_error_m));
    }
  }

  void check_count(LevelReport& of_level, const char* what, std::int64_t stated,
                   std::int64_t found) {
    if (stated == found) return;
    ++of_level.facts_misstated;
    problems_.push_back(fmt::format("terrane.json: level {} states {} {}, the tiles have {}",
                                    of_level.level, stated, what, found));
  }

  const Output& output_;
  const HeightSource& heights_;
  const World& world_;
  const ValidDomain& domain_;
  const WaterJudge& water_;
  Progress& progress_;
  SampleTally samples_;
  VerifyReport report_;
  std::vector<std::string> problems_;
  std::map<TileKey, TileFindings> open_;
  std::map<std::pair<TileKey, Side>, SeamVertices> waiting_sides_;
};

void check_dem(const Output& output, const HeightSource& heights, const Georeference& place) {
  const auto file = (output.folder / "terrane.json").string();
  const GridShape& built = output.tiling.shape;
  const GridShape given = heights.shape();
  if (given != built) {
    throw InputError(fmt::format(
        "{}: built from a DEM of {} x {} samples, this one has {} x {}. Give the DEM it was built "
        "from with --dem",
        file, built.columns, built.rows, given.columns, given.rows));
  }
  if (!output.frame.is_local && place.crs_wkt().empty()) {
    throw InputError(fmt::format(
        "{}: its frame is on the Earth, but the DEM has no CRS. Give the --crs it was built with",
        file));
  }
}

}  // namespace

VerifyReport verify(const std::filesystem::path& folder, const HeightSource& heights,
                    const Georeference& place, const VerifyOptions& options, Progress& progress) {
  const Output output = read_output(folder);
  check_dem(output, heights, place);
  const World world(output.frame, place);
  const WaterJudge water(world, place, options.water, output.levels.back().tolerance_m);
  const ValidDomain domain(heights, output.tiling, progress);
  tbb::task_arena arena(options.jobs > 0 ? options.jobs : tbb::task_arena::automatic);
  VerifyReport report;
  arena.execute(
      [&] { report = Verification(output, heights, world, domain, water, progress).run(); });
  return report;
}

}  // namespace terrane::verify
