#include "swiftlet/ground/teleop/key_sticks.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::key_sticks_test {

const KeyTimeouts kTimeouts{0.7, 0.25};

TEST(KeySticks, HoldAKeyUntilTheKeyboardBeginsToRepeat) {
  KeySticks keys(kTimeouts);
  EXPECT_TRUE(keys.sticks(10.0).centred());
  keys.press(StickKey::kForward, 10.0);
  EXPECT_EQ(keys.sticks(10.69).forward, 1.0);
  EXPECT_TRUE(keys.sticks(10.71).centred());
}

// GIVEN a key that repeats WHEN it stops THEN it counts as released after the repeat time-out.
TEST(KeySticks, ReleaseAKeyThatNoLongerRepeats) {
  KeySticks keys(kTimeouts);
  keys.press(StickKey::kUp, 0.0);
  double now_s = 0.5;
  for (; now_s < 3.0; now_s += 0.03) {
    keys.press(StickKey::kUp, now_s);
    ASSERT_EQ(keys.sticks(now_s).up, 1.0);
  }
  EXPECT_EQ(keys.sticks(now_s - 0.03 + 0.24).up, 1.0);
  EXPECT_TRUE(keys.sticks(now_s - 0.03 + 0.26).centred());
}

TEST(KeySticks, ATapAfterATapShortensTheTime) {
  KeySticks keys(kTimeouts);
  keys.press(StickKey::kTurnLeft, 0.0);
  keys.press(StickKey::kTurnLeft, 0.2);
  EXPECT_EQ(keys.sticks(0.44).turn, -1.0);
  EXPECT_TRUE(keys.sticks(0.46).centred());
}

TEST(KeySticks, TheOppositeKeyReverses) {
  KeySticks keys(kTimeouts);
  keys.press(StickKey::kLeft, 0.0);
  keys.press(StickKey::kRight, 0.1);
  EXPECT_EQ(keys.sticks(0.1).right, 1.0);
  EXPECT_EQ(keys.sticks(0.79).right, 1.0) << "it is a first press";
}

// A keyboard repeats only the key that was pressed last.
TEST(KeySticks, KeysOfTwoAxesAreIndependent) {
  KeySticks keys(kTimeouts);
  keys.press(StickKey::kBack, 0.0);
  keys.press(StickKey::kBack, 0.5);
  keys.press(StickKey::kDown, 0.6);
  EXPECT_EQ(keys.sticks(0.7).forward, -1.0);
  EXPECT_EQ(keys.sticks(0.7).up, -1.0);
  EXPECT_EQ(keys.sticks(0.8).forward, 0.0);
  EXPECT_EQ(keys.sticks(0.8).up, -1.0);
}

TEST(KeySticks, AllCanBeReleased) {
  KeySticks keys(kTimeouts);
  keys.press(StickKey::kTurnRight, 0.0);
  EXPECT_EQ(keys.sticks(0.0).turn, 1.0);
  keys.release_all();
  EXPECT_TRUE(keys.sticks(0.0).centred());
}

}  // namespace swiftlet::ground::key_sticks_test
