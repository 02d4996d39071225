#include "swiftlet/ground/terminal/mission_progress.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::mission_progress_test {

TEST(MissionProgress, SaysWhatIsNotKnownYet) {
  VehicleState state;
  state.mode = control::Mode::kMission;
  state.mission.item = 2;
  state.mission.items = 6;
  EXPECT_EQ(mission_progress_text(state), "2/6  mission  no position yet, no battery voltage yet");
  state.position_ned_m = {1.0, 0.25, -1.0};
  state.battery_voltage_v = 3.917;
  EXPECT_EQ(mission_progress_text(state), "2/6  mission  ( 1.00,  0.25, -1.00) m, 3.92 V");
}

}  // namespace swiftlet::ground::mission_progress_test
