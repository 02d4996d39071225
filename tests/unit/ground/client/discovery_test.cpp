#include "swiftlet/ground/client/discovery.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::discovery_test {

using Words = std::vector<std::string>;

TEST(VehicleDiscovery, FindsVehiclesThatPublish) {
  const Words topics = {"rt/kl1/imu",     "rt/kl1/mocap_pose", "rt/kl2/command", "rt/kl2/setpoint",
                        "rt/kl3/battery", "rt/rosout",         "rt/a/b/c",       "rq/kl4/imu",
                        "DCPSTopic",      "rt/kl3/command"};
  EXPECT_EQ(vehicles_of(topics), Words({"kl1", "kl3"}));
  EXPECT_EQ(topics_of("kl3", topics), Words({"battery", "command"}));
  EXPECT_EQ(topics_of("kl9", topics), Words());
  EXPECT_EQ(listed(topics_of("kl1", topics)), "imu, mocap_pose");
  EXPECT_EQ(listed({}), "");
}

}  // namespace swiftlet::ground::discovery_test
