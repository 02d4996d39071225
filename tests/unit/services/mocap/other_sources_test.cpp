// Vicon's object stream and recordings, and the options that choose a source.
#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/mocap/sources/replay_source.hpp"
#include "swiftlet/services/mocap/sources/source_options.hpp"
#include "swiftlet/services/mocap/sources/vicon_source.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/mocap/natnet_packets.hpp"
#include "tests/support/mocap/vicon_packets.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::mocap::other_sources_test {

using namespace std::chrono_literals;
using tests::vicon_frame;

const std::string kData = tests::in_source("tests/data/");

std::uint16_t free_port() { return io::UdpSocket("127.0.0.1", 0).port(); }

class Vicon : public testing::Test {
 protected:
  void open(const std::string& server) {
    Room room;
    room.source = SourceKind::kVicon;
    room.interface = "127.0.0.1";
    room.server = server;
    room.latency_s = 0.004;
    source_ = std::make_unique<ViconSource>(room);
  }
  bool pass(std::uint32_t number, const std::vector<tests::ViconObject>& objects, const io::UdpSocket& from) {
    const io::Endpoint to = io::resolve("127.0.0.1:" + std::to_string(source_->port()), 1);
    EXPECT_TRUE(from.send(vicon_frame(number, objects, 256), to));
    return source_->receive(frame_, 100ms);
  }

  const tests::ViconObject one_{"kl1", {1000, 0, 0, 0, 0, 0.5}};
  const io::UdpSocket sender_{"127.0.0.1", 0};
  std::unique_ptr<ViconSource> source_;
  SourceFrame frame_;
};

TEST_F(Vicon, FramesAreStampedByTheirArrival) {
  open("127.0.0.1:" + std::to_string(free_port()));
  ASSERT_TRUE(pass(1, {one_, {"kl2", {}}}, sender_));
  EXPECT_EQ(to_string(source_->bodies()), "kl1 (0), kl2 (0)");
  EXPECT_TRUE(frame_.poses[0].tracked);
  EXPECT_FALSE(frame_.poses[1].tracked);
  EXPECT_EQ(frame_.arrived_ns - *frame_.exposed_ns, 4'000'000);
}

TEST_F(Vicon, FramesThatAreLostOrOvertakenAreCounted) {
  open("127.0.0.1:" + std::to_string(free_port()));
  EXPECT_TRUE(pass(10, {one_}, sender_));
  EXPECT_TRUE(pass(13, {one_}, sender_));
  EXPECT_FALSE(pass(12, {one_}, sender_));
  EXPECT_TRUE(pass(2'000'000, {one_}, sender_));
  EXPECT_TRUE(pass(1, {one_}, sender_)) << "the server was restarted";
  EXPECT_EQ(source_->statistics().late, 1U);
}

TEST_F(Vicon, FramesOfAnotherServerAreLeftOut) {
  open("127.0.0.1:" + std::to_string(free_port()));
  const io::UdpSocket stranger("127.0.0.2", 0);
  EXPECT_TRUE(pass(1, {one_}, sender_));
  EXPECT_FALSE(pass(2, {one_}, stranger));
  EXPECT_EQ(source_->statistics().strangers, 1U);
}

Room replay_of(const std::string& file) {
  Room room;
  room.source = SourceKind::kReplay;
  room.file = file;
  return room;
}

// The capture has 518 frames of one body, 120 per second, with a latency of the system of some 5.5 ms.
TEST(Replay, PlaysTheTrafficOfMotive) {
  ReplaySource source(replay_of(kData + "natnet_3.0_traffic.pcapng"));
  ASSERT_EQ(source.bodies().size(), 1U);
  EXPECT_EQ(source.bodies()[0].id, 2);
  SourceFrame frame;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(source.receive(frame, 500ms)) << i;
    ASSERT_EQ(frame.poses.size(), 1U);
    EXPECT_TRUE(frame.poses[0].tracked);
    EXPECT_NEAR(1e-6 * static_cast<double>(frame.arrived_ns - *frame.exposed_ns), 5.5, 2.0);
  }
  EXPECT_FALSE(source.has_ended());
}

TEST(Replay, PlaysATableToItsEnd) {
  const tests::TemporaryFolder folder;
  const std::string file = (folder.path() / "drone.csv").string();
  std::ofstream(file) << "t,x,y,z,qx,qy,qz,qw\n100,1,2,3,0,0,0,1\n100.02,1,2,4,0,0,0,1\n";
  ReplaySource source(replay_of(file));
  EXPECT_EQ(to_string(source.bodies()), "drone (0)");
  SourceFrame first;
  SourceFrame second;
  ASSERT_TRUE(source.receive(first, 500ms));
  ASSERT_TRUE(source.receive(second, 500ms));
  EXPECT_EQ(second.poses[0].position.z(), 4.0);
  EXPECT_NEAR(1e-6 * static_cast<double>(*second.exposed_ns - *first.exposed_ns), 20.0, 0.01);
  EXPECT_TRUE(source.has_ended());
  EXPECT_FALSE(source.receive(first, 1ms));
}

TEST(Replay, PlaysATableOfASpreadsheet) {
  const tests::TemporaryFolder folder;
  const std::string file = (folder.path() / "drone.csv").string();
  std::ofstream(file) << "\xef\xbb\xbf\"t\";x;y;z;qx;qy;qz;qw\r\n0;1;2;3,5;0;0;0;1\r\n";
  ReplaySource source(replay_of(file));
  SourceFrame frame;
  ASSERT_TRUE(source.receive(frame, 500ms));
  EXPECT_EQ(frame.poses[0].position.z(), 3.5);
}

TEST(Replay, RefusesWhatItCannotPlay) {
  const tests::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const std::string file = (folder.path() / "f").string();
    std::ofstream(file) << text;
    try {
      ReplaySource source(replay_of(file));
    } catch (const io::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("played");
  };
  EXPECT_NE(refusal("t,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n1,1,2,3,0,0,0,1\n").find("must increase"),
            std::string::npos);
  EXPECT_NE(refusal("t,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,2\n").find("unit length"), std::string::npos);
  EXPECT_NE(refusal("hello").find("is no capture"), std::string::npos);
}

TEST(SourceOptions, ReplaceWhatTheRoomSays) {
  const tests::TemporaryFolder folder;
  const std::string file = (folder.path() / "lab.yaml").string();
  std::ofstream(file) << "source: natnet\nserver: 10.0.0.1\nframe: zup\nvehicles:\n  kl1: {id: 4}\n";
  SourceOptions options;
  options.room = file;
  EXPECT_EQ(room_of(options, {"kl1"}).server, "10.0.0.1");
  EXPECT_THROW(room_of(options, {"kl1", "kl2"}), io::ConfigError);
  options.source = "vrpn";
  EXPECT_THROW(room_of(options, {"kl1"}), std::invalid_argument) << "the server is that of NatNet";
  options.server = "10.0.0.2";
  options.frame = "yup";
  const Room room = room_of(options, {"kl1"});
  EXPECT_EQ(room.source, SourceKind::kVrpn);
  EXPECT_EQ(room.axes, Axes::kYUp);
  EXPECT_EQ(find(room, "kl1")->id, 4);
}

TEST(SourceOptions, WithoutARoomTakeTheBodiesOfTheNamesOfTheVehicles) {
  SourceOptions options;
  EXPECT_THROW(room_of(options, {"kl1"}), std::invalid_argument);
  options.source = "natnet";
  EXPECT_EQ(find(room_of(options, {"kl1", "kl2"}), "kl2")->body, "kl2");
  options.file = "f.pcap";
  EXPECT_THROW(room_of(options, {"kl1"}), std::invalid_argument);
}

}  // namespace swiftlet::mocap::other_sources_test
