#include "swiftlet/plant/simulation/firmware/firmware.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::firmware_test {

using Eigen::Vector3d;
using plant::CommandFault;
using plant::ControlLevel;
using plant::ControlLevels;
using plant::RotorState;

const double kWeight_n = kaylion().mass_kg * plant::kGravity;

// The simulated vehicle with its firmware in empty space; perfect poses of its motion at each IMU sample.
class Flown : public testing::Test {
 protected:
  void make(ControlLevels levels) {
    settings_ = empty_space();
    settings_.control_levels = levels;
    plant_.emplace(kaylion(), settings_, 1);
    firmware_.emplace(kaylion(), settings_);
    inform();
  }
  // Answers each IMU sample with this command.
  void run(double duration_s, plant::VehicleCommand command) {
    const std::int64_t end_ns = plant_->stamp_ns() + std::llround(1e9 * duration_s);
    while (plant_->stamp_ns() < end_ns) {
      if (plant_->imu()) {
        plant::header_of(command).stamp_ns = plant_->stamp_ns();
        plant::header_of(command).rotor_state = RotorState::kRunning;
        ASSERT_EQ(firmware_->accept(command, plant_->stamp_ns()), CommandFault::kNone);
      }
      step();
    }
  }
  // Without commands.
  void step_for(double duration_s) {
    const std::int64_t end_ns = plant_->stamp_ns() + std::llround(1e9 * duration_s);
    while (plant_->stamp_ns() < end_ns) step();
  }
  void step() {
    plant_->step(firmware_->motor_command(plant_->stamp_ns()));
    inform();
  }
  void inform() {
    if (plant_->battery()) firmware_->on_battery(*plant_->battery());
    if (!plant_->imu()) return;
    firmware_->on_imu(*plant_->imu());
    plant::PoseSample pose;
    pose.stamp_ns = plant_->stamp_ns();
    pose.tracked = true;
    pose.position_ned = plant_->state().position_ned;
    pose.q_ned_from_frd = plant_->state().q_ned_from_frd;
    firmware_->on_pose(pose);
  }
  const plant::VehicleState& state() const { return plant_->state(); }

  plant::SimulationSettings settings_;
  std::optional<plant::PlantSimulation> plant_;
  std::optional<plant::Firmware> firmware_;
};

TEST_F(Flown, AtLevelActuatorsThrottlesArePassedOn) {
  make(ControlLevel::kActuators);
  plant::ActuatorCommand command;
  command.rotor_count = 4;
  command.throttle = {0.1, 0.2, 0.3, 0.4};
  run(0.01, command);
  EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).throttle, command.throttle);
}

TEST_F(Flown, AtLevelRatesTheBodyTurnsAsCommanded) {
  make(ControlLevel::kRates);
  plant::RatesSetpoint hover;
  hover.thrust_n = kWeight_n;
  run(0.5, hover);
  plant::RatesSetpoint turning = hover;
  turning.body_rates_frd = {1.0, -0.5, 0.5};
  run(0.6, turning);
  EXPECT_LT((state().body_rates_frd - turning.body_rates_frd).norm(), 0.15);
}

TEST_F(Flown, AtLevelAttitudeTheBodyTiltsAsCommanded) {
  make(ControlLevel::kAttitude);
  plant::AttitudeSetpoint tilted;
  tilted.q_ned_from_frd = Eigen::AngleAxisd(0.2, Vector3d(1.0, 1.0, 0.0).normalized());
  tilted.thrust_n = kWeight_n;
  run(1.5, tilted);
  EXPECT_LT(state().q_ned_from_frd.angularDistance(tilted.q_ned_from_frd), 0.02);
}

TEST_F(Flown, AtLevelTrajectoryTheVehicleGoesToThePosition) {
  make(ControlLevel::kTrajectory);
  plant::TrajectorySetpoint there;
  there.position_used = true;
  there.position_ned = {0.5, -0.3, -1.0};
  there.yaw_rad = 0.5;
  run(8.0, there);
  EXPECT_LT((state().position_ned - there.position_ned).norm(), 0.02);
  EXPECT_LT(state().velocity_ned.norm(), 0.02);
}

TEST_F(Flown, WithoutAPositionTheVelocityIsFollowed) {
  make(ControlLevel::kTrajectory);
  plant::TrajectorySetpoint sinking;
  sinking.velocity_ned.z() = 0.4;
  run(6.0, sinking);
  EXPECT_NEAR(state().velocity_ned.z(), 0.4, 0.02);
  EXPECT_LT(state().velocity_ned.head<2>().norm(), 0.02);
}

TEST_F(Flown, RotorsStopAtEveryLevelWhenCommandsStop) {
  for (const ControlLevel level : plant::kControlLevels) {
    SCOPED_TRACE(plant::to_string(level));
    make(level);
    plant::RatesSetpoint rates;
    rates.thrust_n = kWeight_n;
    plant::AttitudeSetpoint attitude;
    attitude.thrust_n = kWeight_n;
    plant::ActuatorCommand actuators;
    actuators.rotor_count = 4;
    actuators.throttle.fill(0.5);
    const plant::VehicleCommand commands[] = {actuators, rates, attitude, plant::TrajectorySetpoint()};
    run(0.1, commands[static_cast<std::size_t>(level)]);
    EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).state, RotorState::kRunning);
    step_for(settings_.command_timeout_s + 0.002);
    EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).state, RotorState::kOff);
    EXPECT_TRUE(firmware_->expired(plant_->stamp_ns()));
    EXPECT_EQ(firmware_->rate_loop().integral(), Vector3d::Zero());
  }
}

// GIVEN a vehicle that turns, tilts or climbs WHEN commands cease THEN it obeys the last one for 0.2 s, and then levels
// itself and sinks.
TEST_F(Flown, AnOutdatedCommandIsNotObeyed) {
  plant::RatesSetpoint turning;
  turning.thrust_n = 1.5 * kWeight_n;
  turning.body_rates_frd = {0.0, 0.0, 2.0};
  plant::AttitudeSetpoint tilted;
  tilted.thrust_n = 1.5 * kWeight_n;
  tilted.q_ned_from_frd = Eigen::AngleAxisd(0.3, Vector3d::UnitX());
  plant::TrajectorySetpoint climbing;
  climbing.velocity_ned.z() = -1.0;
  for (const plant::VehicleCommand& command :
       {plant::VehicleCommand(turning), plant::VehicleCommand(tilted), plant::VehicleCommand(climbing)}) {
    SCOPED_TRACE(plant::to_string(plant::level_of(command)));
    make(plant::level_of(command));
    settings_.command_timeout_s = 5.0;
    firmware_.emplace(kaylion(), settings_);
    run(1.5, command);
    const double turned = state().body_rates_frd.norm();
    const double tilt = state().q_ned_from_frd.angularDistance(Eigen::Quaterniond::Identity());
    const double climb = -state().velocity_ned.z();
    EXPECT_TRUE(turned > 1.5 || tilt > 0.25 || climb > 0.9);
    step_for(0.19);
    EXPECT_FALSE(firmware_->outdated(plant_->stamp_ns()));
    const double fastest = -state().velocity_ned.z();
    EXPECT_GE(fastest, 0.9 * climb);
    step_for(1.0);
    EXPECT_TRUE(firmware_->outdated(plant_->stamp_ns()));
    EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).state, RotorState::kRunning);
    EXPECT_LT(state().body_rates_frd.norm(), 0.1);
    EXPECT_GT((state().q_ned_from_frd * Vector3d::UnitZ()).z(), 0.998);
    EXPECT_LT(-state().velocity_ned.z(), fastest - 0.5);
  }
}

TEST_F(Flown, WithoutCommandsRotorsThatIdleGoOnIdling) {
  for (const plant::VehicleCommand& idle :
       {plant::VehicleCommand(plant::RatesSetpoint()), plant::VehicleCommand(plant::AttitudeSetpoint())}) {
    SCOPED_TRACE(plant::to_string(plant::level_of(idle)));
    make(plant::level_of(idle));
    run(0.1, idle);
    step_for(0.3);
    EXPECT_TRUE(firmware_->outdated(plant_->stamp_ns()));
    EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).state, RotorState::kRunning);
    EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).throttle, plant::PerRotor{});
  }
}

TEST_F(Flown, IntegralsStandStillBelowHalfTheWeight) {
  make(ControlLevel::kRates);
  plant::RatesSetpoint wound;
  wound.body_rates_frd = {1.0, 1.0, 1.0};
  wound.thrust_n = 0.4 * kWeight_n;
  run(0.5, wound);
  EXPECT_EQ(firmware_->rate_loop().integral(), Vector3d::Zero());
}

TEST_F(Flown, WithoutThrustTheRotorsIdle) {
  make(ControlLevel::kRates);
  plant::RatesSetpoint idle;
  idle.body_rates_frd = {1.0, 1.0, 1.0};
  run(0.05, idle);
  EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).state, RotorState::kRunning);
  EXPECT_EQ(firmware_->motor_command(plant_->stamp_ns()).throttle, plant::PerRotor{});
}

TEST_F(Flown, TheLoopsUseNoHeap) {
  make(ControlLevel::kTrajectory);
  plant::TrajectorySetpoint there;
  there.position_used = true;
  there.position_ned.z() = -1.0;
  run(0.1, there);
  const test::MallocGuard guard;
  run(0.1, there);
  EXPECT_EQ(guard.calls(), 0U);
}

}  // namespace swiftlet::tests::firmware_test
