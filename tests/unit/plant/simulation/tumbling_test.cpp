// The simulated vehicle against an independent integration of the paper's equations.
#include <algorithm>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/paper_equations.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::tumbling_test {

using Eigen::Vector3d;
using paper::Motor;

Vector3d random_vector(UniformRandom& draw, double length) {
  Vector3d v;
  do {
    v = Vector3d(draw(-1, 1), draw(-1, 1), draw(-1, 1));
  } while (v.norm() > 1.0);
  return length * v;
}

plant::VehicleState random_tumble(UniformRandom& draw) {
  plant::VehicleState state;
  state.position_ned = random_vector(draw, 2.0);
  state.velocity_ned = random_vector(draw, 3.0);
  state.q_ned_from_frd = Eigen::Quaterniond(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized();
  state.body_rates_frd = random_vector(draw, 15.0);
  for (std::size_t i = 0; i < 4; ++i) state.rotor_speeds[i] = draw(0.0, 2300.0);
  return state;
}

constexpr double kSupplyVoltage = 4.19;  // of a full battery

// Flies 2 s with commands that change every 3 .. 80 ms, and compares at each change. The tolerance is
// relative to the peak of each quantity.
void compare(const plant::Vehicle& vehicle, Motor motor, UniformRandom& draw, double tolerance) {
  constexpr int kSteps = 2000;

  const plant::VehicleState initial = random_tumble(draw);
  plant::PlantSimulation plant(vehicle, empty_space(), 1, initial);
  paper::Equations equations{vehicle.inertia, motor, kSupplyVoltage};
  paper::State reference = paper::state_of(initial);

  paper::Comparison comparison;
  double fastest = 0.0;
  for (int now = 0; now < kSteps;) {
    const int until = std::min(now + static_cast<int>(draw(3, 80)), kSteps);
    plant::MotorCommand command;
    equations.running = draw(0, 1) > 0.1;
    command.state = equations.running ? plant::RotorState::kRunning : plant::RotorState::kOff;
    for (std::size_t i = 0; i < 4; ++i) {
      equations.throttle[i] = std::clamp(draw(-0.2, 0.9), 0.0, 1.0);
      command.throttle[i] = equations.throttle[i];
    }
    paper::integrate(equations, reference, now * 1.0e-3, until * 1.0e-3);
    for (; now < until; ++now) plant.step(command);

    comparison.add(reference, paper::state_of(plant.state()));
    fastest = std::max(fastest, plant.state().body_rates_frd.norm());
  }
  EXPECT_EQ(plant.stamp_ns(), 2'000'000'000);
  EXPECT_GT(fastest, 3.0) << "the vehicle hardly tumbles";
  for (std::size_t i = 0; i < paper::kNames.size(); ++i) {
    EXPECT_LT(comparison.worst[i], tolerance * comparison.peak[i])
        << paper::kNames[i] << " reaches " << comparison.peak[i];
  }
}

TEST(Tumbling, MatchesThePaperWithTheReducedMotor) {
  UniformRandom draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(kaylion(), Motor::kReduced, draw, 1.0e-5);
  }
}

TEST(Tumbling, MatchesThePaperWithThePhysicalMotor) {
  plant::Vehicle vehicle = kaylion();
  vehicle.motor.model = plant::MotorModel::kPhysical;
  UniformRandom draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(vehicle, Motor::kPhysical, draw, 1.0e-5);
  }
}

TEST(Tumbling, MatchesThePaperWithProductsOfInertia) {
  plant::Vehicle vehicle = kaylion();
  vehicle.inertia << 4.4e-5, 3.0e-6, -2.0e-6, 3.0e-6, 5.5e-5, 4.0e-6, -2.0e-6, 4.0e-6, 8.8e-5;
  ASSERT_TRUE(plant::validate(vehicle).empty());
  UniformRandom draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(vehicle, Motor::kReduced, draw, 1.0e-5);
  }
}

}  // namespace swiftlet::tests::tumbling_test
