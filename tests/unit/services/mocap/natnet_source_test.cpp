// A client of scripted NatNet servers, over real sockets.
#include "swiftlet/services/mocap/sources/natnet_source.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/mocap/natnet_server.hpp"

namespace swiftlet::mocap::natnet_source_test {

using namespace std::chrono_literals;
using tests::eventually;
using tests::NatNetServer;
namespace packets = tests::natnet;

const std::vector<packets::Body> kModels = {{"kl1", 1}, {"kl2", 2}};
constexpr std::int64_t kHourNs = 3'600'000'000'000;

Room room_of(const NatNetServer& server) {
  Room room;
  room.server = server.name();
  room.interface = "127.0.0.1";
  return room;
}

packets::Frame frame_of(std::int32_t number, std::vector<packets::Body> bodies = kModels) {
  packets::Frame frame;
  frame.number = number;
  frame.bodies = std::move(bodies);
  return frame;
}

NatNetServer::Settings settings_of(packets::Version version, bool multicast = false) {
  NatNetServer::Settings settings;
  settings.server.version = version;
  settings.server.multicast = multicast;
  settings.clock_offset_ns = kHourNs;
  return settings;
}

// A server with two bodies and its client.
class NatNet : public testing::Test {
 protected:
  void start(const NatNetServer::Settings& settings) {
    server_.reset();
    server_ = std::make_unique<NatNetServer>(settings);
    server_->set_models(kModels);
  }
  void connect() {
    source_ = std::make_unique<NatNetSource>(room_of(*server_));
    ASSERT_TRUE(eventually([&] {
      source_->receive(frame_, 10ms);
      return source_->bodies().size() == 2 &&
             (source_->session().clock().is_known() || server_->echoes() > 150);
    })) << source_->description();
  }
  // Sends this frame, and receives for a short time. Returns whether it arrived.
  bool pass(const packets::Frame& frame, std::int64_t latency_ns = NatNetServer::kLatencyNs) {
    EXPECT_TRUE(server_->send(frame, latency_ns));
    return source_->receive(frame_, 200ms);
  }
  // Sends frames until one arrives that meets the predicate.
  template <class Predicate>
  bool pass_until(std::int32_t& number, const Predicate& predicate,
                  std::vector<packets::Body> bodies = kModels) {
    return eventually([&] {
      server_->send(frame_of(++number, bodies));
      return source_->receive(frame_, 20ms) && predicate();
    });
  }

  std::unique_ptr<NatNetServer> server_;
  std::unique_ptr<NatNetSource> source_;
  SourceFrame frame_;
};

TEST_F(NatNet, FramesArriveInEveryLayout) {
  for (const packets::Version version : {packets::Version{3, 0}, {3, 1}, {4, 0}, {4, 1}}) {
    SCOPED_TRACE(version.to_string());
    start(settings_of(version));
    ASSERT_NO_FATAL_FAILURE(connect());
    EXPECT_EQ(to_string(source_->bodies()), "kl1 (1), kl2 (2)");
    EXPECT_NE(source_->description().find("Motive 3.1 (NatNet " + version.to_string() + ") at 127.0.0.1"),
              std::string::npos);
    packets::Frame sent = frame_of(1);
    sent.bodies[1].position[0] = 1.5F;
    sent.bodies[1].lost_markers = 2;
    sent.bodies[0].tracked = false;
    ASSERT_TRUE(pass(sent));
    ASSERT_EQ(frame_.poses.size(), 2U);
    EXPECT_FALSE(frame_.poses[0].tracked);
    EXPECT_TRUE(frame_.poses[1].tracked);
    EXPECT_EQ(frame_.poses[1].body, 1U);
    EXPECT_EQ(frame_.poses[1].position.x(), 1.5);
    EXPECT_EQ(frame_.poses[1].markers, 4);
    EXPECT_EQ(frame_.poses[1].lost_markers, 2);
  }
}

TEST_F(NatNet, FramesArriveByMulticast) {
  NatNetServer::Settings settings = settings_of({4, 1}, true);
  settings.server.data_port = static_cast<std::uint16_t>(20'000 + ::getpid() % 20'000);
  start(settings);
  ASSERT_NO_FATAL_FAILURE(connect());
  EXPECT_TRUE(pass(frame_of(1)));
  EXPECT_EQ(source_->description().find("unicast"), std::string::npos);
}

// GIVEN a server whose clock is an hour ahead THEN the exposure is known by this host's clock, from the middle of the
// exposure on.
TEST_F(NatNet, StampsAreTranslatedFromTheServersClock) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  const std::int64_t before_ns = runtime::monotonic_ns();
  ASSERT_TRUE(pass(frame_of(1), 8'000'000));
  ASSERT_TRUE(frame_.exposed_ns);
  EXPECT_GT(*frame_.exposed_ns, before_ns - 10'000'000);
  EXPECT_LT(*frame_.exposed_ns, frame_.arrived_ns - 6'000'000);
}

// GIVEN a server that does not answer echo requests THEN its own statement of the latency is what is subtracted.
TEST_F(NatNet, StampsAreThoseOfTheArrivalIfTheClockStaysUnknown) {
  NatNetServer::Settings settings = settings_of({4, 1});
  settings.answers_echo = false;
  start(settings);
  ASSERT_NO_FATAL_FAILURE(connect());
  ASSERT_TRUE(pass(frame_of(1), 8'000'000));
  ASSERT_TRUE(frame_.exposed_ns);
  EXPECT_NEAR(static_cast<double>(frame_.arrived_ns - *frame_.exposed_ns), 8e6, 1e3);
}

TEST_F(NatNet, FramesThatAreLostOrOvertakenAreCounted) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  EXPECT_TRUE(pass(frame_of(10)));
  EXPECT_TRUE(pass(frame_of(14)));
  EXPECT_FALSE(pass(frame_of(12))) << "it was overtaken";
  EXPECT_FALSE(pass(frame_of(14))) << "it came twice";
  EXPECT_TRUE(pass(frame_of(15)));
  EXPECT_EQ(source_->statistics().lost, 3U);
  EXPECT_EQ(source_->statistics().late, 2U);
  EXPECT_EQ(source_->statistics().frames, 3U);
}

TEST_F(NatNet, ModelsThatChangeAreAskedFor) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  const std::uint64_t revision = source_->revision();
  const std::vector<packets::Body> three = {{"kl2", 2}, {"kl3", 3}, {"kl1", 1}};
  server_->set_models(three);
  packets::Frame changed = frame_of(1, three);
  changed.models_changed = true;
  EXPECT_TRUE(pass(changed));
  std::int32_t number = 1;
  ASSERT_TRUE(pass_until(
      number, [&] { return frame_.poses.size() == 3; }, three));
  EXPECT_EQ(to_string(source_->bodies()), "kl2 (2), kl3 (3), kl1 (1)");
  EXPECT_NE(source_->revision(), revision);
  VehicleBody vehicle;
  vehicle.body = "kl1";
  EXPECT_EQ(find_body(source_->bodies(), vehicle), 2U);
}

// GIVEN a body that nobody defined and no flag THEN the definitions are asked for all the same.
TEST_F(NatNet, ModelsOfAnUnknownBodyAreAskedFor) {
  start(settings_of({3, 0}));
  ASSERT_NO_FATAL_FAILURE(connect());
  const std::vector<packets::Body> other = {{"kl9", 9}};
  server_->set_models(other);
  std::int32_t number = 0;
  ASSERT_TRUE(pass_until(
      number, [&] { return frame_.poses.size() == 1; }, other));
  EXPECT_EQ(to_string(source_->bodies()), "kl9 (9)");
}

// GIVEN a server that is restarted, with another clock and a new count THEN frames arrive again with right stamps.
TEST_F(NatNet, ServerThatIsRestartedIsMetAgain) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  EXPECT_TRUE(pass(frame_of(5000)));
  NatNetServer::Settings settings = settings_of({4, 1});
  settings.port = server_->port();
  settings.clock_offset_ns = 5 * kHourNs;
  start(settings);
  std::int32_t number = 4990;  // within what otherwise were late
  ASSERT_TRUE(pass_until(number, [&] {
    return frame_.exposed_ns && std::abs(*frame_.exposed_ns - frame_.arrived_ns) < 100'000'000;
  })) << source_->description();
  EXPECT_GE(source_->statistics().restarts, 1U);
}

// GIVEN a server whose clock was set THEN no frame is stamped by what was known of it before, and the new clock is learnt.
TEST_F(NatNet, StampsOfAClockThatWasSetAreWithheld) {
  for (const std::int64_t offset_ns : {5 * kHourNs, kHourNs / 2}) {
    start(settings_of({4, 1}));
    ASSERT_NO_FATAL_FAILURE(connect());
    server_->set_clock(offset_ns);
    ASSERT_TRUE(pass(frame_of(1)));
    EXPECT_FALSE(frame_.exposed_ns);
    std::int32_t number = 1;
    ASSERT_TRUE(pass_until(number, [&] { return frame_.exposed_ns.has_value(); }));
    EXPECT_LT(std::abs(*frame_.exposed_ns - frame_.arrived_ns), 100'000'000);
  }
}

TEST_F(NatNet, FramesWithoutAnExposureAreStampedByTheirArrival) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  ASSERT_TRUE(pass(frame_of(1), 0));
  EXPECT_EQ(frame_.exposed_ns, frame_.arrived_ns);
}

TEST_F(NatNet, ServerThatStartsLaterIsMet) {
  start(settings_of({4, 1}));
  const Room room = room_of(*server_);
  const std::uint16_t port = server_->port();
  server_.reset();
  source_ = std::make_unique<NatNetSource>(room);
  EXPECT_FALSE(source_->receive(frame_, 50ms));
  EXPECT_NE(source_->description().find("does not answer"), std::string::npos);
  NatNetServer::Settings settings = settings_of({4, 1});
  settings.port = port;
  start(settings);
  std::int32_t number = 0;
  EXPECT_TRUE(pass_until(number, [&] { return frame_.poses.size() == 2; }));
}

// A server on another address sends to the same client.
TEST_F(NatNet, FramesOfAnotherServerAreLeftOut) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  EXPECT_TRUE(pass(frame_of(1)));
  const io::UdpSocket stranger("127.0.0.2", 0);
  const auto bytes = packets::frame({4, 1}, frame_of(2));
  ASSERT_TRUE(stranger.send(bytes, io::resolve("127.0.0.1:" + std::to_string(source_->command_port()), 1)));
  EXPECT_FALSE(source_->receive(frame_, 100ms));
  EXPECT_EQ(source_->statistics().strangers, 1U);
}

TEST_F(NatNet, DatagramsThatCannotBeReadAreCounted) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  const io::UdpSocket socket("127.0.0.1", 0);
  ASSERT_TRUE(
      socket.send({7, 0, 99, 0, 1}, io::resolve("127.0.0.1:" + std::to_string(source_->command_port()), 1)));
  EXPECT_FALSE(source_->receive(frame_, 100ms));
  EXPECT_EQ(source_->statistics().refused, 1U);
  EXPECT_EQ(source_->statistics().last_refusal, "a datagram is none of NatNet, or cut");
  EXPECT_TRUE(pass(frame_of(1)));
}

TEST_F(NatNet, VersionThatIsNotSupportedIsNamed) {
  start(settings_of({5, 0}));
  source_ = std::make_unique<NatNetSource>(room_of(*server_));
  std::string sentence;
  ASSERT_TRUE(eventually([&] {
    try {
      source_->receive(frame_, 20ms);
      return false;
    } catch (const std::runtime_error& error) {
      sentence = error.what();
      return true;
    }
  }));
  EXPECT_NE(sentence.find("NatNet 5.0 is not supported, 3.0 to 4.x are"), std::string::npos) << sentence;
}

TEST_F(NatNet, UnicastIsKeptAlive) {
  start(settings_of({4, 1}));
  ASSERT_NO_FATAL_FAILURE(connect());
  EXPECT_GE(server_->keep_alives(), 1U);
}

TEST(NatNetDiscovery, NamesSeveralServersAndTakesTheOnlyOne) {
  NatNetServer::Settings settings;
  const NatNetServer one(settings);
  settings.address = "127.0.0.2";
  const NatNetServer two(settings);
  const std::vector<io::Endpoint> both = {io::resolve(one.name(), 1), io::resolve(two.name(), 1)};
  std::vector<FoundServer> found;
  ASSERT_TRUE(eventually([&] {
    found = find_natnet_servers(both, "", 100ms);
    return found.size() == 2;
  }));
  try {
    only_server(found);
    FAIL() << "two servers must be refused";
  } catch (const std::runtime_error& error) {
    const std::string sentence = error.what();
    EXPECT_NE(sentence.find("2 NatNet servers answer: Motive 3.1 (NatNet 4.1) at 127.0.0."),
              std::string::npos);
    EXPECT_NE(sentence.find("choose one with --server"), std::string::npos);
  }
  found.pop_back();
  EXPECT_EQ(only_server(found).at.address, found.front().at.address);
  EXPECT_THROW(only_server({}), std::runtime_error);
}

}  // namespace swiftlet::mocap::natnet_source_test
