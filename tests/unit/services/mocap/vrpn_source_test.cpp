// A client of scripted VRPN servers, over real sockets.
#include "swiftlet/services/mocap/sources/vrpn_source.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/mocap/sources/source_options.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/mocap/vrpn_server.hpp"

namespace swiftlet::mocap::vrpn_source_test {

using namespace std::chrono_literals;
using tests::eventually;
using tests::VrpnServer;

constexpr double kPose[7] = {1.0, 2.0, 3.0, 0.0, 0.6, 0.0, 0.8};
constexpr std::int64_t kHourNs = 3'600'000'000'000;

class Vrpn : public testing::Test {
 protected:
  void start(const VrpnServer::Settings& settings) {
    server_.reset();
    server_ = std::make_unique<VrpnServer>(settings);
  }
  void connect() {
    Room room;
    room.source = SourceKind::kVrpn;
    room.server = server_->name();
    source_ = std::make_unique<VrpnSource>(room);
  }
  // Sends poses of a tracker until one arrives that meets the predicate.
  template <class Predicate>
  bool pass_until(std::size_t tracker, const Predicate& predicate, std::int64_t age_ns = 0) {
    return eventually([&] {
      server_->send(tracker, kPose, age_ns);
      return source_->receive(frame_, 10ms) && predicate();
    });
  }
  bool is_stamped() const {
    return frame_.exposed_ns && std::abs(*frame_.exposed_ns - frame_.arrived_ns) < 100'000'000;
  }

  std::unique_ptr<VrpnServer> server_;
  std::unique_ptr<VrpnSource> source_;
  SourceFrame frame_;
};

TEST_F(Vrpn, PosesOfSeveralTrackersArrive) {
  for (const bool by_udp : {true, false}) {
    SCOPED_TRACE(by_udp ? "udp" : "tcp");
    VrpnServer::Settings settings;
    settings.by_udp = by_udp;
    start(settings);
    connect();
    ASSERT_TRUE(pass_until(0, [] { return true; })) << source_->description();
    ASSERT_TRUE(pass_until(1, [&] { return source_->bodies().at(frame_.poses.at(0).body).name == "kl2"; }));
    EXPECT_EQ(to_string(source_->bodies()), "kl1 (0), kl2 (0)");
    EXPECT_FALSE(frame_.is_complete);
    EXPECT_EQ(frame_.poses[0].position, Eigen::Vector3d(1, 2, 3));
    EXPECT_NEAR(frame_.poses[0].q_room_from_body.y(), 0.6, 1e-12);
  }
}

// GIVEN a server whose clock is an hour ahead THEN stamps are translated by what it answers to pings.
TEST_F(Vrpn, StampsAreTranslatedFromTheServersClock) {
  VrpnServer::Settings settings;
  settings.clock_offset_ns = kHourNs;
  start(settings);
  connect();
  ASSERT_TRUE(pass_until(
      0, [&] { return is_stamped() && *frame_.exposed_ns < frame_.arrived_ns - 15'000'000; }, 20'000'000));
}

TEST_F(Vrpn, StampsAreThoseOfTheArrivalIfPingsAreNotAnswered) {
  VrpnServer::Settings settings;
  settings.answers_pings = false;
  settings.clock_offset_ns = kHourNs;
  start(settings);
  connect();
  ASSERT_TRUE(pass_until(0, [&] { return frame_.exposed_ns.has_value(); }));
  EXPECT_EQ(*frame_.exposed_ns, frame_.arrived_ns);
}

// GIVEN a server that sees no body yet THEN pings keep the connection: it would be taken for dead otherwise.
TEST_F(Vrpn, ServerWithoutPosesIsPinged) {
  start({});
  connect();
  EXPECT_TRUE(eventually([&] {
    source_->receive(frame_, 10ms);
    return server_->pings() >= 3;
  })) << source_->description();
}

// GIVEN poses that come in one burst THEN each arrives, in their order.
TEST_F(Vrpn, PosesOfABurstArriveOneByOne) {
  VrpnServer::Settings settings;
  settings.by_udp = false;
  start(settings);
  connect();
  ASSERT_TRUE(pass_until(0, [] { return true; }));
  while (source_->receive(frame_, 20ms)) {
  }
  constexpr int kBurst = 800;  // more than one read of the socket
  for (int i = 0; i < kBurst; ++i) ASSERT_TRUE(server_->send(0, kPose));
  int arrived = 0;
  EXPECT_TRUE(eventually([&] {
    arrived += source_->receive(frame_, 10ms) ? 1 : 0;
    return arrived + static_cast<int>(source_->statistics().late) >= kBurst;
  })) << arrived;
}

TEST_F(Vrpn, PosesThatWereOvertakenAreLeftOut) {
  start({});
  connect();
  ASSERT_TRUE(pass_until(0, [&] { return is_stamped(); }));
  ASSERT_TRUE(server_->send(0, kPose, 500'000'000));
  EXPECT_FALSE(source_->receive(frame_, 100ms));
  EXPECT_EQ(source_->statistics().late, 1U);
}

TEST_F(Vrpn, ServerThatIsRestartedIsMetAgain) {
  start({});
  connect();
  ASSERT_TRUE(pass_until(0, [&] { return is_stamped(); }));
  VrpnServer::Settings settings;
  settings.port = server_->port();
  settings.clock_offset_ns = -kHourNs;
  settings.trackers = {"other", "kl1"};
  start(settings);
  ASSERT_TRUE(pass_until(1, [&] { return is_stamped(); })) << source_->description();
  EXPECT_EQ(source_->bodies().at(frame_.poses.at(0).body).name, "kl1");
  EXPECT_EQ(source_->statistics().restarts, 1U);
}

TEST_F(Vrpn, ConnectionThatIsLostIsMadeAgain) {
  start({});
  connect();
  ASSERT_TRUE(pass_until(0, [] { return true; }));
  server_->drop();
  ASSERT_TRUE(pass_until(0, [&] { return source_->statistics().restarts == 1; })) << source_->description();
}

// GIVEN a vehicle without the number of a sensor THEN it is sensor 0, also if another came first.
TEST_F(Vrpn, VehicleIsTheFirstSensorOfItsTracker) {
  SourceOptions options;
  options.source = "vrpn";
  options.server = "127.0.0.1";
  const VehicleBody vehicle = room_of(options, {"kl1"}).vehicles.at(0);
  EXPECT_EQ(find_body({{"kl1", 1}, {"kl1", 0}}, vehicle), 1U);
  EXPECT_EQ(find_body({{"kl1", 1}}, vehicle), std::nullopt);
}

TEST_F(Vrpn, AnotherVersionIsNamed) {
  VrpnServer::Settings settings;
  settings.cookie = "vrpn: ver. 08.00  0     ";
  start(settings);
  connect();
  EXPECT_TRUE(eventually([&] {
    source_->receive(frame_, 10ms);
    return source_->description().find("it has another version of VRPN than 7") != std::string::npos;
  }));
}

TEST_F(Vrpn, ServerThatIsNotThereIsNamed) {
  start({});
  connect();
  server_.reset();
  EXPECT_TRUE(eventually([&] {
    source_->receive(frame_, 10ms);
    return source_->description().find("refuses the connection") != std::string::npos;
  }));
}

}  // namespace swiftlet::mocap::vrpn_source_test
