// What the simulated firmware does at its end of the link; firmware of a real vehicle must do the same.
#include "swiftlet/services/microcontroller/firmware.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/malloc_guard.hpp"

namespace swiftlet::services::firmware_test {

using protocol::message_of;

class FirmwareTest : public testing::Test {
 protected:
  template <class Message>
  void say(const Message& message) {
    const auto frame = host_.encode(message);
    firmware_.take(frame.data, frame.size, now_us_);
  }
  void begin_session() {
    say(protocol::Hello{});
    ASSERT_TRUE(firmware_.in_session(now_us_));
  }
  protocol::Command command(bool running, std::uint16_t throttle = 0x8000) const {
    protocol::Command out;
    out.stamp_us = now_us_;
    out.rotors_running = running ? 1 : 0;
    out.rotor_count = 4;
    out.throttle_u16 = {throttle, throttle, throttle, throttle};
    out.term = 1;
    return out;
  }
  void take(const std::uint8_t* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      if (!decoder_.take(bytes[i])) continue;
      ++frames_;
      if (const auto reply = message_of<protocol::HelloReply>(decoder_.frame())) hello_ = reply;
      if (const auto reply = message_of<protocol::TimeReply>(decoder_.frame())) time_ = reply;
      if (const auto imu = message_of<protocol::Imu>(decoder_.frame())) imu_ = imu;
      if (const auto state = message_of<protocol::State>(decoder_.frame())) state_ = state;
    }
  }
  bool running() { return firmware_.motor_command(now_us_).state == plant::RotorState::kRunning; }
  std::string refusal() const { return firmware_.state().refusal.data(); }

  std::int64_t now_us_ = 5'000'000'000;
  protocol::FrameEncoder host_;
  protocol::FrameDecoder decoder_;
  int frames_ = 0;
  std::optional<protocol::HelloReply> hello_;
  std::optional<protocol::TimeReply> time_;
  std::optional<protocol::Imu> imu_;
  std::optional<protocol::State> state_;
  Firmware firmware_{FirmwareSettings{},
                     [this](const std::uint8_t* bytes, std::size_t size) { take(bytes, size); }};
};

TEST_F(FirmwareTest, IsSilentAndObeysNothingBeforeHello) {
  say(command(true));
  firmware_.send(plant::ImuSample{}, now_us_);
  EXPECT_EQ(frames_, 0);
  EXPECT_FALSE(running());
}

TEST_F(FirmwareTest, AnswersHelloWithWhatItIs) {
  begin_session();
  ASSERT_TRUE(hello_);
  EXPECT_EQ(hello_->version, protocol::kVersion);
  EXPECT_EQ(hello_->rotor_count, 4);
  EXPECT_EQ(hello_->imu_rate_hz, 500);
  EXPECT_EQ(hello_->command_timeout_ms, 100);
  EXPECT_EQ(std::string(hello_->name.data()), "swiftlet simulated");
}

TEST_F(FirmwareTest, AnswersAHostOfAnotherVersionButObeysItNot) {
  say(protocol::Hello{protocol::kVersion + 1});
  ASSERT_TRUE(hello_);
  EXPECT_EQ(hello_->version, protocol::kVersion);
  say(command(true));
  EXPECT_FALSE(running());
  EXPECT_EQ(frames_, 1);
}

TEST_F(FirmwareTest, AnswersTimeRequestsWithItsClock) {
  begin_session();
  now_us_ += 1234;
  say(protocol::TimeRequest{77});
  ASSERT_TRUE(time_);
  EXPECT_EQ(time_->sent_ns, 77);
  EXPECT_EQ(time_->received_us, now_us_);
  EXPECT_GE(time_->answered_us, time_->received_us);
}

TEST_F(FirmwareTest, ObeysACommandAndReportsItWithTheNextSample) {
  begin_session();
  auto sent = command(true, 65535);
  sent.term = 9;
  now_us_ += 700;
  say(sent);
  ASSERT_TRUE(running());
  EXPECT_DOUBLE_EQ(firmware_.motor_command(now_us_).throttle[0], 1.0);
  plant::ImuSample sample;
  sample.specific_force_frd.z() = -9.75;
  firmware_.send(sample, now_us_ + 1300);
  ASSERT_TRUE(imu_);
  EXPECT_EQ(imu_->stamp_us, now_us_ + 1300);
  EXPECT_FLOAT_EQ(imu_->specific_force_frd[2], -9.75F);
  EXPECT_EQ(imu_->has_command, 1);
  EXPECT_EQ(imu_->command_term, 9U);
  EXPECT_EQ(imu_->command_stamp_us, sent.stamp_us);
  EXPECT_EQ(imu_->command_age_us, 700U);
}

TEST_F(FirmwareTest, KeepsThrottleZeroApartFromRotorsOff) {
  begin_session();
  say(command(true, 0));
  EXPECT_TRUE(running());
  say(command(false));
  EXPECT_FALSE(running());
}

TEST_F(FirmwareTest, StopsTheRotorsWhenCommandsCeaseUntilTheHostHasStoppedThemToo) {
  begin_session();
  say(command(true));
  now_us_ += 100'000;
  EXPECT_TRUE(running());
  now_us_ += 1;
  EXPECT_FALSE(running());
  firmware_.send_state_if_due(now_us_);
  ASSERT_TRUE(state_);
  EXPECT_EQ(state_->rotors_running, 0);
  EXPECT_EQ(std::string(state_->fault.data()), "no command within the time-out");

  say(command(true));
  EXPECT_FALSE(running()) << "in the air, a link that comes back must not start them";
  EXPECT_EQ(refusal(), "the command time-out needs rotors off first");
  say(command(false));
  say(command(true));
  EXPECT_TRUE(running());
  EXPECT_EQ(firmware_.state().fault.front(), '\0');
}

// GIVEN a firmware that nobody asks for a motor command, WHEN a command comes too late, THEN it does not hide the time-out.
TEST_F(FirmwareTest, NoticesTheTimeOutBeforeTheNextCommand) {
  begin_session();
  say(command(true));
  ASSERT_TRUE(running());
  now_us_ += 150'000;
  say(command(true));
  EXPECT_FALSE(running());
}

TEST_F(FirmwareTest, RefusesWhatItMustNotObey) {
  begin_session();
  auto valid = command(true);
  valid.term = 5;
  say(valid);
  auto lower = command(true);
  lower.term = 4;
  say(lower);
  EXPECT_EQ(refusal(), "a controller with a higher term has taken over");
  auto future = command(true);
  future.stamp_us += 1;
  say(future);
  EXPECT_EQ(refusal(), "answers an IMU sample of the future");
  auto old = command(true);
  old.stamp_us -= 1;
  old.term = 5;
  say(old);
  EXPECT_EQ(refusal(), "answers an outdated IMU sample");
  for (const std::int64_t limit :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    auto senseless = command(true);
    senseless.stamp_us = limit;
    senseless.term = 5;
    say(senseless);
    EXPECT_EQ(refusal(),
              limit < 0 ? "answers an outdated IMU sample" : "answers an IMU sample of the future");
  }
  auto six = command(true);
  six.rotor_count = 6;
  say(six);
  EXPECT_EQ(refusal(), "rotor count differs from the vehicle's");
  EXPECT_EQ(firmware_.state().commands_obeyed, 1U);
  EXPECT_EQ(firmware_.state().commands_refused, 6U);
}

TEST_F(FirmwareTest, EndsTheSessionOfASilentHost) {
  begin_session();
  now_us_ += protocol::kSilenceUs;
  EXPECT_TRUE(firmware_.in_session(now_us_));
  now_us_ += 1;
  say(command(true));
  EXPECT_FALSE(running());
  EXPECT_EQ(frames_, 1);
  begin_session();
  say(command(true));
  EXPECT_TRUE(running());
}

TEST_F(FirmwareTest, AllocatesNothing) {
  begin_session();
  const test::MallocGuard guard;
  for (int i = 0; i < 100; ++i) {
    now_us_ += 2000;
    say(protocol::TimeRequest{});
    say(command(true));
    say(command(false));
    firmware_.send(plant::ImuSample{}, now_us_);
    firmware_.send(plant::RotorSpeedSample{}, now_us_);
    firmware_.send(plant::BatterySample{}, now_us_);
    firmware_.send_state_if_due(now_us_);
  }
  EXPECT_EQ(guard.calls(), 0U);
}

}  // namespace swiftlet::services::firmware_test
