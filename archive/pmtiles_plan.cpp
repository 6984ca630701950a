#include "archive/pmtiles_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/errors.h"

namespace terrane::archive {
namespace {

struct NamedTile {
  TileNumbers numbers;
  const PackedFile* file;
};
// by folder and extension
using Groups = std::map<std::pair<std::string, std::string>, std::vector<NamedTile>>;

Groups group_tiles(const std::vector<PackedFile>& files) {
  Groups groups;
  for (const PackedFile& file : files) {
    // a directory entry of length 0 is not allowed
    const auto name = file.bytes > 0 ? parse_tile_name(file.name) : std::nullopt;
    if (name) groups[{name->before, name->extension}].push_back({name->numbers, &file});
  }
  return groups;
}

TilePath find_path(const Groups::value_type& group, const std::filesystem::path& folder) {
  const auto& [before, extension] = group.first;
  const std::uint32_t last_level = std::ranges::max(group.second, {}, [](const NamedTile& tile) {
                                     return tile.numbers.level;
                                   }).numbers.level;
  const auto last_zoom = static_cast<int>(std::min<std::uint32_t>(last_level, kLargestZoom));
  for (const auto& [first_zoom, zoom_step] :
       {std::pair(0, 1), std::pair(1, 1), std::pair(last_zoom, -1)}) {
    const TilePath path(before, extension, first_zoom, zoom_step);
    const bool fits = std::ranges::all_of(group.second, [&](const NamedTile& tile) {
      return path.place_of(tile.numbers).has_value();
    });
    if (fits) return path;
  }
  throw InputError(fmt::format(
      "{}: the tiles {}*/*/*{} are no quadtree: too many a side for their level, either way. Pack "
      "it as .3tz",
      folder.string(), before, extension));
}

}  // namespace

PmtilesPlan plan_pmtiles(const std::vector<PackedFile>& files,
                         const std::filesystem::path& folder) {
  PmtilesPlan plan;
  const Groups groups = group_tiles(files);
  const auto most = std::ranges::max_element(
      groups, {}, [](const Groups::value_type& group) { return group.second.size(); });
  std::map<const PackedFile*, std::uint64_t> ids;
  if (most != groups.end()) {
    plan.path = find_path(*most, folder);
    for (const NamedTile& tile : most->second) {
      const std::uint64_t id = tile_id_of(*plan.path->place_of(tile.numbers));
      ids.emplace(tile.file, id);
      plan.tiles.push_back({id, tile.file});
    }
  }
  std::ranges::sort(plan.tiles, {}, &PlacedTile::id);
  for (const PackedFile& file : files) {
    if (ids.contains(&file)) continue;
    const bool is_at_top = file.name.find('/') == std::string::npos && is_text_name(file.name);
    (is_at_top ? plan.at_top : plan.beside).push_back(&file);
  }
  return plan;
}

}  // namespace terrane::archive
