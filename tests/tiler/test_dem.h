#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/height_statistics.h"
#include "tests/temporary_folder.h"

namespace terrane::tiler::testing {

/// A DEM from a function of column and row; NaN makes a hole.
class FunctionDem final : public HeightSource {
 public:
  using Height = std::function<double(std::int64_t, std::int64_t)>;

  FunctionDem(GridShape shape, Height height) : shape_(shape), height_(std::move(height)) {}

  GridShape shape() const override { return shape_; }

  HeightGrid read(const Window& window) const override {
    HeightGrid grid{window, {}};
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        grid.heights_m.push_back(static_cast<float>(height_(column, row)));
      }
    }
    return grid;
  }

  HeightStatistics statistics(const std::string& fingerprint = "0") const {
    HeightStatistics result{0, INFINITY, -INFINITY, fingerprint};
    for (const float height_m : read({0, 0, shape_.columns, shape_.rows}).heights_m) {
      if (std::isnan(height_m)) continue;
      ++result.samples_with_data;
      result.min_height_m = std::min(result.min_height_m, double{height_m});
      result.max_height_m = std::max(result.max_height_m, double{height_m});
    }
    return result;
  }

 private:
  GridShape shape_;
  Height height_;
};

/// Plain metres without a CRS; a negative row spacing makes a south-up grid.
class PlainPlace final : public Georeference {
 public:
  explicit PlainPlace(double column_m = 10, double row_m = 10)
      : column_m_(column_m), row_m_(row_m) {}

  const std::string& crs_wkt() const override { return none_; }
  PlanPosition to_plan(GridPosition p) const override {
    return {500000 + p.column * column_m_, 4000000 - p.row * row_m_};
  }
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition>) const override {
    throw std::logic_error("a DEM without a CRS has no longitudes");
  }

 private:
  std::string none_;
  double column_m_, row_m_;
};

/// Longitude and latitude in equal steps.
class GeographicPlace final : public Georeference {
 public:
  GeographicPlace(LonLat first, double step_deg) : first_(first), step_deg_(step_deg) {}

  const std::string& crs_wkt() const override { return wkt_; }
  PlanPosition to_plan(GridPosition p) const override {
    return {first_.longitude_deg + p.column * step_deg_, first_.latitude_deg - p.row * step_deg_};
  }
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const override {
    std::vector<LonLat> result;
    for (const GridPosition& p : positions) result.push_back({to_plan(p).x, to_plan(p).y});
    return result;
  }

 private:
  std::string wkt_ = "GEOGCRS[\"WGS 84\"]";
  LonLat first_;
  double step_deg_;
};

using terrane::testing::TemporaryFolder;

inline std::string content_of(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(content).str();
}

/// Every file below a folder with its bytes.
inline std::map<std::string, std::string> bytes_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder).string()] = content_of(entry.path());
  }
  return files;
}

}  // namespace terrane::tiler::testing
