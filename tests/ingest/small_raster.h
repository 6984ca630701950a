#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/height_grid.h"
#include "core/progress.h"
#include "ingest/dem.h"

namespace terrane::ingest::testing {

/// A raster for one test. Defaults: 4 x 3 samples 0 ... 11 of Float32, no georeference.
struct SmallRaster {
  int columns = 4;
  int rows = 3;
  int bands = 1;
  std::string type = "Float32";  ///< GDAL's name
  /// Stored value of a sample of the first band; the k-th band after it holds 1000 k more.
  std::function<double(int column, int row)> value;
  std::optional<double> nodata;
  std::string unit;
  std::optional<double> scale;
  std::optional<double> offset;
  std::optional<std::array<double, 6>> geotransform;
  std::string crs;                            ///< anything GDAL takes
  std::string colours;                        ///< "rgb" or "palette"
  std::optional<std::pair<int, int>> masked;  ///< one sample that the mask band hides
  std::vector<std::string> creation_options;  ///< of GeoTIFF
};

/// North-up: the corner of sample (0, 0) at (x, y), square cells.
std::array<double, 6> north_up(double x, double y, double spacing);

/// A new empty folder, removed with all it holds at the end of a test.
class RasterFolder {
 public:
  RasterFolder();
  ~RasterFolder();
  RasterFolder(const RasterFolder&) = delete;
  RasterFolder& operator=(const RasterFolder&) = delete;

  /// Writes a GeoTIFF and returns its path.
  std::string write(const std::string& name, const SmallRaster& raster) const;
  std::string write_text(const std::string& name, std::string_view text) const;
  std::string path_of(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Keeps the notes and counts the steps.
class RecordingProgress final : public Progress {
 public:
  void begin(std::string_view, std::int64_t total) override { total_ = total; }
  void advance(std::int64_t steps) override { done_ += steps; }
  void note(std::string_view line) override { notes_.emplace_back(line); }

  const std::vector<std::string>& notes() const { return notes_; }
  std::int64_t total() const { return total_; }
  std::int64_t done() const { return done_; }

 private:
  std::vector<std::string> notes_;
  std::int64_t total_ = 0;
  std::int64_t done_ = 0;
};

/// What gdal_translate does with these arguments.
void convert(const std::string& from, const std::string& to,
             const std::vector<std::string>& arguments);

std::unique_ptr<Dem> open_quietly(const std::string& source, const OpenOptions& options = {});

HeightGrid read_all(const Dem& dem);

/// What an InputError says; "no error" without one, the text of another exception otherwise.
std::string input_error_of(const std::function<void()>& action);

/// Path of a real DEM, or empty where the data folder is absent.
std::string real_dem(const std::string& relative);

}  // namespace terrane::ingest::testing

#define TERRANE_SKIP_WITHOUT(path) \
  if ((path).empty()) GTEST_SKIP() << "the folder with real DEMs is absent"
