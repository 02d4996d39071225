#include "swiftlet/ground/cli/analysis/level_gains.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/tuning/delay_design.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground::level_gains_test {

using plant::ControlLevel;

class LevelGainsOf : public testing::Test {
 protected:
  // Hovers over a radio, and returns the largest tilt, rad, or vertical speed, m/s, meanwhile.
  double unrest_in_hover(ControlLevel level, double one_way_s) {
    plant::SimulationSettings world =
        io::load_simulation_settings(io::find_config("simulation/default.yaml"));
    world.control_levels = level;
    world.radio = {one_way_s, 0.0, 0.0};
    simulation::ClosedLoop loop(vehicle_, world, settings_, 1);
    control::Request request;
    request.kind = control::RequestKind::kArm;
    EXPECT_TRUE(loop.step_until(
        [&] { return loop.time_s() > 1.0 && loop.controller.request(request).accepted; }, 3.0));
    request.kind = control::RequestKind::kTakeoff;
    request.position_ned.z() = -1.0;
    EXPECT_TRUE(loop.controller.request(request).accepted);
    double most = 0.0;
    loop.step_until(
        [&] {
          const Eigen::Vector3d down = loop.plant.state().q_ned_from_frd * Eigen::Vector3d::UnitZ();
          const double unrest =
              std::max(std::acos(std::min(down.z(), 1.0)), std::abs(loop.plant.state().velocity_ned.z()));
          if (loop.time_s() > 8.0) most = std::max(most, unrest);
          return most > 0.5;
        },
        25.0);
    EXPECT_LT(loop.plant.state().position_ned.z(), -0.3) << plant::to_string(level) << ' ' << one_way_s;
    return most;
  }

  plant::Vehicle vehicle_ = io::load_vehicle(io::find_config("vehicles/crazyflie2.yaml"));
  control::ControlSettings settings_ = io::load_control_settings(io::find_config("control/motor_lag.yaml"));
};

// GIVEN the delay that the loops tolerate WHEN a vehicle flies with less THEN it hovers calmly, with more it does not.
TEST_F(LevelGainsOf, ToleratedDelayIsThatOfAFlight) {
  settings_.estimator.detectors.recovery.longest_wait_s = 0.15;
  // The delay is that of the loops in hover: with more, the take-off that learns the lift already ends on the ground.
  settings_.rough_air.learn_lift = false;
  for (const ControlLevel level : {ControlLevel::kRates, ControlLevel::kAttitude}) {
    const LevelGains gains = level_gains(vehicle_, settings_, level, 0.0);
    const double least_s = *std::min_element(gains.tolerated_delay_s.begin(), gains.tolerated_delay_s.end());
    ASSERT_LT(least_s, 0.3) << plant::to_string(level);
    EXPECT_LT(unrest_in_hover(level, 0.5 * 0.75 * least_s), 0.1) << plant::to_string(level) << ' ' << least_s;
    EXPECT_GT(unrest_in_hover(level, 0.5 * 1.25 * least_s), 0.3) << plant::to_string(level) << ' ' << least_s;
  }
}

TEST_F(LevelGainsOf, AreDesignedForADelayWithReserve) {
  for (const ControlLevel level : {ControlLevel::kRates, ControlLevel::kAttitude}) {
    const analysis::DelayDesign tuned =
        analysis::design_for_delay(vehicle_, settings_, 0.1, {level, vehicle_loops(vehicle_)});
    const LevelGains gains = level_gains(vehicle_, tuned.settings, level, 0.1);
    EXPECT_LT(tuned.factor, 1.0) << plant::to_string(level);
    for (std::size_t i = 0; i < gains.margins.size(); ++i) {
      EXPECT_GE(gains.tolerated_delay_s[i], analysis::kDelayReserve * 0.1)
          << plant::to_string(level) << ' ' << i;
      EXPECT_GT(gains.margins[i].phase_deg, 15.0) << plant::to_string(level) << ' ' << i;
    }
  }
}

TEST_F(LevelGainsOf, NameWhoClosesEachLoop) {
  const auto loops_of = [&](ControlLevel level) {
    return nlohmann::json::parse(level_gains_json(level_gains(vehicle_, settings_, level, 0.04))).at("loops");
  };
  EXPECT_EQ(loops_of(ControlLevel::kRates).at("roll").at("closed_by"), "control");
  EXPECT_EQ(loops_of(ControlLevel::kAttitude).at("roll").at("closed_by"), "vehicle");
  EXPECT_EQ(loops_of(ControlLevel::kAttitude).at("x").at("closed_by"), "control");
  EXPECT_EQ(loops_of(ControlLevel::kTrajectory).at("z").at("closed_by"), "vehicle");
  EXPECT_TRUE(loops_of(ControlLevel::kTrajectory).at("x").at("tolerated_delay_s").is_null());
}

}  // namespace swiftlet::ground::level_gains_test
