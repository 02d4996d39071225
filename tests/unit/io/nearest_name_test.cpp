#include "swiftlet/io/nearest_name.hpp"

#include <gtest/gtest.h>

namespace swiftlet::io::nearest_name_test {

TEST(NearestName, IsTheOneThatWasProbablyMeant) {
  const std::vector<std::string> names = {"fly", "arm", "goto", "takeoff", "trajectory"};
  EXPECT_EQ(nearest_name(names, "flyy"), "fly");
  EXPECT_EQ(nearest_name(names, "take"), "takeoff");
  EXPECT_EQ(nearest_name(names, "trajektory"), "trajectory");
  EXPECT_EQ(nearest_name(names, "banana"), "");
  EXPECT_EQ(nearest_name({}, "fly"), "");
}

}  // namespace swiftlet::io::nearest_name_test
