#include "swiftlet/control/estimation/poses_ahead.hpp"

#include <gtest/gtest.h>

namespace swiftlet::control::poses_ahead_test {

plant::PoseSample pose(std::int64_t stamp_ns) {
  plant::PoseSample out;
  out.stamp_ns = stamp_ns;
  return out;
}

TEST(PosesAhead, WaitUntilTheEstimateHasReachedThem) {
  PosesAhead poses(0.06);
  EXPECT_FALSE(poses.keep(pose(1'000'000'000), 1'000'000'000)) << "is not ahead";
  EXPECT_TRUE(poses.keep(pose(1'010'000'000), 1'000'000'000));
  EXPECT_TRUE(poses.keep(pose(1'020'000'000), 1'000'000'000));
  EXPECT_FALSE(poses.take(1'008'000'000).has_value());
  EXPECT_EQ(poses.take(1'030'000'000)->stamp_ns, 1'010'000'000);
  EXPECT_EQ(poses.take(1'030'000'000)->stamp_ns, 1'020'000'000);
  EXPECT_FALSE(poses.take(2'000'000'000).has_value());
}

TEST(PosesAhead, PosesFarAheadDoNotWait) {
  PosesAhead poses(0.06);
  EXPECT_TRUE(poses.keep(pose(1'060'000'000), 1'000'000'000));
  EXPECT_FALSE(poses.keep(pose(1'060'000'001), 1'000'000'000));
}

TEST(PosesAhead, OnlySoManyWait) {
  PosesAhead poses(0.06);
  for (std::int64_t i = 1; i <= 64; ++i) EXPECT_TRUE(poses.keep(pose(i), 0));
  EXPECT_FALSE(poses.keep(pose(65), 0));
  poses.clear();
  EXPECT_FALSE(poses.take(100).has_value());
}

}  // namespace swiftlet::control::poses_ahead_test
