#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/height_source.h"
#include "tiler/verify/verify.h"

namespace terrane::verify::testing {

/// A DEM given by a function of column and row.
class FakeDem final : public HeightSource {
 public:
  using Height = std::function<float(std::int64_t column, std::int64_t row)>;

  FakeDem(GridShape shape, Height height) : shape_(shape), height_(std::move(height)) {}
  GridShape shape() const override { return shape_; }
  HeightGrid read(const Window& window) const override;
  float at(std::int64_t column, std::int64_t row) const { return height_(column, row); }

 private:
  GridShape shape_;
  Height height_;
};

/// A plan without a CRS: cells of 8 m, north up, rotated about sample (0, 0) by an angle.
class FlatPlace final : public Georeference {
 public:
  explicit FlatPlace(double rotation_rad = 0) : rotation_rad_(rotation_rad) {}
  const std::string& crs_wkt() const override { return crs_wkt_; }
  PlanPosition to_plan(GridPosition position) const override;
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition>) const override { return {}; }

 private:
  double rotation_rad_;
  std::string crs_wkt_;
};

/// Longitude and latitude; sample (0, 0) in the north-west.
class GeographicPlace final : public Georeference {
 public:
  GeographicPlace(LonLat first, double spacing_deg) : first_(first), spacing_deg_(spacing_deg) {}
  const std::string& crs_wkt() const override { return crs_wkt_; }
  PlanPosition to_plan(GridPosition position) const override;
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const override;

 private:
  LonLat first_;
  double spacing_deg_;
  std::string crs_wkt_ = "GEOGCRS[]";
};

using Triple = std::array<std::int64_t, 3>;

struct FakeTile {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  double max_error_m = 0;
  std::vector<Triple> position;
  std::vector<Triple> morph;
  std::vector<std::array<std::int64_t, 2>> sample;  ///< column and row of each vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::set<std::size_t> in_water;  ///< numbers of triangles

  /// The vertex that stands on a sample at t = 0.
  std::size_t vertex_at(std::int64_t column, std::int64_t row) const;

  /// The triangle with these corners, given by their samples, in any order.
  std::size_t triangle_at(std::array<std::array<std::int64_t, 2>, 3> samples) const;
};

struct FakeLevel {
  double tolerance_m = 0;
  std::array<double, 3> step_m = {};
};

/// What the fake builder makes: changed by a test, then written.
struct FakeOutput {
  nlohmann::json frame;
  GridShape shape;
  int tile_cells = 4;
  std::vector<FakeLevel> levels;
  std::vector<FakeTile> tiles;
  double lowest_m = -1000;  ///< of every box
  double highest_m = 1000;
  std::vector<double> root_transform;
  std::function<void(nlohmann::json&)> edit_terrane = [](auto&) {};
  std::function<void(nlohmann::json&)> edit_glb = [](auto&) {};  ///< of tile 0/0/0

  /// Changes the entry of a tile in tileset.json.
  std::function<void(nlohmann::json& entry, const FakeTile&)> edit_tile = [](auto&, auto&) {};

  FakeTile& tile(int level, std::int64_t x, std::int64_t y);
  void drop_tile(int level, std::int64_t x, std::int64_t y);
};

/// Where a grid position and a height stand in the world of a fake output.
using ToWorld = std::function<std::array<double, 3>(double column, double row, double height_m)>;

/// A DEM as its own hierarchy: level l is the grid of every 2^l-th sample, and a vertex goes to the
/// next one to its north-west that level l + 1 has.
///
///   level 0           t = 0.5           t = 1 = level 1
///   +--+--+--+--+     ++---++---+       +-----+-----+
///   |\ |\ |\ |\ |     ++---++---+       | \   | \   |
///   +--+--+--+--+     | \  | \  |       |   \ |   \ |
///   |\ |\ |\ |\ |     |   \|   \|       +-----+-----+
///   +--+--+--+--+     ++---++---+
///
/// Exact where heights are multiples of 0.25 * 2^(levels - 1) metres.
FakeOutput halved_grids(const FakeDem& dem, const ToWorld& to_world, int tile_cells,
                        double tolerance_m);

/// The DEM itself at every level, voids left out; nothing moves.
FakeOutput repeated_grids(const FakeDem& dem, const ToWorld& to_world, int tile_cells,
                          double tolerance_m,
                          const std::array<double, 3>& step_m = {0.25, 0.25, 0.25});

/// World of FlatPlace with the frame at sample (0, 0).
ToWorld flat_world(const FlatPlace& place);

/// Writes an output into an empty folder of its own, and removes it at the end.
class WrittenOutput {
 public:
  explicit WrittenOutput(const FakeOutput& output);
  ~WrittenOutput();
  WrittenOutput(const WrittenOutput&) = delete;
  WrittenOutput& operator=(const WrittenOutput&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// Writes, verifies, removes.
VerifyReport verdict_on(const FakeOutput& output, const FakeDem& dem, const Georeference& place,
                        std::vector<WaterArea> water = {});

}  // namespace terrane::verify::testing
