#include "swiftlet/services/px4/versions.hpp"

#include <gtest/gtest.h>

#include "swiftlet/services/px4/px4_topics.hpp"

namespace swiftlet::px4::versions_test {

TEST(Px4Versions, ThatOf116IsKnown) {
  EXPECT_EQ(version_of({"rt/fmu/out/vehicle_status_v1", "rt/fmu/out/battery_status"}, "/fmu").state,
            VersionState::kKnown);
}

TEST(Px4Versions, NothingYetIsNoFault) {
  const Version version = version_of({"rt/kl1/imu", "rt/px4_1/fmu/out/vehicle_status_v1"}, "/fmu");
  EXPECT_EQ(version.state, VersionState::kNoTopics);
  EXPECT_EQ(version.fault, "");
}

TEST(Px4Versions, OthersAreRefusedByName) {
  EXPECT_EQ(version_of({"rt/px4_2/fmu/out/vehicle_status_v4"}, topic_folder(2)).fault,
            "PX4 publishes /px4_2/fmu/out/vehicle_status_v4, but swiftlet-px4 knows vehicle_status_v1, that "
            "of PX4 1.16");
  EXPECT_EQ(
      version_of({"rt/fmu/out/vehicle_status"}, "/fmu").fault,
      "PX4 publishes /fmu/out/vehicle_status, but swiftlet-px4 knows vehicle_status_v1, that of PX4 1.16");
  const Version newer = version_of({"rt/fmu/out/vehicle_status_v1", "rt/fmu/out/battery_status_v1"}, "/fmu");
  EXPECT_EQ(newer.state, VersionState::kUnknown) << "PX4 1.17";
  EXPECT_NE(newer.fault.find("battery_status_v1"), std::string::npos);
}

TEST(Px4Versions, InstancesHaveFoldersOfTheirOwn) {
  EXPECT_EQ(topic_folder(0), "/fmu");
  EXPECT_EQ(topic_folder(3), "/px4_3/fmu");
  EXPECT_EQ(topic_folder(0, "uav_"), "/uav_0/fmu");
}

}  // namespace swiftlet::px4::versions_test
