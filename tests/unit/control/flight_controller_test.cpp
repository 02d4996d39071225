#include "swiftlet/control/flight_controller.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::flight_controller_test {

using Eigen::Vector3d;
using simulation::ClosedLoop;

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }
ControlSettings settings(const std::string& name) {
  return io::load_control_settings(tests::in_source("config/control/") + name + ".yaml");
}

MissionItem waypoint(double x, double y, double z, double speed = 0.5) {
  return {MissionItemKind::kWaypoint, {x, y, z}, 0.0, true, speed, 0.0};
}

// The paper's square, Fig. 8: sides of 2 m at up to `speed`.
Mission square(double speed) {
  Mission mission;
  mission.id = 1;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0.0, true, 0.5, 1.0},
                   waypoint(2, 0, -1, speed),
                   waypoint(2, 2, -1, speed),
                   waypoint(0, 2, -1, speed),
                   waypoint(0, 0, -1, speed),
                   {MissionItemKind::kLand, {0, 0, 0}, 0.0, true, 0.4, 0.0}};
  return mission;
}

Request request(RequestKind kind, const Vector3d& position = Vector3d::Zero(), double speed = 0.5) {
  Request request;
  request.kind = kind;
  request.position_ned = position;
  request.speed = speed;
  return request;
}

struct Flown : simulation::SimulatedFlight {
  double rms_3d_m = 0.0;
  double duration_s = 0.0;  // of the mission window, take-off to landing
};

Flown fly(ClosedLoop& loop, const Mission& mission) {
  constexpr double kPlannedS = 100.0;
  record::Flight flight;
  Flown flown{simulation::fly(loop, mission, kPlannedS, {&flight, nullptr, {}})};
  const record::Evaluation result = record::evaluate(flight);
  flown.rms_3d_m = result.errors.rms_3d_m;
  flown.duration_s = result.window ? result.window->duration_s() : 0.0;
  return flown;
}

// In the air, holding at 1 m, with all sensor models on.
class InFlight : public testing::Test {
 protected:
  void SetUp() override {
    loop_.step_until([&] { return loop_.time_s() > 0.5; }, 1.0);
    const Outcome armed = loop_.controller.request(request(RequestKind::kArm));
    ASSERT_TRUE(armed.accepted) << armed.reason;
    ASSERT_TRUE(loop_.controller.request(request(RequestKind::kTakeoff, {0, 0, -1})).accepted);
    ASSERT_TRUE(wait_for(Mode::kHolding, 10.0));
    loop_.step_until([&] { return loop_.time_s() > 10.0; }, 10.0);
  }
  bool wait_for(Mode mode, double limit_s) {
    return loop_.step_until([&] { return loop_.controller.status().mode == mode; }, limit_s);
  }
  double altitude_m() const { return -loop_.plant.state().position_ned.z(); }

  ClosedLoop loop_{kaylion(), plant::SimulationSettings(), settings("motor_lag"), 11};
};

// Without a pose the controller cannot engage. Until then the vehicle is not controlled.
TEST_F(InFlight, RestartedControllerEngagesAndHolds) {
  loop_.controller = FlightController(kaylion(), settings("motor_lag"));
  EXPECT_FALSE(loop_.controller.engage_in_flight()) << "it has no estimate yet";
  ASSERT_TRUE(loop_.step_until(
      [&] { return loop_.controller.detects_airborne() && loop_.controller.engage_in_flight(); }, 0.1));
  double lowest_m = altitude_m();
  loop_.step_until(
      [&] {
        lowest_m = std::min(lowest_m, altitude_m());
        return false;
      },
      3.0);
  EXPECT_EQ(loop_.controller.status().mode, Mode::kHolding);
  EXPECT_EQ(loop_.controller.status().reason, Reason::kEngagedInFlight);
  EXPECT_GT(lowest_m, 0.6);
  EXPECT_LT(loop_.plant.state().velocity_ned.norm(), 0.05);
}

TEST_F(InFlight, LandedVehicleIsNotAirborne) {
  ASSERT_TRUE(loop_.controller.detects_airborne());
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kLand)).accepted);
  ASSERT_TRUE(wait_for(Mode::kDisarmed, 20.0));
  loop_.step_until([] { return false; }, 1.0);
  EXPECT_FALSE(loop_.controller.detects_airborne());
}

TEST_F(InFlight, ControllerContinuesWithAdoptedState) {
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kGoTo, {1.0, 0.0, -1.0})).accepted);
  loop_.step_until([] { return false; }, 1.0);
  const FlightState adopted = loop_.controller.state();
  const Vector3d place = loop_.plant.state().position_ned;
  ASSERT_GT(loop_.plant.state().velocity_ned.norm(), 0.3);

  loop_.controller = FlightController(kaylion(), settings("motor_lag"));
  ASSERT_TRUE(loop_.step_until([&] { return loop_.controller.status().has_pose; }, 0.1));
  loop_.controller.adopt(adopted, nullptr, nullptr);
  loop_.step_until([] { return false; }, 0.002);

  EXPECT_EQ(loop_.controller.status().mode, Mode::kHolding);
  EXPECT_EQ(loop_.controller.status().reason, Reason::kRequested);
  EXPECT_LT((loop_.controller.reference().position_ned - place).norm(), 0.1)
      << "the reference must continue at the adopted position";
  loop_.step_until([] { return false; }, 6.0);
  EXPECT_LT((loop_.plant.state().position_ned - Vector3d(1.0, 0.0, -1.0)).norm(), 0.02);
}

// The state between two steps is that of the controller that hands it over.
TEST_F(InFlight, AdoptedStateIsPassedOnUnchanged) {
  FlightState adopted = loop_.controller.state();
  EXPECT_NEAR(adopted.lift_ratio, 1.0, 0.02) << "learnt";
  adopted.position_integral = {0.3, -0.2, 0.1};
  adopted.lift_ratio = 0.93;
  FlightController follower(kaylion(), settings("motor_lag"));
  follower.adopt(adopted, nullptr, nullptr);
  const FlightState passed_on = follower.state();
  EXPECT_EQ(passed_on.position_integral, adopted.position_integral);
  EXPECT_EQ(passed_on.lift_ratio, adopted.lift_ratio);
  EXPECT_EQ(passed_on.rotor_state, plant::RotorState::kRunning);
  EXPECT_EQ(passed_on.throttle, loop_.command.throttle);
  EXPECT_EQ(passed_on.supervisor.mode, Mode::kHolding);
}

class Seeds : public testing::TestWithParam<int> {};

TEST_P(Seeds, MotorAwareLoopsFlyTheSquareWithinTenMillimetres) {
  ClosedLoop loop(kaylion(), plant::SimulationSettings(), settings("motor_lag"),
                  static_cast<std::uint64_t>(GetParam()));
  const Flown result = fly(loop, square(0.5));
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_LT(result.rms_3d_m, 0.010);
  EXPECT_GT(result.duration_s, 30.0);
  EXPECT_TRUE(loop.plant.on_ground());
  EXPECT_EQ(loop.command.rotor_state, plant::RotorState::kOff);
}

TEST_P(Seeds, PaperLoopsFlyTheSquareWithinThirtyMillimetres) {
  ClosedLoop loop(kaylion(), plant::SimulationSettings(), settings("paper"),
                  static_cast<std::uint64_t>(GetParam()));
  const Flown result = fly(loop, square(0.5));
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_LT(result.rms_3d_m, 0.030);
}
INSTANTIATE_TEST_SUITE_P(Square, Seeds, testing::Range(1, 9));

TEST(FlightController, TracksBetterWithTheRotorLagModel) {
  ClosedLoop with(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 3);
  ClosedLoop without(kaylion(), plant::SimulationSettings(), settings("paper"), 3);
  EXPECT_LT(fly(with, square(0.5)).rms_3d_m, 0.5 * fly(without, square(0.5)).rms_3d_m);
}

TEST(FlightController, RefusesGainsThatTheRotorLagMakesUnstable) {
  ControlSettings hot = settings("paper");
  hot.position.x.omega_n = 8.0;
  try {
    FlightController controller(kaylion(), hot);
    FAIL() << "accepted unstable gains";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("position.x"), std::string::npos) << error.what();
  }
}

TEST(FlightController, KeepsTheRotorsOffUntilRequested) {
  ClosedLoop loop(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 1);
  for (int i = 0; i < 1000; ++i) {
    loop.step();
    ASSERT_EQ(loop.command.rotor_state, plant::RotorState::kOff);
  }
  EXPECT_NEAR(loop.plant.state().position_ned.norm(), 0.0, 1e-3);
}

// GIVEN a vehicle that was carried to another place, so that its estimate was reset, WHEN it is armed, THEN
// it stays armed: the reset is over.
TEST(FlightController, StaysArmedAfterAResetOnTheGround) {
  FlightController controller(kaylion(), settings("motor_lag"));
  plant::ImuSample imu;
  imu.specific_force_frd = {0.0, 0.0, -plant::kGravity};
  const auto stand_at = [&](double x_ned, int steps) {
    for (int i = 0; i < steps; ++i) {
      imu.stamp_ns += 2'000'000;
      ++imu.sequence;
      const std::int64_t exposed_ns = imu.stamp_ns - 2'000'000;
      const Vector3d place(x_ned, 0.0, 0.0);
      if (imu.sequence % 5 == 0)
        controller.on_pose({exposed_ns, imu.sequence, true, place, Eigen::Quaterniond::Identity()});
      controller.on_battery({imu.stamp_ns, imu.sequence, 4.0, 0.1, 0.9});
      controller.on_imu(imu);
    }
  };
  stand_at(0.0, 1000);
  stand_at(1.0, 1000);
  ASSERT_EQ(controller.estimate().resets, 1U);
  const Outcome armed = controller.request(request(RequestKind::kArm));
  ASSERT_TRUE(armed.accepted) << armed.reason;
  stand_at(1.0, 50);
  EXPECT_EQ(controller.status().mode, Mode::kArmed) << to_string(controller.status().reason);
}

TEST_F(InFlight, StepAllocatesNoMemory) {
  const Mission mission = square(0.5);
  Request upload = request(RequestKind::kMissionUpload);
  upload.mission = &mission;
  std::size_t calls = 0;
  const auto flown = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      do {
        loop_.plant.step(loop_.firmware.motor_command(loop_.plant.stamp_ns()));
      } while (!loop_.plant.imu());
      const auto pose = loop_.mocap.update(loop_.plant.truth());
      const test::MallocGuard guard;
      if (pose) loop_.controller.on_pose(*pose);
      if (loop_.plant.battery()) loop_.controller.on_battery(*loop_.plant.battery());
      if (loop_.plant.rotor_speeds()) loop_.controller.on_rotor_speeds(*loop_.plant.rotor_speeds());
      loop_.command = std::get<plant::ActuatorCommand>(loop_.controller.on_imu(*loop_.plant.imu()));
      calls += guard.calls();
      loop_.firmware.accept(loop_.command, loop_.plant.stamp_ns());
    }
  };
  ASSERT_TRUE(loop_.controller.request(upload).accepted);
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kMissionStart)).accepted);
  flown(2000);
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kMissionPause)).accepted);
  flown(1000);
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kMissionResume)).accepted);
  flown(2000);
  EXPECT_EQ(loop_.controller.status().mode, Mode::kMission);
  EXPECT_EQ(calls, 0u);
}

TEST_F(InFlight, GoToReachesThePositionAndHolds) {
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kGoTo, {1, -1, -1.5})).accepted);
  ASSERT_TRUE(loop_.step_until(
      [&] { return (loop_.plant.state().position_ned - Vector3d(1, -1, -1.5)).norm() < 0.01; }, 10.0));
  for (int i = 0; i < 2500; ++i) {
    loop_.step();
    ASSERT_LT((loop_.plant.state().position_ned - Vector3d(1, -1, -1.5)).norm(), 0.02);
  }
}

TEST_F(InFlight, TurnsToAYawTheShorterWay) {
  Request turn = request(RequestKind::kGoTo, {0, 0, -1});
  turn.yaw_free = false;
  turn.yaw_rad = 3.0;
  ASSERT_TRUE(loop_.controller.request(turn).accepted);
  loop_.step_until([] { return false; }, 6.0);
  turn.yaw_rad = -3.0;
  ASSERT_TRUE(loop_.controller.request(turn).accepted);
  double least = 4.0;
  loop_.step_until(
      [&] {
        const auto& q = loop_.plant.state().q_ned_from_frd;
        least = std::min(least, std::abs(2.0 * std::atan2(q.z(), q.w())));
        return false;
      },
      6.0);
  EXPECT_GT(least, 2.9);
  EXPECT_LT((loop_.plant.state().position_ned - Vector3d(0, 0, -1)).norm(), 0.02);
}

TEST_F(InFlight, DescendsLevelWithoutMocapAndStopsOnTheGround) {
  loop_.mocap_connected = false;
  ASSERT_TRUE(wait_for(Mode::kDescent, 1.0));
  double most_tilt = 0.0, fastest = 0.0;
  ASSERT_TRUE(loop_.step_until(
      [&] {
        const auto& state = loop_.plant.state();
        most_tilt = std::max(most_tilt, std::acos((state.q_ned_from_frd * Vector3d::UnitZ()).z()));
        fastest = std::max(fastest, state.velocity_ned.z());
        return loop_.controller.status().mode != Mode::kDescent;
      },
      8.0));
  EXPECT_EQ(loop_.controller.status().reason, Reason::kLandedWithoutPosition);
  EXPECT_TRUE(loop_.step_until([&] { return loop_.plant.on_ground(); }, 0.1));  // it may bounce
  EXPECT_LT(most_tilt, 0.1);
  EXPECT_LT(fastest, 0.8);
  EXPECT_LT(loop_.plant.state().position_ned.head<2>().norm(), 0.5);
}

TEST_F(InFlight, FliesOnThroughAMocapGapOfFourTenthsOfASecond) {
  loop_.mocap_connected = false;
  loop_.step_until([] { return false; }, 0.4);
  loop_.mocap_connected = true;
  double worst = 0.0;
  loop_.step_until(
      [&] {
        worst = std::max(worst, loop_.tracking_error().norm());
        return false;
      },
      2.0);
  EXPECT_EQ(loop_.controller.status().mode, Mode::kHolding);
  EXPECT_LT(worst, 0.05);
}

TEST_F(InFlight, StopsTheRotorsAfterATenthOfASecondOfInvalidImu) {
  plant::ImuSample broken = *loop_.plant.imu();
  broken.body_rates_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  int commands = 0;
  plant::ActuatorCommand command = loop_.command;
  while (command.rotor_state == plant::RotorState::kRunning && commands < 200) {
    broken.stamp_ns += 2'000'000;
    ++broken.sequence;
    command = std::get<plant::ActuatorCommand>(loop_.controller.on_imu(broken));
    EXPECT_EQ(command.imu_sequence, broken.sequence);
    for (const double throttle : command.throttle) EXPECT_TRUE(std::isfinite(throttle));
    ++commands;
  }
  EXPECT_EQ(commands, 50);
  EXPECT_EQ(loop_.controller.status().mode, Mode::kStopped);
}

TEST_F(InFlight, AnswersRequestsAlsoWithAnInvalidImuSample) {
  plant::ImuSample broken = *loop_.plant.imu();
  broken.body_rates_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  broken.stamp_ns += 2'000'000;
  ++broken.sequence;
  const Request stop = request(RequestKind::kStop);
  Outcome outcome;
  control::ClientInputs clients;
  clients.add(stop, outcome);
  loop_.controller.on_imu(broken, clients);
  EXPECT_TRUE(outcome.accepted) << outcome.reason;
  loop_.step();
  EXPECT_EQ(loop_.command.rotor_state, plant::RotorState::kOff);
}

// GIVEN a vehicle with two cells WHEN the battery limits are those of one THEN they are refused, and so is the voltage of two cells by a
// controller of one.
TEST(FlightController, RefusesTheBatteryOfAnotherNumberOfCells) {
  plant::Vehicle two_cells = kaylion();
  two_cells.name = "lab25";
  for (double& voltage_v : two_cells.battery.open_circuit_voltage_v) voltage_v *= 2.0;
  try {
    const FlightController controller(two_cells, settings("motor_lag"));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "motor_lag: failsafe.low_battery_voltage_v is 3.30, must be above 5.30 and below 8.38, the "
                 "battery of lab25, or 0");
  }
  ControlSettings of_the_battery = settings("motor_lag");
  of_the_battery.failsafe.low_battery_voltage = 0.0;
  of_the_battery.failsafe.critical_battery_voltage = 0.0;
  EXPECT_NO_THROW(FlightController(two_cells, of_the_battery));
  ControlSettings never = settings("motor_lag");
  never.failsafe.critical_battery_voltage = 2.65;
  EXPECT_THROW(FlightController(kaylion(), never), std::invalid_argument);

  ClosedLoop loop(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 1);
  ASSERT_TRUE(loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0));
  plant::BatterySample sample;
  sample.stamp_ns = loop.plant.stamp_ns();
  sample.voltage_v = 8.36;
  loop.controller.on_battery(sample);
  const Outcome armed = loop.controller.request(request(RequestKind::kArm));
  EXPECT_FALSE(armed.accepted);
  EXPECT_NE(std::string(armed.reason).find("battery voltage 8.36 V is not one of this vehicle's battery, "),
            std::string::npos)
      << armed.reason;
}

TEST(FlightController, LandsWhenTheBatteryIsLow) {
  ControlSettings careful = settings("motor_lag");
  careful.failsafe.low_battery_voltage = 4.0;
  ClosedLoop loop(kaylion(), plant::SimulationSettings(), careful, 2);
  const Flown result = fly(loop, square(0.3));
  EXPECT_FALSE(result.completed);
  EXPECT_EQ(result.reason, "the mission was aborted: battery is low; landed");
  ASSERT_TRUE(loop.step_until([&] { return loop.controller.status().mode == Mode::kDisarmed; }, 10.0));
  EXPECT_TRUE(loop.plant.on_ground());
}

TEST_F(InFlight, IgnoresImpossibleBatteryVoltages) {
  const double before = loop_.controller.status().supply_voltage_v;
  plant::BatterySample broken;
  for (const double voltage : {0.0, -3.0, 400.0, std::numeric_limits<double>::quiet_NaN()}) {
    broken.voltage_v = voltage;
    loop_.controller.on_battery(broken);
    loop_.controller.on_imu(*loop_.plant.imu());
    EXPECT_EQ(loop_.controller.status().supply_voltage_v, before);
  }
}

TEST_F(InFlight, StopTurnsTheRotorsOffInFlight) {
  ASSERT_TRUE(loop_.controller.request(request(RequestKind::kStop)).accepted);
  loop_.step();
  EXPECT_EQ(loop_.command.rotor_state, plant::RotorState::kOff);
  ASSERT_TRUE(loop_.step_until([&] { return loop_.plant.on_ground(); }, 2.0));
}

TEST(FlightController, IsReproducibleBitByBit) {
  ClosedLoop one(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 5);
  ClosedLoop two(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 5);
  ClosedLoop other(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 6);
  fly(one, square(1.0));
  fly(two, square(1.0));
  fly(other, square(1.0));
  EXPECT_EQ(one.plant.state().position_ned, two.plant.state().position_ned);
  EXPECT_EQ(one.command.throttle, two.command.throttle);
  EXPECT_NE(one.plant.state().position_ned, other.plant.state().position_ned);
}

TEST(FlightController, RestartsWithTheVehicle) {
  ClosedLoop first(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 5);
  first.step_until([] { return false; }, 3.0);
  ClosedLoop again(kaylion(), plant::SimulationSettings(), settings("motor_lag"), 6);
  again.controller = std::move(first.controller);
  const Flown result = fly(again, square(1.0));
  EXPECT_TRUE(result.completed) << result.reason;
}

}  // namespace swiftlet::control::flight_controller_test
