#include "swiftlet/ground/cli/analysis/log/control_replay.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::control_replay_test {

ControlReplay alike() {
  ControlReplay replay;
  replay.commands.messages_a = replay.commands.messages_b = 1000;
  replay.commands.compared = replay.imu_samples = 1000;
  replay.commands.signals = {{"throttle", 1e-9, 1e-8, 3.0}, {"rotor_state", 0.0, 0.0, 0.0}};
  return replay;
}

TEST(ControlReplay, IsTheSameOnlyIfEverythingIs) {
  EXPECT_EQ(difference_of(alike(), 1e-6), "");
  ControlReplay replay = alike();
  EXPECT_EQ(difference_of(replay, 1e-9), "throttle differs by 1e-08 at 3.000 s");
  replay = alike();
  replay.commands.signals[1].max = 1.0;
  replay.commands.signals[1].max_at_s = 4.5;
  EXPECT_EQ(difference_of(replay, 1e-6), "rotor_state differs by 1 at 4.500 s");
  replay = alike();
  replay.other_answers = 2;
  EXPECT_EQ(difference_of(replay, 1e-6), "2 requests are answered otherwise");
  replay = alike();
  replay.commands.compared = 900;
  EXPECT_EQ(difference_of(replay, 1e-6), "100 of 1000 recorded commands have no counterpart");
  replay.commands.compared = 995;
  EXPECT_EQ(difference_of(replay, 1e-6), "") << "at the ends of a recording";
  replay = alike();
  replay.commands.messages_a = 1100;
  EXPECT_EQ(difference_of(replay, 1e-6), "") << "some were repeated";
  replay.commands.compared = 0;
  EXPECT_EQ(difference_of(replay, 1e-6), "none of the recorded commands has a counterpart");
}

}  // namespace swiftlet::ground::control_replay_test
