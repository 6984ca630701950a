#include "ingest/synthetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "ingest/grid_place.h"
#include "ingest/synthetic_terrain.h"

namespace terrane::ingest {
namespace {

constexpr std::string_view kPrefix = "synthetic:";
constexpr std::uint64_t kHoleStream = 1000;  // beyond the octaves of the hills

enum class Shape { kCaldera, kPlane, kFlat };

struct Recipe {
  Shape shape = Shape::kCaldera;
  std::int64_t columns = 513;
  std::int64_t rows = 513;
  double spacing_m = 10;
  std::uint64_t seed = 1;
  int holes = 0;
};

Shape parse_shape(std::string_view word, const std::string& source) {
  if (word == "caldera") return Shape::kCaldera;
  if (word == "plane") return Shape::kPlane;
  if (word == "flat") return Shape::kFlat;
  throw InputError(fmt::format("{}: no synthetic shape is called '{}'. Use caldera, plane or flat",
                               source, word));
}

template <typename Number>
Number parse_value(std::string_view key, std::string_view text, Number least, Number most,
                   const std::string& source) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && stop == end && value >= least && value <= most) return value;
  throw InputError(
      fmt::format("{}: {} is '{}'. Give a number from {} to {}", source, key, text, least, most));
}

void apply(std::string_view key, std::string_view text, const std::string& source, Recipe& recipe) {
  const auto side = [&] { return parse_value<std::int64_t>(key, text, 2, 100000, source); };
  if (key == "size") {
    recipe.columns = recipe.rows = side();
  } else if (key == "columns") {
    recipe.columns = side();
  } else if (key == "rows") {
    recipe.rows = side();
  } else if (key == "spacing") {
    recipe.spacing_m = parse_value<double>(key, text, 0.001, 100000, source);
  } else if (key == "seed") {
    recipe.seed = parse_value<std::uint64_t>(key, text, 0, UINT64_MAX, source);
  } else if (key == "holes") {
    recipe.holes = parse_value<int>(key, text, 0, 10000, source);
  } else {
    throw InputError(
        fmt::format("{}: no key is called '{}'. Use size, columns, rows, spacing, seed "
                    "or holes",
                    source, key));
  }
}

Recipe parse_recipe(const std::string& source) {
  std::string_view text = std::string_view(source).substr(kPrefix.size());
  const std::size_t question = std::min(text.find('?'), text.size());
  Recipe recipe;
  recipe.shape = parse_shape(text.substr(0, question), source);
  text.remove_prefix(std::min(question + 1, text.size()));
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    apply(pair.substr(0, equals), pair.substr(std::min(equals + 1, pair.size())), source, recipe);
  }
  return recipe;
}

struct Hole {
  double column;
  double row;
  double radius_cells;
};

std::vector<Hole> dig_holes(const Recipe& recipe) {
  const auto columns = static_cast<double>(recipe.columns);
  const auto rows = static_cast<double>(recipe.rows);
  std::vector<Hole> holes;
  for (int i = 0; i < recipe.holes; ++i) {
    const auto fraction = [&](std::int64_t j) {
      return hashed_fraction(recipe.seed, kHoleStream, i, j);
    };
    const double radius_cells = std::min(columns, rows) * (0.01 + 0.03 * fraction(2));
    holes.push_back({columns * fraction(0), rows * fraction(1), std::max(radius_cells, 1.5)});
  }
  return holes;
}

class SyntheticHeights final : public HeightSource {
 public:
  explicit SyntheticHeights(const Recipe& recipe) : recipe_(recipe), holes_(dig_holes(recipe)) {}

  GridShape shape() const override { return {recipe_.columns, recipe_.rows}; }

  HeightGrid read(const Window& window) const override {
    HeightGrid grid{window, {}};
    grid.heights_m.reserve(static_cast<std::size_t>(window.columns * window.rows));
    for (std::int64_t r = 0; r < window.rows; ++r) {
      for (std::int64_t c = 0; c < window.columns; ++c) {
        grid.heights_m.push_back(
            height_m(static_cast<double>(window.column + c), static_cast<double>(window.row + r)));
      }
    }
    return grid;
  }

 private:
  float height_m(double column, double row) const {
    const auto contains = [&](const Hole& hole) {
      const double dx = column - hole.column;
      const double dy = row - hole.row;
      return dx * dx + dy * dy < hole.radius_cells * hole.radius_cells;
    };
    if (std::any_of(holes_.begin(), holes_.end(), contains)) return kNoHeight;
    return static_cast<float>(ground_m(column, row));
  }

  double ground_m(double column, double row) const {
    if (recipe_.shape == Shape::kFlat) return 100;
    if (recipe_.shape == Shape::kPlane) {
      return 0.1 * (column * recipe_.spacing_m) - 0.05 * (row * recipe_.spacing_m);
    }
    const auto last_column = static_cast<double>(recipe_.columns - 1);
    const auto last_row = static_cast<double>(recipe_.rows - 1);
    const double side = std::min(last_column, last_row);
    return caldera_height_m((2 * column - last_column) / side, (2 * row - last_row) / side,
                            recipe_.seed);
  }

  Recipe recipe_;
  std::vector<Hole> holes_;
};

DemDescription describe(const std::string& source, const Recipe& recipe) {
  DemDescription about;
  about.files = {source};
  about.format = "synthetic";
  about.data_type = "Float32";
  about.vertical_unit_origin = "the shape";
  about.column_spacing = about.row_spacing = recipe.spacing_m;
  about.block_columns = recipe.columns;
  return about;
}

}  // namespace

bool is_synthetic(const std::string& source) { return source.starts_with(kPrefix); }

std::unique_ptr<Dem> open_synthetic_dem(const std::string& source) {
  const Recipe recipe = parse_recipe(source);
  const double s = recipe.spacing_m;
  const Geotransform centred_on_first_sample = {-0.5 * s, s, 0, 0.5 * s, 0, -s};
  return std::make_unique<Dem>(
      source, describe(source, recipe), std::vector<SuspectHeight>(),
      std::make_unique<SyntheticHeights>(recipe),
      std::make_unique<GridPlace>(source, centred_on_first_sample, "", nullptr));
}

}  // namespace terrane::ingest
