#include "core/errors.h"

#include <gtest/gtest.h>

namespace terrane {
namespace {

// scripts rely on these numbers
TEST(Errors, HaveTheExitStatusThatIsDocumented) {
  EXPECT_EQ(ConfigError("x").exit_status(), 2);
  EXPECT_EQ(InputError("x").exit_status(), 3);
  EXPECT_EQ(TopologyError("x").exit_status(), 4);
  EXPECT_EQ(OutputError("x").exit_status(), 5);
}

TEST(Errors, AreCaughtTogetherWithTheirMessage) {
  try {
    throw InputError("hill.tif: no such file. Check the path");
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "hill.tif: no such file. Check the path");
    EXPECT_EQ(error.exit_status(), 3);
  }
}

}  // namespace
}  // namespace terrane
