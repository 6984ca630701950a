#include "ingest/fingerprint.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace terrane::ingest {
namespace {

// the first three numbers of splitmix64 from seed 0, as its authors publish them
TEST(Mix, IsTheFinalizerOfSplitmix64) {
  constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15;
  EXPECT_EQ(mix(kStep), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(mix(2 * kStep), 0x6E789E6AA1B965F4u);
  EXPECT_EQ(mix(3 * kStep), 0x06C45D188009454Fu);
}

std::string of(std::initializer_list<float> heights_m) {
  Fingerprint fingerprint;
  fingerprint.add(std::span<const float>(heights_m.begin(), heights_m.size()));
  return fingerprint.hex();
}

TEST(Fingerprint, HasSixteenDigits) {
  EXPECT_EQ(of({1, 2, 3}).size(), 16u);
  EXPECT_EQ(of({1, 2, 3}).find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(Fingerprint, DependsOnValuesTheirOrderAndTheirNumber) {
  const std::set<std::string> all = {
      of({}),     of({0}),       of({0, 0}),  of({1, 2}),
      of({2, 1}), of({1, 2, 0}), of({-1, 2}), of({1, std::nextafterf(2, 3)})};
  EXPECT_EQ(all.size(), 8u);
}

TEST(Fingerprint, TakesAllNansForOneAndBothZerosForOne) {
  EXPECT_EQ(of({std::nanf("1"), 2}), of({-std::nanf("2"), 2}));
  EXPECT_EQ(of({0.0F}), of({-0.0F}));
  EXPECT_NE(of({std::nanf(""), 2}), of({0, 2}));
}

TEST(Fingerprint, DoesNotDependOnThePieces) {
  Fingerprint pieces;
  const std::array<float, 3> heights_m = {1, 2, 3};
  pieces.add(std::span(heights_m).first(1));
  pieces.add(std::span(heights_m).last(2));
  EXPECT_EQ(pieces.hex(), of({1, 2, 3}));
}

}  // namespace
}  // namespace terrane::ingest
