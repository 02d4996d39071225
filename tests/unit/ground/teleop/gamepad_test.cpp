#include "swiftlet/ground/teleop/gamepad.hpp"

#include <linux/input.h>
#include <stdexcept>

#include <gtest/gtest.h>

namespace swiftlet::ground::gamepad_test {

input_event event(int type, int code, int value) {
  input_event event{};
  event.type = static_cast<std::uint16_t>(type);
  event.code = static_cast<std::uint16_t>(code);
  event.value = value;
  return event;
}

TEST(Gamepad, IsCentredWithoutTheDeadManButton) {
  Gamepad gamepad(usual_axes());
  gamepad.take(event(EV_ABS, ABS_RY, -32768));
  EXPECT_FALSE(gamepad.enabled());
  EXPECT_TRUE(gamepad.sticks().centred());
  gamepad.take(event(EV_KEY, BTN_SOUTH, 1));
  EXPECT_TRUE(gamepad.sticks().centred()) << "not a shoulder button";
  gamepad.take(event(EV_KEY, BTN_TL, 1));
  EXPECT_EQ(gamepad.sticks().forward, 1.0);
  gamepad.take(event(EV_KEY, BTN_TL, 0));
  EXPECT_TRUE(gamepad.sticks().centred());
}

TEST(Gamepad, StaysEnabledWhileOneOfTwoButtonsIsHeld) {
  Gamepad gamepad(usual_axes());
  gamepad.take(event(EV_KEY, BTN_TL, 1));
  gamepad.take(event(EV_KEY, BTN_TR, 1));
  gamepad.take(event(EV_KEY, BTN_TL, 0));
  EXPECT_TRUE(gamepad.enabled());
  gamepad.take(event(EV_KEY, BTN_TR, 0));
  EXPECT_FALSE(gamepad.enabled());
}

// The right stick moves, the left one climbs and turns. Up and left are negative on an axis.
TEST(Gamepad, MapsTheSticks) {
  Gamepad gamepad(usual_axes());
  gamepad.take(event(EV_KEY, BTN_TR, 1));
  gamepad.take(event(EV_ABS, ABS_RX, 32767));
  EXPECT_EQ(gamepad.sticks().right, 1.0);
  gamepad.take(event(EV_ABS, ABS_RX, 0));
  gamepad.take(event(EV_ABS, ABS_RY, 32767));
  EXPECT_EQ(gamepad.sticks().forward, -1.0);
  gamepad.take(event(EV_ABS, ABS_RY, 0));
  gamepad.take(event(EV_ABS, ABS_Y, -32768));
  EXPECT_EQ(gamepad.sticks().up, 1.0);
  gamepad.take(event(EV_ABS, ABS_Y, 0));
  gamepad.take(event(EV_ABS, ABS_X, -32768));
  EXPECT_EQ(gamepad.sticks().turn, -1.0);
  gamepad.take(event(EV_ABS, ABS_X, 0));
  gamepad.take(event(EV_ABS, ABS_HAT0X, 1));
  EXPECT_TRUE(gamepad.sticks().centred());
}

TEST(Gamepad, HasADeadZoneWithoutAStepAtItsEdge) {
  Gamepad gamepad({{ABS_X, {-100, 100}}, {ABS_Y, {-100, 100, 20}}, {ABS_Z, {}}, {ABS_RZ, {}}});
  gamepad.take(event(EV_KEY, BTN_TRIGGER, 1));
  const auto turn_at = [&](int value) {
    gamepad.take(event(EV_ABS, ABS_X, value));
    return gamepad.sticks().turn;
  };
  EXPECT_EQ(turn_at(10), 0.0);
  EXPECT_EQ(turn_at(-10), 0.0);
  EXPECT_NEAR(turn_at(11), 1.0 / 90.0, 1e-12);
  EXPECT_NEAR(turn_at(-55), -0.5, 1e-12);
  EXPECT_EQ(turn_at(100), 1.0);
  EXPECT_EQ(turn_at(5000), 1.0) << "beyond the axis";
  gamepad.take(event(EV_ABS, ABS_Y, -20));
  EXPECT_EQ(gamepad.sticks().up, 0.0) << "the device's own dead zone is wider";
}

TEST(Gamepad, UsesAxesOfBytesAndTheirOwnValue) {
  Gamepad gamepad({{ABS_X, {0, 255, 0, 255}},
                   {ABS_Y, {0, 255, 0, 128}},
                   {ABS_Z, {0, 255, 0, 128}},
                   {ABS_RZ, {0, 255, 0, 0}}});
  gamepad.take(event(EV_KEY, BTN_TL, 1));
  const Sticks sticks = gamepad.sticks();
  EXPECT_EQ(sticks.turn, 1.0);
  EXPECT_EQ(sticks.up, 0.0);
  EXPECT_EQ(sticks.right, 0.0);
  EXPECT_EQ(sticks.forward, 1.0) << "without ABS_RX and ABS_RY, the right stick is ABS_Z and ABS_RZ";
}

// GIVEN a deflected stick whose return is among the lost events, THEN it counts as centred until it moves again.
TEST(Gamepad, LostEventsReleaseTheButtonsAndCentreTheAxes) {
  Gamepad gamepad(usual_axes());
  gamepad.take(event(EV_KEY, BTN_TL, 1));
  gamepad.take(event(EV_ABS, ABS_X, 32767));
  gamepad.take(event(EV_SYN, SYN_REPORT, 0));
  EXPECT_TRUE(gamepad.enabled());
  gamepad.take(event(EV_SYN, SYN_DROPPED, 0));
  EXPECT_FALSE(gamepad.enabled());
  gamepad.take(event(EV_KEY, BTN_TL, 1));  // before the report: part of an incomplete packet
  EXPECT_FALSE(gamepad.enabled());
  gamepad.take(event(EV_SYN, SYN_REPORT, 0));
  gamepad.take(event(EV_KEY, BTN_TL, 1));
  EXPECT_TRUE(gamepad.sticks().centred());
  gamepad.take(event(EV_ABS, ABS_X, 32767));
  EXPECT_EQ(gamepad.sticks().turn, 1.0);
}

TEST(Gamepad, RequiresTwoSticks) {
  EXPECT_THROW(Gamepad({}), std::runtime_error);
  EXPECT_THROW(Gamepad({{ABS_X, {}}, {ABS_Y, {}}, {ABS_RX, {}}}), std::runtime_error);
  EXPECT_THROW(Gamepad({{ABS_RX, {}}, {ABS_RY, {}}}), std::runtime_error);
}

}  // namespace swiftlet::ground::gamepad_test
