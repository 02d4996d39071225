// The host's end of the link against the simulated firmware, over a pseudo-terminal, in one thread. The microcontroller's clock is
// the test's.
#include "swiftlet/services/vehicle_template/microcontroller_link.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/microcontroller/firmware.hpp"
#include "swiftlet/services/microcontroller/port.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::services::microcontroller_link_test {

using protocol::message_of;

constexpr std::int64_t kOffsetNs = 3'000'000'000'000;

class MicrocontrollerLinkTest : public testing::Test {
 protected:
  void plug_in(FirmwareSettings settings = {}) {
    port_ = open_pseudo_terminal(path_);
    firmware_ = std::make_unique<Firmware>(
        settings, [this](const std::uint8_t* bytes, std::size_t size) { port_->write(bytes, size); });
  }
  void unplug() { port_.reset(); }
  static std::int64_t firmware_us() { return (runtime::monotonic_ns() + kOffsetNs) / 1000; }

  // Runs both ends once. Returns whether an IMU sample has arrived.
  bool turn() {
    link_.wake();
    link_.wait();
    bool sampled = false;
    while (const protocol::Frame* frame = link_.next()) {
      const auto imu = message_of<protocol::Imu>(*frame);
      if (imu) newest_imu_ = *imu;
      sampled = sampled || imu;
    }
    if (!port_) return sampled;
    std::uint8_t bytes[256];
    while (const std::size_t count = port_->read(bytes, sizeof bytes))
      firmware_->take(bytes, count, firmware_us());
    firmware_->send(plant::ImuSample{}, firmware_us());
    return sampled;
  }
  bool connected() const { return link_.status().state == LinkState::kConnected; }

  tests::TemporaryFolder folder_;
  const std::string path_ = folder_.path() / "tty";
  std::unique_ptr<Port> port_;
  std::unique_ptr<Firmware> firmware_;
  protocol::Imu newest_imu_;
  MicrocontrollerLink link_{{path_, 921'600, ""}};
};

TEST_F(MicrocontrollerLinkTest, BeginsASessionAndLearnsTheClock) {
  EXPECT_FALSE(turn());
  EXPECT_EQ(link_.status().state, LinkState::kClosed);
  plug_in();
  EXPECT_TRUE(tests::eventually([&] { return turn() && link_.status().clock; }));
  EXPECT_TRUE(connected());
  EXPECT_EQ(std::string(link_.status().microcontroller->name.data()), "swiftlet simulated");
  const std::int64_t now_ns = runtime::monotonic_ns();
  ASSERT_TRUE(link_.clock_ns(now_ns));
  // As exact as the round trip of this process through both ends, which a busy machine may delay.
  const double error_ns = std::abs(static_cast<double>(*link_.clock_ns(now_ns) - now_ns - kOffsetNs));
  EXPECT_LE(error_ns, link_.status().clock->uncertainty_ns(now_ns) + 1000.0);
}

TEST_F(MicrocontrollerLinkTest, SendsCommandsInASessionOnly) {
  protocol::Command command;
  command.rotors_running = 1;
  command.rotor_count = 4;
  link_.send(command);
  plug_in();
  ASSERT_TRUE(tests::eventually([&] { return turn(); }));
  EXPECT_EQ(firmware_->state().commands_obeyed + firmware_->state().commands_refused, 0U);
  EXPECT_TRUE(tests::eventually([&] {
    command.stamp_us =
        newest_imu_
            .stamp_us;  // the firmware refuses what answers an old sample, as one may be on a busy machine
    link_.send(command);
    turn();
    return firmware_->state().commands_obeyed > 0;
  }));
}

TEST_F(MicrocontrollerLinkTest, HealsWhenTheCableIsPluggedAgain) {
  plug_in();
  ASSERT_TRUE(tests::eventually([&] { return turn(); }));
  unplug();
  ASSERT_TRUE(tests::eventually([&] {
    turn();
    return link_.status().state == LinkState::kClosed;
  }));
  EXPECT_TRUE(link_.status().open_fault == ENODEV || link_.status().open_fault == ENOENT)
      << link_.status().open_fault << ": vanished, or looked for again";
  EXPECT_FALSE(link_.clock_ns(runtime::monotonic_ns())) << "unknown without a session";
  FirmwareSettings restarted;
  restarted.boot = 2;
  plug_in(restarted);
  EXPECT_TRUE(tests::eventually([&] { return turn(); }));
  EXPECT_EQ(link_.status().sessions, 2U);
  EXPECT_EQ(link_.status().microcontroller->boot, 2U);
}

TEST_F(MicrocontrollerLinkTest, BeginsAgainWithAMicrocontrollerThatHasRestarted) {
  plug_in();
  ASSERT_TRUE(tests::eventually([&] { return turn(); }));
  FirmwareSettings restarted;
  restarted.boot = 2;
  *firmware_ =
      Firmware(restarted, [this](const std::uint8_t* bytes, std::size_t size) { port_->write(bytes, size); });
  EXPECT_TRUE(tests::eventually([&] { return turn() && link_.status().sessions == 2; }));
}

TEST_F(MicrocontrollerLinkTest, OpensNoSessionWithAnotherVersion) {
  FirmwareSettings other;
  other.version = 2;
  plug_in(other);
  ASSERT_TRUE(tests::eventually([&] {
    turn();
    return link_.status().microcontroller.has_value();
  }));
  EXPECT_EQ(link_.status().microcontroller->version, 2);
  EXPECT_FALSE(connected());
}

TEST_F(MicrocontrollerLinkTest, AllocatesNothing) {
  plug_in();
  ASSERT_TRUE(tests::eventually([&] { return turn() && link_.status().clock; }));
  const test::MallocGuard guard;
  int samples = 0;
  const auto give_up = std::chrono::steady_clock::now() + tests::kStuck;
  for (int i = 0; (i < 200 || samples == 0) && std::chrono::steady_clock::now() < give_up; ++i) {
    if (turn()) ++samples;
    protocol::Command command;
    command.stamp_us = newest_imu_.stamp_us;
    link_.send(command);
  }
  EXPECT_EQ(guard.calls(), 0U);
  EXPECT_GT(samples, 0);
}

}  // namespace swiftlet::services::microcontroller_link_test
