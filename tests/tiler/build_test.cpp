#include "tiler/build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <random>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"
#include "tiler/files/output_folder.h"
#include "tiler/verify/verify.h"

namespace terrane::tiler {
namespace {

using testing::bytes_below;
using testing::FunctionDem;
using testing::GeographicPlace;
using testing::PlainPlace;
using testing::TemporaryFolder;

double hills(std::int64_t column, std::int64_t row) {
  const auto x = static_cast<double>(column), y = static_cast<double>(row);
  return 800 + 60 * std::sin(0.11 * x) * std::cos(0.07 * y) + 9 * std::sin(0.9 * x + 0.4 * y);
}

BuildResult build_hills(const std::filesystem::path& out, const BuildOptions& options) {
  const FunctionDem dem({60, 45}, hills);
  NoProgress progress;
  return build(dem, PlainPlace(), dem.statistics(), options, out, progress);
}

/// What the verifier says of a build; it shares no code with the builder.
verify::VerifyReport verdict(const FunctionDem& dem, const Georeference& place,
                             const BuildOptions& options) {
  const TemporaryFolder folder;
  NoProgress progress;
  build(dem, place, dem.statistics(), options, folder.path(), progress);
  return verify::verify(folder.path(), dem, place, {}, progress);
}

TEST(Build, WritesTheSameBytesWithAnyNumberOfThreads) {
  const TemporaryFolder one, four;
  build_hills(one.path(), {.tolerance_m = 2, .tile_cells = 16, .jobs = 1});
  build_hills(four.path(), {.tolerance_m = 2, .tile_cells = 16, .jobs = 4});
  EXPECT_EQ(bytes_below(one.path()), bytes_below(four.path()));
}

TEST(Build, FindsAFinishedOutputUpToDateAndAChangedSettingNot) {
  const TemporaryFolder folder;
  EXPECT_FALSE(build_hills(folder.path(), {.tolerance_m = 2, .tile_cells = 16}).was_up_to_date);
  EXPECT_TRUE(build_hills(folder.path(), {.tolerance_m = 2, .tile_cells = 16}).was_up_to_date);
  EXPECT_FALSE(build_hills(folder.path(), {.tolerance_m = 3, .tile_cells = 16}).was_up_to_date);
  EXPECT_TRUE(build_hills(folder.path(), {.tolerance_m = 3, .tile_cells = 16}).was_up_to_date);
  const BuildOptions patient{.tolerance_m = 3, .tile_cells = 16, .effort = 3};
  EXPECT_FALSE(build_hills(folder.path(), patient).was_up_to_date);
  EXPECT_TRUE(build_hills(folder.path(), patient).was_up_to_date);
}

TEST(Build, EachEffortHoldsAndNeedsFewerTrianglesThanTheOneBefore) {
  const FunctionDem dem({130, 130}, hills);
  std::int64_t triangles = 130 * 130 * 2;
  for (const int effort : {0, 1, 2, 3}) {
    const auto report =
        verdict(dem, PlainPlace(), {.tolerance_m = 2, .tile_cells = 32, .effort = effort});
    EXPECT_TRUE(report.holds()) << "effort " << effort << "\n" << to_text(report);
    EXPECT_LT(report.levels[0].triangles, triangles) << "effort " << effort;
    triangles = report.levels[0].triangles;
  }
}

TEST(Build, WritesTheSameBytesWithAnyNumberOfThreadsAtTopEffort) {
  const TemporaryFolder one, two;
  build_hills(one.path(), {.tolerance_m = 2, .tile_cells = 16, .effort = 3, .jobs = 1});
  build_hills(two.path(), {.tolerance_m = 2, .tile_cells = 16, .effort = 3, .jobs = 2});
  EXPECT_EQ(bytes_below(one.path()), bytes_below(two.path()));
}

TEST(Build, TidiesUpAfterOneThatWasKilledWhileItTidiedUp) {
  const TemporaryFolder folder;
  const BuildOptions options{.tolerance_m = 2, .tile_cells = 16};
  build_hills(folder.path(), options);
  const auto whole = bytes_below(folder.path());
  std::filesystem::create_directories(folder.path() / ".work" / "0");
  std::ofstream(folder.path() / ".work" / "0" / "0.tile") << "left over";
  EXPECT_TRUE(build_hills(folder.path(), options).was_up_to_date);
  EXPECT_EQ(bytes_below(folder.path()), whole);
}

TEST(Build, MendsAnOutputThatLostATile) {
  const TemporaryFolder folder;
  const BuildOptions options{.tolerance_m = 2, .tile_cells = 16};
  build_hills(folder.path(), options);
  const auto whole = bytes_below(folder.path());
  std::filesystem::remove(folder.path() / "tiles/0/1/1.glb");
  EXPECT_FALSE(build_hills(folder.path(), options).was_up_to_date);
  EXPECT_EQ(bytes_below(folder.path()), whole);
}

TEST(Build, ALadderOfThreeLevelsPerOctaveDoublesWithEveryThird) {
  const FunctionDem dem({60, 45}, hills);
  const auto report =
      verdict(dem, PlainPlace(), {.tolerance_m = 2, .tile_cells = 16, .levels_per_octave = 3});
  EXPECT_TRUE(report.holds()) << to_text(report);
  ASSERT_EQ(report.levels.size(), 7U);
  EXPECT_EQ(report.levels[3].tolerance_m, 4);
  EXPECT_EQ(report.levels[6].tolerance_m, 8);
  EXPECT_NEAR(report.levels[4].tolerance_m / report.levels[3].tolerance_m, std::cbrt(2.0), 1e-12);
  EXPECT_EQ(report.levels[2].tiles, 12);
  EXPECT_EQ(report.levels[3].tiles, 4);
  for (std::size_t l = 1; l < 7; ++l) {
    EXPECT_LE(report.levels[l].triangles, report.levels[l - 1].triangles);
  }
}

/// Fails after a number of seams and tiles.
class BreakingProgress final : public Progress {
 public:
  explicit BreakingProgress(int steps) : steps_left_(steps) {}
  void begin(std::string_view, std::int64_t) override {}
  void advance(std::int64_t) override {
    if (--steps_left_ < 0) throw InputError("the cable was pulled");
  }
  void note(std::string_view) override {}

 private:
  std::atomic<int> steps_left_;
};

/// Stops a build after a number of seams and tiles, as if it had been killed there.
class StoppedBuild : public ::testing::TestWithParam<int> {};

TEST_P(StoppedBuild, GoesOnToTheSameBytes) {
  const BuildOptions options{.tolerance_m = 2, .tile_cells = 16, .jobs = 1};
  const TemporaryFolder whole, stopped;
  build_hills(whole.path(), options);

  const FunctionDem dem({60, 45}, hills);
  BreakingProgress progress(GetParam());
  EXPECT_THROW(build(dem, PlainPlace(), dem.statistics(), options, stopped.path(), progress),
               InputError);
  EXPECT_FALSE(std::filesystem::exists(stopped.path() / "terrane.json"));

  build_hills(stopped.path(), options);
  EXPECT_EQ(bytes_below(stopped.path()), bytes_below(whole.path()));
}

INSTANTIATE_TEST_SUITE_P(AfterSteps, StoppedBuild,
                         ::testing::Values(0, 5, 16, 17, 23, 28, 29, 31, 33, 35, 37));

TEST(Build, RefusesSettingsOutOfRange) {
  EXPECT_THROW(check({.tolerance_m = -1}), ConfigError);
  EXPECT_THROW(check({.tolerance_m = NAN}), ConfigError);
  EXPECT_THROW(check({.tile_cells = 2}), ConfigError);
  EXPECT_THROW(check({.levels_per_octave = 0}), ConfigError);
  EXPECT_THROW(check({.levels_per_octave = 5}), ConfigError);
  EXPECT_THROW(check({.effort = -1}), ConfigError);
  EXPECT_THROW(check({.effort = 4}), ConfigError);
  EXPECT_THROW(check({.jobs = -1}), ConfigError);
}

TEST(Build, SaysWhatToDoWhereTheToleranceIsFinerThanTheLattice) {
  const TemporaryFolder folder;
  try {
    build_hills(folder.path(), {.tolerance_m = 1e-5, .tile_cells = 16});
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--tolerance"));
  }
}

TEST(Build, ADemOfLonelySamplesIsAnInputError) {
  const TemporaryFolder folder;
  const FunctionDem dem({9, 9}, [](auto c, auto r) { return c % 2 == 0 && r % 2 == 0 ? 1 : NAN; });
  NoProgress progress;
  EXPECT_THROW(build(dem, PlainPlace(), dem.statistics(), {}, folder.path(), progress), InputError);
}

struct Awkward {
  const char* name;
  GridShape shape;
  double (*height)(std::int64_t, std::int64_t);
};

void PrintTo(const Awkward& awkward, std::ostream* stream) { *stream << awkward.name; }

class AwkwardDem : public ::testing::TestWithParam<Awkward> {};

TEST_P(AwkwardDem, HoldsEveryInvariantAtEveryLevel) {
  const FunctionDem dem(GetParam().shape, GetParam().height);
  for (const double tolerance_m : {0.5, 4.0}) {
    for (const int levels_per_octave : {1, 3}) {
      const auto report = verdict(
          dem, PlainPlace(),
          {.tolerance_m = tolerance_m, .tile_cells = 8, .levels_per_octave = levels_per_octave});
      EXPECT_TRUE(report.holds()) << levels_per_octave << " levels per octave\n" << to_text(report);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, AwkwardDem,
    ::testing::Values(
        Awkward{"Constant", {40, 40}, [](auto, auto) { return 12.0; }},
        Awkward{"TwoByTwo", {2, 2}, [](auto c, auto r) { return 3.0 * c * r; }},
        Awkward{"Checkerboard", {30, 21}, [](auto c, auto r) { return (c + r) % 2 * 10.0; }},
        Awkward{"Cliff", {33, 33}, [](auto c, auto r) { return 2 * c > r + 16 ? 300.0 : 0.0; }},
        Awkward{
            "Spikes", {37, 41}, [](auto c, auto r) { return c % 9 == 4 && r % 7 == 3 ? 80 : 0.; }},
        Awkward{"Plateaus", {40, 30}, [](auto c, auto r) { return 25.0 * (c / 7 + r / 5); }},
        Awkward{"LongAndThin", {200, 3}, [](auto c, auto r) { return hills(c, r); }},
        Awkward{"SingleSampleHoles",
                {40, 40},
                [](auto c, auto r) { return c % 6 == 2 && r % 5 == 3 ? NAN : hills(c, r); }},
        Awkward{"HolesOnSeams",
                {40, 40},
                [](auto c, auto r) { return c % 8 == 0 && r % 5 < 2 ? NAN : hills(c, r); }},
        Awkward{
            "TouchingHoles",
            {24, 24},
            [](auto c, auto r) { return c / 3 % 2 == r / 3 % 2 && c % 3 && r % 3 ? NAN : 5.0; }},
        Awkward{"SlantedRim",
                {50, 50},
                [](auto c, auto r) { return r < c / 9 || c < r / 7 ? NAN : hills(c, r); }}),
    [](const auto& tested) { return std::string(tested.param.name); });

class RandomDem : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomDem, HoldsEveryInvariantAtEveryLevel) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const GridShape shape{static_cast<std::int64_t>(uniform(3, 50)),
                        static_cast<std::int64_t>(uniform(3, 50))};
  const double roughness_m = uniform(0, 15), holes = uniform(0, 0.03);
  std::vector<double> heights_m;
  for (std::int64_t i = 0; i < shape.columns * shape.rows; ++i) {
    heights_m.push_back(uniform(0, 1) < holes ? NAN
                                              : hills(i % shape.columns, i / shape.columns) +
                                                    uniform(0, roughness_m));
  }
  const FunctionDem dem(shape, [&](auto column, auto row) {
    return heights_m[static_cast<std::size_t>(row * shape.columns + column)];
  });
  const BuildOptions options{.tolerance_m = uniform(1, 8),
                             .tile_cells = 8,
                             .levels_per_octave = 1 + static_cast<int>(GetParam() % 4),
                             .effort = static_cast<int>(GetParam() / 4 % 4)};

  const PlainPlace south_up(7, -12);
  EXPECT_TRUE(verdict(dem, south_up, options).holds());
  const GeographicPlace alps({8.2, 46.9}, 1.0 / 1200);
  const auto report = verdict(dem, alps, options);
  EXPECT_TRUE(report.holds()) << to_text(report);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDem, ::testing::Range(0U, 40U));

TEST(Build, AStripOfTilesHolds) {
  const FunctionDem dem({65, 1000}, [](auto c, auto r) { return 5 * hills(c, r) + c % 5; });
  const auto report = verdict(dem, PlainPlace(), {.tolerance_m = 4, .levels_per_octave = 2});
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_EQ(report.levels.size(), 9U);
}

TEST(Build, SeamsOverAPlaneVanishWithTheRest) {
  // nine leaf tiles: two triangles each would do, four leave room for the order of collapses
  const FunctionDem dem({97, 97}, [](auto c, auto r) { return 2.0 * c + 3.0 * r; });
  const auto report = verdict(dem, PlainPlace(), {.tolerance_m = 1, .tile_cells = 32});
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_LE(report.levels[0].triangles, 9 * 4);
}

TEST(Build, SeamsAlongParallelsVanishToo) {
  // a chord of 32 cells of 3" leaves its parallel by about 0.1 m, half a step and more
  const FunctionDem dem({97, 97}, [](auto, auto) { return 500.0; });
  const GeographicPlace alps({8.2, 46.9}, 1.0 / 1200);
  const auto report = verdict(dem, alps, {.tolerance_m = 2, .tile_cells = 32});
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_LE(report.levels[0].triangles, 9 * 4);
}

TEST(Build, HoldsTheBoundUnderACurvedEarth) {
  // 1 km cells, 60 km wide, flat: chords of 20 km sink 8 m, and 0.5 m is asked for
  const FunctionDem dem({61, 61}, [](auto, auto) { return 100.0; });
  const GeographicPlace place({170, -40}, 1.0 / 111);
  const auto report = verdict(dem, place, {.tolerance_m = 0.5, .tile_cells = 16});
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_GT(report.levels.back().triangles, 8);
}

}  // namespace
}  // namespace terrane::tiler
