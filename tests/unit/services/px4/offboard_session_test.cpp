// PX4's offboard mode as a state machine, against the rules of PX4's commander.
#include "swiftlet/services/px4/offboard_session.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/px4/translate.hpp"
#include "swiftlet/services/px4/words.hpp"
#include "tests/support/px4/rules.hpp"

namespace swiftlet::px4::offboard_session_test {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriodNs = 10 * kMs;
constexpr std::uint8_t kPosition = 2;

// Control, the session and PX4, by a clock of their own.
class Px4Session : public testing::Test {
 protected:
  void step() {
    now_ns_ += kPeriodNs;
    inputs_.now_ns = now_ns_;
    if (control_lives_) {
      if (inputs_.commanded_ns == 0 || now_ns_ - inputs_.commanded_ns > 2 * kPeriodNs)
        inputs_.streamed_since_ns = now_ns_;
      inputs_.commanded_ns = now_ns_;
      if (session_.streams()) {
        ++streamed_;
        if (reaches_px4_) rules_.on_offboard_mode(offboard_mode(plant::RatesSetpoint()), now_ns_ / 1000);
      }
    }
    rules_.update(motion_, now_ns_ / 1000);
    if (px4_sends_) {
      inputs_.sampled_ns = now_ns_;
      inputs_.status = rules_.status();
      inputs_.status_ns = now_ns_;
      inputs_.flags = rules_.flags();
    }
    const auto command = session_.update(inputs_);
    if (!command) return;
    commands_.push_back(command->command());
    if (!reaches_px4_) return;
    const auto ack = rules_.on_command(*command, now_ns_ / 1000);
    if (ack && px4_sends_) session_.on_ack(*ack);
  }
  bool until(const std::function<bool()>& predicate, double seconds = 10.0) {
    for (double t_s = 0.0; t_s < seconds; t_s += 0.01) {
      if (predicate()) return true;
      step();
    }
    return predicate();
  }
  bool until(Phase phase, double seconds = 10.0) {
    return until([this, phase] { return session_.phase() == phase; }, seconds);
  }
  void run(double seconds) {
    until([] { return false; }, seconds);
  }
  void fly() {
    inputs_.rotors_wanted = true;
    ASSERT_TRUE(until(Phase::kFlying)) << session_.fault();
    motion_.touches_ground = false;
    run(0.5);
    ASSERT_EQ(session_.phase(), Phase::kFlying) << session_.fault();
  }

  std::int64_t now_ns_ = 1'000'000'000'000;
  tests::Px4Rules rules_;
  tests::Px4Rules::Motion motion_;
  OffboardSession session_;
  OffboardInputs inputs_;
  bool control_lives_ = true;
  bool px4_sends_ = true;
  bool reaches_px4_ = true;
  int streamed_ = 0;
  std::vector<std::uint32_t> commands_;
};

TEST_F(Px4Session, ArmsInOffboardModeAndDisarms) {
  run(0.5);
  EXPECT_EQ(session_.phase(), Phase::kDisarmed);
  EXPECT_EQ(session_.fault(), "");
  EXPECT_TRUE(commands_.empty());
  fly();
  EXPECT_TRUE(rules_.armed());
  EXPECT_TRUE(rules_.offboard());
  EXPECT_EQ(commands_, (std::vector<std::uint32_t>{kCommandSetMode, kCommandArmDisarm}))
      << "PX4 accepts each at once: the proof of life came first";
  inputs_.rotors_wanted = false;
  ASSERT_TRUE(until(Phase::kDisarmed));
  EXPECT_FALSE(rules_.armed()) << "also in the air";
  EXPECT_EQ(session_.fault(), "");
}

TEST_F(Px4Session, AnswersThatAreLostAreAskedForAgain) {
  run(1.5);
  inputs_.rotors_wanted = true;
  reaches_px4_ = false;
  run(0.7);
  reaches_px4_ = true;
  ASSERT_TRUE(until(Phase::kFlying)) << session_.fault();
  EXPECT_GT(commands_.size(), 2U);
}

TEST_F(Px4Session, ARefusalNamesPx4sReason) {
  rules_.refuses_to_arm = true;
  inputs_.rotors_wanted = true;
  ASSERT_TRUE(until(Phase::kRefused));
  EXPECT_EQ(session_.fault(),
            "PX4 does not arm: temporarily rejected (failure detector: an ESC did not arm)");
  const std::size_t sent = commands_.size();
  run(2.0);
  EXPECT_EQ(commands_.size(), sent) << "it does not go on asking";
  inputs_.rotors_wanted = false;
  EXPECT_TRUE(until(Phase::kDisarmed));
  rules_.refuses_to_arm = false;
  inputs_.rotors_wanted = true;
  EXPECT_TRUE(until(Phase::kFlying)) << session_.fault();
}

TEST_F(Px4Session, WhatMustNotFlyIsToldBeforeAndNotArmed) {
  inputs_.arming_fault = "no pose of motion capture";
  run(0.1);
  EXPECT_EQ(session_.phase(), Phase::kDisarmed);
  EXPECT_EQ(session_.fault(), "no pose of motion capture");
  inputs_.rotors_wanted = true;
  ASSERT_TRUE(until(Phase::kRefused));
  EXPECT_EQ(session_.fault(), "no pose of motion capture");
  EXPECT_TRUE(commands_.empty());
}

TEST_F(Px4Session, DeathOfControlEndsTheStreamAndLands) {
  fly();
  control_lives_ = false;
  const int streamed = streamed_;
  const std::int64_t died_ns = now_ns_;
  ASSERT_TRUE(until([this] { return rules_.status().nav_state() == kNavStateLand; }));
  EXPECT_LT(now_ns_ - died_ns, 250 * kMs) << "PX4's failsafe would take 1 s";
  EXPECT_FALSE(rules_.status().failsafe());
  EXPECT_EQ(streamed_, streamed);
  EXPECT_EQ(session_.fault(), "no command of the control service: PX4 was told to land");
  control_lives_ = true;  // a new one commands again, in the air
  run(2.0);
  EXPECT_EQ(rules_.status().nav_state(), kNavStateLand) << "it does not fight the landing";
  EXPECT_EQ(streamed_, streamed);
  motion_.touches_ground = true;
  inputs_.rotors_wanted = false;
  run(2.0);
  EXPECT_TRUE(rules_.armed()) << "rotors off of the new one do not act before the landing ends";
  ASSERT_TRUE(until([this] { return !rules_.armed(); }));
  EXPECT_TRUE(until(Phase::kDisarmed));
  EXPECT_EQ(session_.fault(), "");
}

// Control answers samples: without them it falls silent, and is not to blame.
TEST_F(Px4Session, SamplesThatEndAreNotTakenForTheDeathOfControl) {
  fly();
  px4_sends_ = false;
  control_lives_ = false;
  ASSERT_TRUE(until(Phase::kLanding, 0.3));
  EXPECT_EQ(session_.fault(), "the link to PX4 is lost: no samples");
}

TEST_F(Px4Session, ThePilotTakesOver) {
  fly();
  rules_.pilot_selects(kPosition, now_ns_ / 1000);
  ASSERT_TRUE(until(Phase::kTakenOver));
  EXPECT_EQ(session_.fault(), "PX4 is in mode Position (pilot or ground station)");
  const int streamed = streamed_;
  const std::size_t sent = commands_.size();
  run(1.0);
  inputs_.rotors_wanted = false;  // control has stopped the flight
  run(1.0);
  EXPECT_TRUE(rules_.armed());
  EXPECT_EQ(rules_.status().nav_state(), kPosition);
  EXPECT_EQ(streamed_, streamed);
  EXPECT_EQ(commands_.size(), sent);
}

// The pilot chooses another mode while PX4 refuses to arm for a while: it is not armed in that mode.
TEST_F(Px4Session, IsNotArmedInAModeOfThePilot) {
  rules_.refuses_to_arm = true;
  inputs_.rotors_wanted = true;
  ASSERT_TRUE(until(Phase::kArming));
  run(0.2);
  rules_.pilot_selects(kPosition, now_ns_ / 1000);
  rules_.refuses_to_arm = false;
  ASSERT_TRUE(until(Phase::kRefused));
  EXPECT_EQ(session_.fault(), "PX4 must not be armed: it is in mode Position");
  run(2.0);
  EXPECT_FALSE(rules_.armed());
  inputs_.rotors_wanted = false;
  ASSERT_TRUE(until(Phase::kDisarmed)) << "and can be begun anew";
}

TEST_F(Px4Session, TheFailsafeIsNamed) {
  fly();
  reaches_px4_ = false;  // nothing arrives there: PX4's failsafe lands
  ASSERT_TRUE(until(Phase::kTakenOver));
  EXPECT_EQ(session_.fault(), "PX4 is in mode Land (failsafe)");
}

TEST_F(Px4Session, TheKillSwitchIsNamed) {
  fly();
  rules_.kill(now_ns_ / 1000);
  ASSERT_TRUE(until(Phase::kTakenOver));
  EXPECT_EQ(session_.fault(), "PX4 disarmed: kill switch");
  run(1.0);
  EXPECT_FALSE(rules_.armed()) << "it is not armed again";
}

TEST_F(Px4Session, LossOfTheLinkFromPx4Lands) {
  fly();
  px4_sends_ = false;
  ASSERT_TRUE(until([this] { return rules_.status().nav_state() == kNavStateLand; }));
  EXPECT_EQ(session_.fault(), "the link to PX4 is lost: no samples");
  px4_sends_ = true;
  motion_.touches_ground = true;
  inputs_.rotors_wanted = false;
  ASSERT_TRUE(until(Phase::kDisarmed, 20.0)) << to_string(session_.phase());
}

TEST_F(Px4Session, AnUnknownVersionIsNeverArmed) {
  inputs_.version_fault = "PX4 publishes vehicle_status_v4";
  inputs_.rotors_wanted = true;
  run(3.0);
  EXPECT_EQ(session_.phase(), Phase::kDisconnected);
  EXPECT_EQ(session_.fault(), "PX4 publishes vehicle_status_v4");
  EXPECT_TRUE(commands_.empty());
  EXPECT_EQ(streamed_, 0);
}

TEST_F(Px4Session, PX4ArmedByAnotherIsLeftAlone) {
  run(1.5);
  rules_.on_command(set_offboard_mode(1), now_ns_ / 1000);
  rules_.on_command(arm(1), now_ns_ / 1000);
  ASSERT_TRUE(rules_.armed());
  ASSERT_TRUE(until(Phase::kTakenOver));
  EXPECT_EQ(session_.fault(), "PX4 was armed by another, it is in mode Offboard");
}

TEST_F(Px4Session, AutomaticDisarmingBeforeTakeOffIsNamed) {
  inputs_.rotors_wanted = true;
  ASSERT_TRUE(until(Phase::kFlying));
  ASSERT_TRUE(until(Phase::kTakenOver, 15.0));
  EXPECT_EQ(session_.fault(), "PX4 disarmed: automatically before take-off");
}

}  // namespace swiftlet::px4::offboard_session_test
