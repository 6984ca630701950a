#include "viewer/server/byte_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace terrane::viewer {
namespace {

using ::testing::AllOf;
using ::testing::Field;
using ::testing::VariantWith;

auto is_range(std::uint64_t offset, std::uint64_t length) {
  return VariantWith<ByteRange>(
      AllOf(Field(&ByteRange::offset, offset), Field(&ByteRange::length, length)));
}

// The examples of RFC 9110, section 14.1.2, for a file of 10,000 bytes.
TEST(ParseByteRange, ReadsTheExamplesOfTheStandard) {
  EXPECT_THAT(parse_byte_range("bytes=0-499", 10'000), is_range(0, 500));
  EXPECT_THAT(parse_byte_range("bytes=500-999", 10'000), is_range(500, 500));
  EXPECT_THAT(parse_byte_range("bytes=-500", 10'000), is_range(9500, 500));
  EXPECT_THAT(parse_byte_range("bytes=9500-", 10'000), is_range(9500, 500));
}

TEST(ParseByteRange, IsCutOffAtTheEndOfTheFile) {
  EXPECT_THAT(parse_byte_range("bytes=8-99", 10), is_range(8, 2));
  EXPECT_THAT(parse_byte_range("bytes=8-18446744073709551615", 10), is_range(8, 2));
  EXPECT_THAT(parse_byte_range("bytes=8-99999999999999999999999", 10), is_range(8, 2));
  EXPECT_THAT(parse_byte_range("bytes=-99", 10), is_range(0, 10));
}

TEST(ParseByteRange, RefusesBytesPastTheEnd) {
  for (const char* header :
       {"bytes=10-", "bytes=10-11", "bytes=-0", "bytes=99999999999999999999999-"}) {
    EXPECT_THAT(parse_byte_range(header, 10), VariantWith<NoSuchBytes>(::testing::_)) << header;
  }
  EXPECT_THAT(parse_byte_range("bytes=0-", 0), VariantWith<NoSuchBytes>(::testing::_));
  EXPECT_THAT(parse_byte_range("bytes=-5", 0), VariantWith<NoSuchBytes>(::testing::_));
}

TEST(ParseByteRange, TakesTheWholeFileForWhatItDoesNotUnderstand) {
  for (const char* header :
       {"", "bytes", "bytes=", "bytes=-", "bytes=5", "bytes=5-2", "bytes=a-b", "bytes=1-2,4-5",
        "bytes=0x1-2", "bytes=+1-2", "bytes= 1-2", "items=0-5", "bytes=--5"}) {
    EXPECT_THAT(parse_byte_range(header, 10), VariantWith<WholeFile>(::testing::_)) << header;
  }
}

}  // namespace
}  // namespace terrane::viewer
