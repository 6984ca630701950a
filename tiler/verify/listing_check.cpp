#include "tiler/verify/listing_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

namespace terrane::verify {
namespace {

constexpr double kRelativeSlack = 1e-6;
constexpr double kTransformSlack_m = 1e-3;

class ListingCheck {
 public:
  ListingCheck(const Output& output, const World& world, const ValidDomain& domain,
               VerifyReport& report)
      : output_(output), world_(world), domain_(domain), report_(report) {}

  std::vector<std::string> run() {
    for (int level = 0; level < static_cast<int>(output_.levels.size()); ++level) {
      find_missing_tiles(level);
    }
    for (const auto& [key, entry] : output_.tiles) check_entry(entry);
    for (const TileKey& key : output_.listed_twice) {
      ++level(key.level).facts_misstated;
      problems_.push_back(fmt::format("{}: listed twice in tileset.json", to_string(key)));
    }
    for (const auto& [key, what] : output_.contradictions) misstated(key, what);
    check_root();
    find_stray_files();
    return std::move(problems_);
  }

 private:
  /// The report of a level; of the nearest one for a level that does not exist.
  LevelReport& level(int number) {
    const int last = static_cast<int>(report_.levels.size()) - 1;
    return report_.levels[static_cast<std::size_t>(std::clamp(number, 0, last))];
  }

  void misstated(const TileKey& key, const std::string& what) {
    ++level(key.level).facts_misstated;
    problems_.push_back(fmt::format("{}: {}", to_string(key), what));
  }

  void find_missing_tiles(int number) {
    const Tiling& tiling = output_.tiling;
    for (std::int64_t y = 0; y < tiling.tile_rows(number); ++y) {
      for (std::int64_t x = 0; x < tiling.tile_columns(number); ++x) {
        const TileKey key{number, x, y};
        if (!domain_.has_triangles(key) || output_.find(key) != nullptr) continue;
        ++level(number).tiles_missing;
        problems_.push_back(fmt::format("{}: missing from tileset.json", to_string(key)));
      }
    }
  }

  void check_entry(const TileEntry& entry) {
    const TileKey& key = entry.key;
    if (!output_.tiling.has(key) || !domain_.has_triangles(key)) {
      ++level(key.level).tiles_unexpected;
      problems_.push_back(fmt::format("{}: the DEM has no terrain there", to_string(key)));
      return;
    }
    check_tile_facts(entry);
    if (entry.parent == output_.tiling.parent(key)) {
      check_against_parent(entry, *output_.find(output_.tiling.parent(key)));
    }
  }

  void check_tile_facts(const TileEntry& entry) {
    const TileKey& key = entry.key;
    const bool is_root = key.level + 1 == output_.tiling.level_count();
    const auto parent = is_root ? std::nullopt : std::optional(output_.tiling.parent(key));
    if (entry.parent != parent) misstated(key, "hangs below the wrong tile in tileset.json");
    if (output_.folder / entry.uri != output_.file_of(key)) {
      misstated(key, fmt::format("its content is '{}'", entry.uri));
    }
    const LevelEntry& stated = output_.levels[static_cast<std::size_t>(key.level)];
    if (entry.geometric_error_m != stated.tolerance_m) {
      misstated(key, fmt::format("geometricError {} is not its level's tolerance of {} m",
                                 entry.geometric_error_m, stated.tolerance_m));
    }
    if (!(entry.box.diagonal_m() <= stated.largest_diagonal_m * (1 + kRelativeSlack))) {
      misstated(key, fmt::format("its box has a diagonal of {} m, the level's largest is said to "
                                 "be {} m",
                                 entry.box.diagonal_m(), stated.largest_diagonal_m));
    }
  }

  void check_against_parent(const TileEntry& entry, const TileEntry& parent) {
    if (!(parent.max_error_m >= entry.max_error_m)) {
      ++level(parent.key.level).nested_errors_violated;
      problems_.push_back(fmt::format("{}: its error of {} m is below the {} m of {}",
                                      to_string(parent.key), parent.max_error_m, entry.max_error_m,
                                      to_string(entry.key)));
    }
    const auto corners = entry.box.corners();
    const bool is_inside = std::all_of(corners.begin(), corners.end(), [&](const auto& corner) {
      return parent.box.contains(corner);
    });
    if (is_inside) return;
    ++level(parent.key.level).boxes_violated;
    problems_.push_back(fmt::format("{}: its box does not contain that of {}",
                                    to_string(parent.key), to_string(entry.key)));
  }

  void check_root() {
    const TileKey root{output_.tiling.level_count() - 1, 0, 0};
    if (output_.refine != "REPLACE") {
      misstated(root, fmt::format("refine is '{}', not REPLACE", output_.refine));
    }
    if (output_.frame.is_local) {
      if (output_.root_transform) misstated(root, "a local frame has no transform");
      return;
    }
    // rotation entries are below 1, so a millimetre is a slack for the translation alone
    const bool agrees = output_.root_transform &&
                        ((*output_.root_transform - world_.to_ecef()).cwiseAbs().array() <=
                         transform_slack().array())
                            .all();
    if (!agrees) misstated(root, "the root's transform is not that of the frame");
  }

  static Eigen::Matrix4d transform_slack() {
    Eigen::Matrix4d slack = Eigen::Matrix4d::Constant(1e-9);
    slack.topRightCorner<3, 1>().setConstant(kTransformSlack_m);
    return slack;
  }

  void find_stray_files() {
    std::set<std::filesystem::path> listed(output_.tilesets.begin(), output_.tilesets.end());
    for (const auto& [key, entry] : output_.tiles) listed.insert(output_.file_of(key));
    std::set<std::filesystem::path> strays;
    for (const char* name : {"tiles", "tilesets", "content", "subtrees"}) {
      const auto folder = output_.folder / name;
      if (!std::filesystem::is_directory(folder)) continue;  // reading the first tile will say so
      for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
        if (!file.is_directory() && !listed.contains(file.path())) strays.insert(file.path());
      }
    }
    for (const auto& stray : strays) {
      const auto name = stray.lexically_relative(output_.folder);
      ++level(level_of(name)).tiles_unexpected;
      problems_.push_back(fmt::format("{}: not in tileset.json", name.generic_string()));
    }
  }

  /// \param name  like "tiles/3/...", or "content/3/..." counted from the root.
  int level_of(const std::filesystem::path& name) const {
    const std::string digits = std::next(name.begin())->string();
    int number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return output_.is_implicit ? output_.tiling.level_count() - 1 - number : number;
  }

  const Output& output_;
  const World& world_;
  const ValidDomain& domain_;
  VerifyReport& report_;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> check_listing(const Output& output, const World& world,
                                       const ValidDomain& domain, VerifyReport& report) {
  return ListingCheck(output, world, domain, report).run();
}

}  // namespace terrane::verify
