#include "ingest/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/errors.h"
#include "ingest/fingerprint.h"

namespace terrane::ingest {
namespace {

// 4 MB as float, 8 MB more while they are converted
constexpr std::int64_t kSamplesAtOnce = std::int64_t{1} << 20;

struct ChunkSize {
  std::int64_t columns;
  std::int64_t rows;
};

// as many whole blocks as fit, along the row first: GDAL then decodes each block once
ChunkSize chunk_size(const Dem& dem) {
  const DemDescription& about = dem.description();
  const GridShape shape = dem.heights().shape();
  const auto times_that_fit = [](std::int64_t samples) {
    return std::max<std::int64_t>(kSamplesAtOnce / samples, 1);
  };
  ChunkSize chunk{about.block_columns, about.block_rows};
  chunk.columns *= times_that_fit(chunk.columns * chunk.rows);
  chunk.columns = std::min(chunk.columns, shape.columns);
  chunk.rows *= times_that_fit(chunk.columns * chunk.rows);
  // formats that store the whole grid as one block
  chunk.rows = std::min(chunk.rows, times_that_fit(chunk.columns));
  return {chunk.columns, std::min(chunk.rows, shape.rows)};
}

bool is_suspect(float height_m, const SuspectHeight& suspect) {
  if (!suspect.and_everything_beyond) return height_m == suspect.height_m;
  return suspect.height_m < 0 ? height_m <= suspect.height_m : height_m >= suspect.height_m;
}

class Tally {
 public:
  explicit Tally(const Dem& dem) : dem_(dem), suspect_counts_(dem.suspects().size()) {}

  void count(std::span<const float> heights_m) {
    for (const float height_m : heights_m) {
      if (std::isnan(height_m)) continue;
      ++with_data_;
      min_m_ = std::min(min_m_, height_m);
      max_m_ = std::max(max_m_, height_m);
      // nearly every height is above all suspects of an ordinary file
      if (height_m <= highest_suspect_m_) count_suspect(height_m);
    }
  }

  HeightStatistics statistics() const {
    return {with_data_, static_cast<double>(min_m_), static_cast<double>(max_m_), ""};
  }

  const std::vector<std::int64_t>& suspect_counts() const { return suspect_counts_; }

 private:
  void count_suspect(float height_m) {
    for (std::size_t i = 0; i < suspect_counts_.size(); ++i) {
      if (!is_suspect(height_m, dem_.suspects()[i])) continue;
      ++suspect_counts_[i];
      return;
    }
  }

  static float highest_of(const std::vector<SuspectHeight>& suspects) {
    float highest_m = -std::numeric_limits<float>::infinity();
    for (const SuspectHeight& suspect : suspects) {
      highest_m = std::max(highest_m, suspect.height_m);
      // a negative scale turns the lowest values into the highest heights
      if (suspect.and_everything_beyond && suspect.height_m > 0) {
        highest_m = std::numeric_limits<float>::infinity();
      }
    }
    return highest_m;
  }

  const Dem& dem_;
  std::vector<std::int64_t> suspect_counts_;
  float highest_suspect_m_ = highest_of(dem_.suspects());
  std::int64_t with_data_ = 0;
  float min_m_ = std::numeric_limits<float>::infinity();
  float max_m_ = -std::numeric_limits<float>::infinity();
};

std::string with_thousands(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (std::int64_t i = std::ssize(digits) - 3; i > 0; i -= 3) {
    digits.insert(static_cast<std::size_t>(i), ",");
  }
  return digits;
}

void refuse_suspects(const Dem& dem, const std::vector<std::int64_t>& counts) {
  std::vector<std::string> nodata;
  for (const double declared : dem.description().nodata) {
    if (!std::isnan(declared)) nodata.push_back(fmt::format("{}", declared));
  }
  std::vector<std::string> found;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const std::string& stored = dem.suspects()[i].stored;
    found.push_back(fmt::format("{} samples hold {}", with_thousands(counts[i]), stored));
    nodata.push_back(stored);
  }
  if (found.empty()) return;
  throw InputError(
      fmt::format("{}: {}, which is not declared but looks like 'no data'. Use "
                  "--nodata {}, or --nodata none to take it as a height",
                  dem.name(), fmt::join(found, " and "), fmt::join(nodata, ",")));
}

void refuse_empty(const Dem& dem, const HeightStatistics& statistics) {
  if (statistics.samples_with_data > 0) return;
  throw InputError(
      fmt::format("{}: no sample holds a height (all are no data). Check --nodata and "
                  "--band, or give another file",
                  dem.name()));
}

void add_place(const Dem& dem, Fingerprint& fingerprint) {
  const GridShape shape = dem.heights().shape();
  fingerprint.add(static_cast<std::uint64_t>(shape.columns));
  fingerprint.add(static_cast<std::uint64_t>(shape.rows));
  // three places fix an affine map
  for (const GridPosition position : {GridPosition{0, 0}, GridPosition{1, 0}, GridPosition{0, 1}}) {
    const PlanPosition plan = dem.place().to_plan(position);
    fingerprint.add(plan.x);
    fingerprint.add(plan.y);
  }
  fingerprint.add(std::string_view(dem.place().crs_wkt()));
}

// each row has its own hash, so that it does not matter how wide the chunks are
void scan_rows(const Dem& dem, std::int64_t row, std::int64_t rows, std::int64_t chunk_columns,
               Tally& tally, Fingerprint& fingerprint) {
  const std::int64_t columns = dem.heights().shape().columns;
  std::vector<Fingerprint> row_fingerprints(static_cast<std::size_t>(rows));
  for (std::int64_t column = 0; column < columns; column += chunk_columns) {
    const std::int64_t width = std::min(chunk_columns, columns - column);
    const HeightGrid grid = dem.heights().read({column, row, width, rows});
    tally.count(grid.heights_m);
    for (std::int64_t r = 0; r < rows; ++r) {
      row_fingerprints[static_cast<std::size_t>(r)].add(
          std::span(grid.heights_m)
              .subspan(static_cast<std::size_t>(r * width), static_cast<std::size_t>(width)));
    }
  }
  for (const Fingerprint& of_row : row_fingerprints) fingerprint.add(of_row.value());
}

}  // namespace

HeightStatistics scan_heights(const Dem& dem, Progress& progress) {
  const GridShape shape = dem.heights().shape();
  const ChunkSize chunk = chunk_size(dem);
  Tally tally(dem);
  Fingerprint fingerprint;
  add_place(dem, fingerprint);
  progress.begin("reading heights", shape.rows);
  for (std::int64_t row = 0; row < shape.rows; row += chunk.rows) {
    const std::int64_t rows = std::min(chunk.rows, shape.rows - row);
    scan_rows(dem, row, rows, chunk.columns, tally, fingerprint);
    progress.advance(rows);
  }
  refuse_suspects(dem, tally.suspect_counts());
  HeightStatistics statistics = tally.statistics();
  refuse_empty(dem, statistics);
  statistics.fingerprint = fingerprint.hex();
  return statistics;
}

}  // namespace terrane::ingest
