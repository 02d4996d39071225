#include "swiftlet/io/mocap/vicon.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/mocap/vicon_packets.hpp"

namespace swiftlet::mocap::vicon::vicon_test {

using tests::vicon_frame;
using tests::ViconObject;

const ViconObject kOne{"kl1", {1000.0, -2000.0, 1500.0, 0.1, 0.2, 0.3}};

TEST(ViconFrame, IsReadFromEveryBlock) {
  for (const std::size_t block : {256, 512, 1024}) {
    std::vector<ViconObject> objects(block / kObjectBytes, kOne);
    objects.back().name = "a name of 24 characters.";
    const auto bytes = vicon_frame(77, objects, block);
    Frame frame;
    ASSERT_EQ(parse_frame(bytes.data(), bytes.size(), frame), nullptr) << block;
    EXPECT_EQ(frame.number, 77U);
    ASSERT_EQ(frame.objects.size(), objects.size());
    EXPECT_EQ(frame.objects[0].name, "kl1");
    EXPECT_EQ(frame.objects.back().name, "a name of 24 characters.");
    EXPECT_TRUE(frame.objects[0].tracked);
    EXPECT_TRUE(frame.objects[0].position.isApprox(Eigen::Vector3d(1, -2, 1.5)));
  }
}

// A small turn about each axis is the same in any order; a large one shows the order.
TEST(ViconFrame, TurnsAboutXThenTheTurnedYThenTheTwiceTurnedZ) {
  constexpr double kQuarter = 1.5707963267948966;
  const Eigen::Vector3d forward = attitude_of(kQuarter, 0.0, kQuarter) * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(forward.isApprox(Eigen::Vector3d::UnitZ())) << "first z by the body, which lies on its side";
  EXPECT_TRUE(
      (attitude_of(0.0, kQuarter, 0.0) * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(ViconFrame, HasObjectsThatAreNotTracked) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto bytes = vicon_frame(1, {{"zero", {}}, {"infinite", {infinite, 0, 0, 0, 0, 0}}, kOne}, 256);
  Frame frame;
  ASSERT_EQ(parse_frame(bytes.data(), bytes.size(), frame), nullptr);
  EXPECT_FALSE(frame.objects[0].tracked);
  EXPECT_FALSE(frame.objects[1].tracked);
  EXPECT_TRUE(frame.objects[2].tracked);
}

TEST(ViconFrame, ThatIsCutOrAnotherIsRefused) {
  Frame frame;
  for (std::size_t size = 0; size < 5 + kObjectBytes; ++size) {
    const auto bytes = vicon_frame(1, {kOne}, size);
    EXPECT_NE(parse_frame(bytes.data(), bytes.size(), frame), nullptr) << size;
  }
  auto bytes = vicon_frame(1, {kOne}, 256);
  bytes[6] = 71;
  EXPECT_STREQ(parse_frame(bytes.data(), bytes.size(), frame), "an object is not 72 bytes long");
  bytes = vicon_frame(1, {{"", {1, 0, 0, 0, 0, 0}}}, 256);
  EXPECT_STREQ(parse_frame(bytes.data(), bytes.size(), frame), "an object has no name");
}

}  // namespace swiftlet::mocap::vicon::vicon_test
