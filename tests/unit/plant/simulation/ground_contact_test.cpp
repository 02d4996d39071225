// The floor under the whole simulated vehicle: standing, landing, dropping, slipping, taking off.
#include "swiftlet/plant/simulation/ground_contact.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::ground_contact_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::MotorCommand;
using plant::PlantSimulation;
using plant::VehicleState;

plant::SimulationSettings on_floor() {
  plant::SimulationSettings settings = empty_space();
  settings.ground.present = true;
  return settings;
}

double tilt(const VehicleState& state) {
  return std::acos(std::clamp((state.q_ned_from_frd * Vector3d::UnitZ()).z(), -1.0, 1.0));
}

double energy(const VehicleState& state) {
  const plant::Vehicle& vehicle = kaylion();
  return vehicle.mass_kg *
             (0.5 * state.velocity_ned.squaredNorm() - plant::kGravity * state.position_ned.z()) +
         0.5 * state.body_rates_frd.dot(vehicle.inertia * state.body_rates_frd);
}

double clearance(const VehicleState& state) {
  return plant::GroundContact(kaylion(), on_floor().ground).clearance(state);
}

void step(PlantSimulation& plant, const MotorCommand& command, int milliseconds) {
  for (int i = 0; i < milliseconds; ++i) plant.step(command);
}

void expect_rest(const VehicleState& state) {
  EXPECT_TRUE(state.velocity_ned.isZero(0.0)) << state.velocity_ned.transpose();
  EXPECT_TRUE(state.body_rates_frd.isZero(0.0)) << state.body_rates_frd.transpose();
}

TEST(GroundContact, StandsStillAtLowThrottle) {
  for (const MotorCommand& command : {MotorCommand{}, running(0.0), running(0.2)}) {
    PlantSimulation plant(kaylion(), on_floor(), 1);
    EXPECT_TRUE(plant.on_ground());
    for (int i = 0; i < 10'000; ++i) {
      plant.step(command);
      ASSERT_TRUE(plant.on_ground()) << i;
      ASSERT_LT(plant.state().position_ned.norm(), 1.0e-4) << i;
      ASSERT_LT(tilt(plant.state()), 1.0e-4) << i;
      if (plant.imu()) {
        // While rotors spin up, the lift of the sample and the mean contact force differ by a step.
        const double tolerance = i < 2000 ? 0.05 : 1.0e-6;
        const Vector3d at_rest(0.0, 0.0, -plant::kGravity);
        ASSERT_LT((plant.imu()->specific_force_frd - at_rest).norm(), tolerance) << i;
      }
    }
  }
}

TEST(GroundContact, LandsAndComesToRest) {
  struct Landing {
    const char* name;
    Vector3d velocity;
    double tilt_rad;
  };
  const double ten_degrees = 10.0 * M_PI / 180.0;
  for (const Landing& landing :
       {Landing{"level, 0.5 m/s", {0.0, 0.0, 0.5}, 0.0},
        Landing{"10 degrees of tilt", {0.0, 0.0, 0.1}, ten_degrees},
        Landing{"both", {0.0, 0.0, 0.5}, ten_degrees}, Landing{"moving sideways", {0.2, -0.1, 0.3}, 0.05}}) {
    SCOPED_TRACE(landing.name);
    VehicleState start;
    start.position_ned = {0.0, 0.0, -0.05};
    start.velocity_ned = landing.velocity;
    start.q_ned_from_frd = AngleAxisd(landing.tilt_rad, Vector3d(0.8, 0.6, 0.0));
    PlantSimulation plant(kaylion(), on_floor(), 1, start);
    EXPECT_FALSE(plant.on_ground());
    step(plant, {}, 3000);
    EXPECT_TRUE(plant.on_ground());
    EXPECT_LT(tilt(plant.state()), 1.0e-4);
    EXPECT_NEAR(plant.state().position_ned.z(), 0.0, 1.0e-5);
    EXPECT_LT(plant.state().position_ned.head<2>().norm(), 0.2);
    expect_rest(plant.state());
  }
}

TEST(GroundContact, DropsNeverGainEnergyOrPenetrate) {
  UniformRandom draw;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    VehicleState start;
    start.position_ned = {0.0, 0.0, draw(-1.0, -0.12)};
    start.velocity_ned = {draw(-2, 2), draw(-2, 2), draw(-1, 3)};
    start.q_ned_from_frd = Quaterniond(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized();
    start.body_rates_frd = {draw(-10, 10), draw(-10, 10), draw(-10, 10)};
    PlantSimulation plant(kaylion(), on_floor(), 1, start);
    const double scale = energy(start) + kaylion().mass_kg * plant::kGravity;
    double before = energy(start);
    for (int i = 0; i < 6000; ++i) {
      plant.step({});
      const double now = energy(plant.state());
      ASSERT_LE(now, before + 1.0e-6 * scale) << "after " << i + 1 << " ms";
      ASSERT_GE(clearance(plant.state()), -1.0e-9) << "after " << i + 1 << " ms";
      before = now;
    }
    EXPECT_TRUE(plant.on_ground());
    EXPECT_LT(plant.state().velocity_ned.norm(), 0.01);
    EXPECT_LT(plant.state().body_rates_frd.norm(), 0.1);
  }
}

TEST(GroundContact, WindMovesItOnlyBeyondTheFrictionCone) {
  plant::Vehicle vehicle = kaylion();
  vehicle.linear_drag = 0.05;
  const double weight = vehicle.mass_kg * plant::kGravity;
  for (const double share : {0.9, 1.2}) {
    plant::SimulationSettings settings = on_floor();
    settings.ground.friction = 0.3;
    settings.air.drag = true;
    settings.air.wind_ned.x() = share * settings.ground.friction * weight / vehicle.linear_drag;
    PlantSimulation plant(vehicle, settings, 1);
    step(plant, {}, 1000);
    EXPECT_LT(tilt(plant.state()), 1.0e-3);
    if (share < 1.0) {
      EXPECT_LT(plant.state().position_ned.norm(), 1.0e-4);
    } else {
      // m dv/dt = (c wind - mu m g) - c v
      const double terminal = 0.2 * settings.ground.friction * weight / vehicle.linear_drag;
      const double lag = vehicle.mass_kg / vehicle.linear_drag;
      EXPECT_NEAR(plant.state().velocity_ned.x(), terminal * (1.0 - std::exp(-1.0 / lag)), 0.01 * terminal);
    }
  }
}

TEST(GroundContact, SlidesToRestByCoulombsLaw) {
  plant::SimulationSettings settings = on_floor();
  settings.ground.friction = 0.2;
  VehicleState start;
  start.velocity_ned = {1.0, 0.0, 0.0};
  PlantSimulation plant(kaylion(), settings, 1, start);
  step(plant, {}, 1000);
  EXPECT_NEAR(plant.state().position_ned.x(), 1.0 / (2.0 * 0.2 * plant::kGravity), 1.0e-3);
  expect_rest(plant.state());
}

TEST(GroundContact, TakesOffWithoutTouchingAgain) {
  PlantSimulation plant(kaylion(), on_floor(), 1);
  step(plant, running(0.0), 500);
  const MotorCommand command = running(0.5);
  int lifted_at = 0;
  for (int i = 1; i <= 1000; ++i) {
    plant.step(command);
    if (!plant.on_ground() && lifted_at == 0) lifted_at = i;
    if (lifted_at > 0) {
      ASSERT_FALSE(plant.on_ground()) << "touched again after " << i << " ms";
    }
  }
  EXPECT_GT(lifted_at, 0);
  EXPECT_LT(lifted_at, 200);
  EXPECT_LT(plant.state().position_ned.z(), -0.5);
  EXPECT_LT(plant.state().position_ned.head<2>().norm(), 1.0e-6);
  EXPECT_LT(tilt(plant.state()), 1.0e-6);
}

TEST(GroundContact, RestsUpsideDown) {
  VehicleState start;
  start.position_ned = {0.0, 0.0, -0.1};
  start.q_ned_from_frd = AngleAxisd(M_PI, Vector3d::UnitX());
  PlantSimulation plant(kaylion(), on_floor(), 1, start);
  step(plant, {}, 2000);
  EXPECT_NEAR(plant.state().position_ned.z(), 0.02, 1.0e-5);  // hubs on the floor
  EXPECT_NEAR(tilt(plant.state()), M_PI, 1.0e-3);
  expect_rest(plant.state());
}

TEST(GroundContact, IsAbsentWhenDisabled) {
  PlantSimulation plant(kaylion(), empty_space(), 1);
  EXPECT_FALSE(plant.on_ground());
  step(plant, {}, 1000);
  EXPECT_NEAR(plant.state().position_ned.z(), 0.5 * plant::kGravity, 1.0e-9);
}

TEST(GroundContact, FloorIsAtTheEndOfTheLegs) {
  const plant::GroundContact ground(kaylion(), on_floor().ground);
  EXPECT_DOUBLE_EQ(ground.floor_z_ned(), 0.02);
  VehicleState state;
  EXPECT_DOUBLE_EQ(ground.clearance(state), 0.0);
  state.position_ned.z() = -0.3;
  EXPECT_DOUBLE_EQ(ground.clearance(state), 0.3);
  EXPECT_TRUE(ground.out_of_reach(-0.06));
  EXPECT_FALSE(ground.out_of_reach(-0.05));
}

}  // namespace swiftlet::tests::ground_contact_test
