// The square at each level at which a vehicle can be commanded, in one process.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/malloc_guard.hpp"
#include "tests/unit/simulation/default_flight.hpp"

namespace swiftlet::simulation::levels_flight_test {

using plant::ControlLevel;

class Levels : public DefaultFlight, public testing::WithParamInterface<ControlLevel> {
 protected:
  Levels() { world_.control_levels = GetParam(); }

  bool own_position_loop() const { return GetParam() == ControlLevel::kTrajectory; }
  record::TrackingErrors fly_square_with(const plant::Vehicle& vehicle) const {
    ClosedLoop loop(vehicle, world_, settings_, 1);
    const record::TrackingErrors errors = fly_square(loop, settings_);
    EXPECT_EQ(plant::level_of(loop.sent), GetParam());
    return errors;
  }
};

TEST_P(Levels, TheSquareIsTracked) {
  const record::TrackingErrors errors = fly_square_with(vehicle_);
  EXPECT_LT(errors.rms_3d_m, own_position_loop() ? 0.05 : 0.01);
  EXPECT_LT(errors.peak_3d_m, own_position_loop() ? 0.15 : 0.05);
}

// A vehicle that does not measure its rotors, and one that is heavier than the controller's model.
TEST_P(Levels, FliesWithoutMeasuredRotorsAndWithAWrongMass) {
  world_.rotor_speed_rate_hz = 0.0;
  plant::Vehicle heavy = vehicle_;
  heavy.mass_kg *= 1.1;
  ClosedLoop loop(heavy, vehicle_, world_, settings_, 1);
  hover(loop);
  EXPECT_LT(loop.tracking_error().norm(), 0.05);
  land(loop);
  EXPECT_TRUE(loop.plant.on_ground());
}

// Requests a take-off to 1 m of a vehicle that reports that its rotors stand.
void take_off_before_the_rotors_run(ClosedLoop& loop) {
  ASSERT_TRUE(loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0));
  loop.controller.set_rotors_running(false);
  control::Request request;
  request.kind = control::RequestKind::kArm;
  ASSERT_TRUE(loop.controller.request(request).accepted);
  request.kind = control::RequestKind::kTakeoff;
  request.position_ned.z() = -1.0;
  ASSERT_TRUE(loop.controller.request(request).accepted);
}

// GIVEN a vehicle that starts its rotors 3 s later than it is told to THEN control commands no thrust until then, and
// flies as from there on; at level actuators, whose vehicle does as it is told, it does not wait.
TEST_P(Levels, TheTakeOffBeginsWhenTheRotorsRun) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  take_off_before_the_rotors_run(loop);
  run(loop, 3.0);
  const bool is_free = GetParam() == ControlLevel::kActuators;
  EXPECT_EQ(loop.plant.on_ground(), !is_free);
  EXPECT_EQ(loop.controller.attitude_setpoint().thrust_n > 0.0, is_free);
  loop.controller.set_rotors_running(true);
  ASSERT_TRUE(loop.step_until([&] { return mode(loop) == control::Mode::kHolding; }, 10.0));
  EXPECT_LT(loop.tracking_error().norm(), 0.05);
}

// GIVEN a vehicle that never reports that its rotors run THEN the take-off ends, with its rotors off and that reason.
TEST_P(Levels, TheTakeOffEndsIfTheRotorsNeverRun) {
  if (GetParam() == ControlLevel::kActuators) return;
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  take_off_before_the_rotors_run(loop);
  run(loop, 0.1);
  ASSERT_EQ(mode(loop), control::Mode::kTakingOff);
  ASSERT_TRUE(loop.step_until([&] { return mode(loop) == control::Mode::kDisarmed; }, 10.5));
  EXPECT_GT(loop.time_s(), 10.9);
  EXPECT_EQ(loop.controller.status().reason, control::Reason::kRotorsNotRunning);
  EXPECT_TRUE(loop.plant.on_ground());
}

// GIVEN a radio with 40 ms each way THEN the take-off is as calm as the rest of the flight, also with a mass that is not
// known. At level rates the gains of the settings are not made for that delay.
TEST_P(Levels, TakesOffCalmlyOverARadio) {
  if (GetParam() != ControlLevel::kAttitude) return;
  world_.radio = {0.04, 0.004, 0.02};
  for (const double factor : {0.9, 1.0, 1.1}) {
    plant::Vehicle flown = vehicle_;
    flown.mass_kg *= factor;
    ClosedLoop loop(flown, vehicle_, world_, settings_, 1);
    EXPECT_LT(fly_square(loop, settings_).peak_3d_m, 0.02) << factor;
  }
}

// GIVEN hover in steady wind THEN control integrates at the levels at which it controls the position, and at level
// trajectory the vehicle does it alone.
TEST_P(Levels, OnlyWhoClosesTheLoopIntegrates) {
  world_.air.wind_ned = {1.5, -1.0, 0.0};
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  run(loop, 3.0);
  const Eigen::Vector3d integral = loop.controller.state().position_integral;
  EXPECT_EQ(integral.isZero(0.0), own_position_loop()) << integral.transpose();
  EXPECT_EQ(loop.firmware.position_loop().integral().isZero(0.0), !own_position_loop());
  EXPECT_LT(loop.tracking_error().norm(), 0.03);
}

// GIVEN a vehicle that is held back WHEN it stands on the ground after the landing THEN no integral is left.
TEST_P(Levels, NothingIsWoundUpOnTheGround) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  land(loop);
  run(loop, 0.01);
  EXPECT_TRUE(loop.controller.state().position_integral.isZero(0.0));
  EXPECT_TRUE(loop.firmware.position_loop().integral().isZero(0.0));
  EXPECT_TRUE(loop.firmware.rate_loop().integral().isZero(0.0));
}

// GIVEN hover WHEN the vehicle is restarted, and its clock goes on or begins again THEN not one command more lets its rotors run
// until it is armed again.
TEST_P(Levels, ARestartedVehicleGetsRotorsOff) {
  for (const std::int64_t clock_ns : {0, -1'000'000'000}) {
    ClosedLoop loop(vehicle_, world_, settings_, 1);
    hover(loop);
    control::FlightController& controller = loop.controller;
    plant::ImuSample sample;
    sample.specific_force_frd = {0.0, 0.0, -plant::kGravity};
    sample.stamp_ns = loop.plant.stamp_ns() + clock_ns;
    controller.restart_vehicle();
    for (int i = 0; i < 1000; ++i) {
      sample.stamp_ns += 2'000'000;
      ++sample.sequence;
      ASSERT_EQ(plant::header_of(controller.on_imu(sample)).rotor_state, plant::RotorState::kOff) << i;
    }
    EXPECT_EQ(mode(loop), control::Mode::kStopped);
    EXPECT_EQ(controller.status().reason, control::Reason::kVehicleRestarted);
    control::Request request;
    request.kind = control::RequestKind::kTakeoff;
    EXPECT_FALSE(controller.request(request).accepted);
    request.kind = control::RequestKind::kDisarm;
    EXPECT_TRUE(controller.request(request).accepted);
  }
}

TEST_P(Levels, WithoutPosesTheVehicleDescendsAndStopsItsRotors) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  loop.mocap_connected = false;
  ASSERT_TRUE(loop.step_until([&] { return mode(loop) == control::Mode::kDescent; }, 2.0));
  ASSERT_TRUE(loop.step_until([&] { return control::rotors_off(mode(loop)); }, 8.0));
  EXPECT_EQ(mode(loop), control::Mode::kDisarmed) << control::to_string(loop.controller.status().reason);
  EXPECT_EQ(loop.controller.status().reason, control::Reason::kLandedWithoutPosition);
  EXPECT_LT(loop.plant.state().position_ned.head<2>().norm(), 0.5);
}

// GIVEN a vehicle that climbs and flies sideways WHEN control falls silent THEN it climbs no further than it would without
// thrust, levels itself where it can, and its rotors stop.
TEST_P(Levels, WithoutControlTheVehicleDoesNotClimbAway) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  control::Request up;
  up.kind = control::RequestKind::kGoTo;
  up.position_ned = {1.0, 0.0, -2.3};
  up.speed = 1.5;
  ASSERT_TRUE(loop.controller.request(up).accepted);
  ASSERT_TRUE(loop.step_until([&] { return loop.plant.state().velocity_ned.z() < -0.5; }, 5.0));
  const double from_m = -loop.plant.state().position_ned.z();
  const double speed = loop.plant.state().velocity_ned.norm();
  loop.control_connected = false;
  double highest_m = from_m;
  bool idled = false;
  const std::int64_t last_ns = loop.plant.stamp_ns();
  const auto silent_s = [&] { return 1e-9 * static_cast<double>(loop.plant.stamp_ns() - last_ns); };
  ASSERT_TRUE(loop.step_until(
      [&] {
        highest_m = std::max(highest_m, -loop.plant.state().position_ned.z());
        const plant::MotorCommand& motors = loop.firmware.motor_command(loop.plant.stamp_ns());
        idled =
            idled || (motors.state == plant::RotorState::kRunning && motors.throttle == plant::PerRotor{});
        return motors.state == plant::RotorState::kOff;
      },
      1.0));
  EXPECT_NEAR(silent_s(), world_.command_timeout_s, 0.01);
  EXPECT_EQ(idled, GetParam() == ControlLevel::kActuators);
  EXPECT_LT(highest_m, from_m + 0.35);
  const plant::VehicleState& state = loop.plant.state();
  if (own_position_loop()) {
    EXPECT_LT(state.velocity_ned.norm(), 0.6 * speed);  // brakes
  } else if (GetParam() == ControlLevel::kAttitude) {
    EXPECT_GT((state.q_ned_from_frd * Eigen::Vector3d::UnitZ()).z(), 0.98);
    EXPECT_LT(state.body_rates_frd.norm(), 0.5);
  } else if (GetParam() == ControlLevel::kRates) {
    EXPECT_LT(state.body_rates_frd.norm(), 0.5);
  }
}

// GIVEN rotors that idle on the ground WHEN control falls silent THEN they do not lift the vehicle.
TEST_P(Levels, WithoutControlAnArmedVehicleStaysOnTheGround) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  ASSERT_TRUE(loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0));
  control::Request arm;
  arm.kind = control::RequestKind::kArm;
  ASSERT_TRUE(loop.controller.request(arm).accepted);
  run(loop, 1.0);
  loop.control_connected = false;
  run(loop, 0.45);
  const plant::MotorCommand& motors = loop.firmware.motor_command(loop.plant.stamp_ns());
  EXPECT_EQ(motors.state, plant::RotorState::kRunning);
  EXPECT_TRUE(loop.plant.on_ground());
  EXPECT_LT(*std::max_element(motors.throttle.begin(), motors.throttle.end()), 0.2);
}

TEST_P(Levels, AStepOfControllerAndFirmwareAllocatesNoMemory) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  const test::MallocGuard guard;
  for (int i = 0; i < 500; ++i) loop.step();
  EXPECT_EQ(guard.calls(), 0U);
}

TEST_P(Levels, StopTurnsTheRotorsOffAtOnce) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  control::Request stop;
  stop.kind = control::RequestKind::kStop;
  ASSERT_TRUE(loop.controller.request(stop).accepted);
  loop.step();
  EXPECT_EQ(plant::header_of(loop.sent).rotor_state, plant::RotorState::kOff);
  loop.step();
  EXPECT_EQ(loop.firmware.motor_command(loop.plant.stamp_ns()).state, plant::RotorState::kOff);
}

TEST_P(Levels, StreamsOfAttitudesAreFollowedOrRefusedByName) {
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  control::Setpoint tilted;
  tilted.kind = control::SetpointKind::kAttitude;
  tilted.q_ned_from_frd = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  tilted.specific_thrust = plant::kGravity;
  const control::Outcome outcome = loop.controller.on_setpoint(tilted);
  if (own_position_loop()) {
    EXPECT_STREQ(outcome.reason,
                 "setpoint: a vehicle that is commanded at level trajectory follows no attitudes");
    return;
  }
  ASSERT_TRUE(outcome.accepted) << outcome.reason;
  run(loop, 0.5);
  EXPECT_LT(loop.plant.state().q_ned_from_frd.angularDistance(tilted.q_ned_from_frd), 0.03);
  control::Setpoint turning;
  turning.kind = control::SetpointKind::kBodyRates;
  turning.body_rates_frd = {0.0, 0.0, 0.8};
  turning.specific_thrust = plant::kGravity;
  ASSERT_TRUE(loop.controller.on_setpoint(turning).accepted);
  run(loop, 0.7);
  EXPECT_NEAR(loop.plant.state().body_rates_frd.z(), 0.8, 0.15);
}

TEST_P(Levels, AnotherVehicleFliesWithTheSameSettings) {
  const plant::Vehicle crazyflie = io::load_vehicle(io::find_config("vehicles/crazyflie2.yaml"));
  EXPECT_LT(fly_square_with(crazyflie).rms_3d_m, own_position_loop() ? 0.05 : 0.02);
}

// The levels above actuators, whose inner loops are not behind the radio.
class LevelsOverARadio : public Levels {};

// GIVEN a Crazyflie behind a radio with 2 % loss THEN it flies the square with the default gains.
TEST_P(LevelsOverARadio, TrackTheSquare) {
  const plant::Vehicle crazyflie = io::load_vehicle(io::find_config("vehicles/crazyflie2.yaml"));
  for (const double delay_s : {0.01, 0.04}) {
    world_.radio = {delay_s, 0.004, 0.02};
    const record::TrackingErrors errors = fly_square_with(crazyflie);
    EXPECT_LT(errors.rms_3d_m, own_position_loop() ? 0.05 : 0.01) << delay_s;
  }
}

// GIVEN a controller of level attitude WHEN the vehicle accepts other levels only THEN it cannot be armed.
TEST(LevelChoice, ArmingIsRefusedAtALevelThatTheVehicleDoesNotAccept) {
  plant::SimulationSettings world = io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  world.control_levels = plant::ControlLevels::from_bits(0b1010);
  ClosedLoop loop(io::load_vehicle(io::find_config("vehicles/kaylion.yaml")), world,
                  io::load_control_settings(io::find_config("control/motor_lag.yaml")), 1);
  loop.controller.set_levels(world.control_levels, ControlLevel::kAttitude);
  loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0);
  control::Request arm;
  arm.kind = control::RequestKind::kArm;
  const control::Outcome refused = loop.controller.request(arm);
  EXPECT_FALSE(refused.accepted);
  EXPECT_STREQ(
      refused.reason,
      "cannot arm: the vehicle does not accept commands at level attitude, it accepts rates, trajectory");
  loop.controller.set_levels(world.control_levels, std::nullopt);
  EXPECT_TRUE(loop.controller.request(arm).accepted);
  loop.step();
  EXPECT_EQ(plant::level_of(loop.sent), ControlLevel::kRates);
}

// GIVEN rotors that turn WHEN the choice changes THEN the level stays until they are off.
TEST(LevelChoice, StaysWhileTheRotorsTurn) {
  plant::SimulationSettings world = io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  world.control_levels = plant::ControlLevels::from_bits(0b0110);
  ClosedLoop loop(io::load_vehicle(io::find_config("vehicles/kaylion.yaml")), world,
                  io::load_control_settings(io::find_config("control/motor_lag.yaml")), 1);
  loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0);
  control::Request request;
  request.kind = control::RequestKind::kArm;
  ASSERT_TRUE(loop.controller.request(request).accepted);
  loop.step();
  loop.controller.set_levels(world.control_levels, ControlLevel::kAttitude);
  loop.step();
  EXPECT_EQ(plant::level_of(loop.sent), ControlLevel::kRates);
  request.kind = control::RequestKind::kDisarm;
  ASSERT_TRUE(loop.controller.request(request).accepted);
  loop.step();
  loop.controller.set_levels(world.control_levels, ControlLevel::kAttitude);
  loop.step();
  EXPECT_EQ(plant::level_of(loop.sent), ControlLevel::kAttitude);
}

INSTANTIATE_TEST_SUITE_P(All, Levels, testing::ValuesIn(plant::kControlLevels),
                         [](const auto& level) { return std::string(plant::to_string(level.param)); });
INSTANTIATE_TEST_SUITE_P(All, LevelsOverARadio,
                         testing::Values(ControlLevel::kRates, ControlLevel::kAttitude,
                                         ControlLevel::kTrajectory),
                         [](const auto& level) { return std::string(plant::to_string(level.param)); });

}  // namespace swiftlet::simulation::levels_flight_test
