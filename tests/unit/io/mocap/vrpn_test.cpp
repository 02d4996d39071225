#include "swiftlet/io/mocap/vrpn.hpp"

#include <cstring>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::mocap::vrpn::vrpn_test {

Bytes pose_payload(double x, double qw, std::int32_t sensor = 3) {
  Bytes out;
  const auto put = [&](auto number) {
    std::uint8_t bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out.insert(out.end(), std::make_reverse_iterator(bytes + sizeof number),
               std::make_reverse_iterator(bytes));
  };
  put(sensor);
  put(std::int32_t{0});
  for (const double number : {x, 2.0, 3.0, 0.0, 0.6, 0.0, qw}) put(number);
  return out;
}

Pose read_pose(const Bytes& payload, const char** fault) {
  Pose pose;
  *fault = parse_pose({payload.data(), payload.size(), false}, pose);
  return pose;
}

// The bytes are those of the documents of VRPN, big-endian.
TEST(VrpnMessage, IsLaidOutAsDocumented) {
  const Bytes bytes = message(5'000'007'000, 2, 7, {0xaa});
  const Bytes expected = {0, 0, 0, 25, 0, 0, 0, 5, 0,    0, 0, 7, 0, 0, 0, 2,
                          0, 0, 0, 7,  0, 0, 0, 0, 0xaa, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(bytes, expected);
  Message read;
  ASSERT_EQ(parse_message(bytes.data(), bytes.size(), read), Parsed::kMessage);
  EXPECT_EQ(read.stamp_ns, 5'000'007'000);
  EXPECT_EQ(read.sender, 2);
  EXPECT_EQ(read.type, 7);
  EXPECT_EQ(read.payload.rest(), 1U);
  EXPECT_EQ(read.bytes, 32U);
}

TEST(VrpnMessage, IsIncompleteUntilItsLastByte) {
  const Bytes bytes = description(kSenderDescription, 4, "Tracker0");
  Message read;
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(parse_message(bytes.data(), size, read), Parsed::kIncomplete) << size;
  ASSERT_EQ(parse_message(bytes.data(), bytes.size(), read), Parsed::kMessage);
  EXPECT_EQ(read.sender, 4);
  EXPECT_EQ(parse_description(read.payload), "Tracker0");
}

TEST(VrpnMessage, OfImpossibleLengthIsAFault) {
  for (const std::uint8_t high : {std::uint8_t{0}, std::uint8_t{0x7f}}) {
    Bytes bytes = message(0, 0, 0, {});
    bytes[0] = high;
    bytes[3] = 23;
    Message read;
    EXPECT_EQ(parse_message(bytes.data(), bytes.size(), read), Parsed::kFault);
  }
}

TEST(VrpnCookie, IsThatOfVersionSeven) {
  EXPECT_EQ(fault_of_cookie(cookie().data()), nullptr);
  std::string other = "vrpn: ver. 07.38  0     ";
  const auto fault = [&] { return fault_of_cookie(reinterpret_cast<const std::uint8_t*>(other.data())); };
  EXPECT_EQ(fault(), nullptr) << "the minor version does not matter";
  other = "vrpn: ver. 08.00  0     ";
  EXPECT_STREQ(fault(), "it has another version of VRPN than 7");
  other = "HTTP/1.1 400 Bad Request";
  EXPECT_STREQ(fault(), "it does not speak VRPN");
}

TEST(VrpnDescription, WithoutANameIsRefused) {
  const Bytes empty = {0, 0, 0, 0};
  const Bytes longer_than_it_is = {0, 0, 0, 9, 'a', 0};
  for (const Bytes& payload : {empty, longer_than_it_is, Bytes{}})
    EXPECT_EQ(parse_description({payload.data(), payload.size(), false}), std::nullopt);
}

TEST(VrpnPose, IsRead) {
  const char* fault = nullptr;
  const Pose pose = read_pose(pose_payload(1.0, 0.8), &fault);
  ASSERT_EQ(fault, nullptr);
  EXPECT_EQ(pose.sensor, 3);
  EXPECT_EQ(pose.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pose.q_room_from_body.w(), 0.8);
  EXPECT_EQ(pose.q_room_from_body.y(), 0.6);
}

TEST(VrpnPose, ThatIsNoneIsRefused) {
  const char* fault = nullptr;
  read_pose(pose_payload(std::numeric_limits<double>::infinity(), 0.8), &fault);
  EXPECT_STREQ(fault, "a pose has a number that is not finite");
  read_pose(pose_payload(1.0, 0.9), &fault);
  EXPECT_STREQ(fault, "a quaternion is not of unit length");
  Bytes cut = pose_payload(1.0, 0.8);
  cut.pop_back();
  read_pose(cut, &fault);
  EXPECT_STREQ(fault, "a pose is shorter than 64 bytes");
}

}  // namespace swiftlet::mocap::vrpn::vrpn_test
