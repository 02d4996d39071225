// Runs are reproducible bit by bit, and noise streams are independent.
#include "swiftlet/plant/simulation/plant_simulation.hpp"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/mocap.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::plant_simulation_test {

using plant::PlantSimulation;
using plant::SimulationSettings;

SimulationSettings noisy_world() {
  SimulationSettings settings;
  settings.air.gust_sigma_ned = {0.5, 0.5, 0.2};
  settings.mocap.dropout_probability = 0.05;
  return settings;
}

struct Recording {
  std::vector<double> truth;
  std::vector<double> forces;
  std::vector<double> rates;
  std::vector<double> positions;
  std::vector<double> orientations;
};

void append(std::vector<double>& to, const double* from, std::size_t count) {
  to.insert(to.end(), from, from + count);
}

Recording fly(const SimulationSettings& settings, std::uint64_t seed) {
  plant::Vehicle vehicle = kaylion();
  vehicle.linear_drag = 0.02;
  PlantSimulation plant(vehicle, settings, seed);
  plant::Mocap mocap(settings.mocap, seed);
  Recording run;
  for (int i = 0; i < 1500; ++i) {
    const plant::TruthSample truth = plant.truth();
    append(run.truth, truth.position_ned.data(), 3);
    append(run.truth, truth.velocity_ned.data(), 3);
    append(run.truth, truth.q_ned_from_frd.coeffs().data(), 4);
    append(run.truth, truth.body_rates_frd.data(), 3);
    append(run.truth, truth.rotor_speeds.data(), 4);
    append(run.truth, &truth.supply_voltage_v, 1);
    if (plant.imu()) {
      append(run.forces, plant.imu()->specific_force_frd.data(), 3);
      append(run.rates, plant.imu()->body_rates_frd.data(), 3);
    }
    if (const auto pose = mocap.update(truth)) {
      append(run.positions, pose->position_ned.data(), 3);
      append(run.orientations, pose->q_ned_from_frd.coeffs().data(), 4);
    }
    plant::MotorCommand command = running(0.36);
    command.throttle[static_cast<std::size_t>(i / 10 % 4)] += 0.02;
    plant.step(command);
  }
  return run;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(PlantSimulation, IsReproducibleBitByBit) {
  const Recording a = fly(noisy_world(), 42);
  const Recording b = fly(noisy_world(), 42);
  EXPECT_TRUE(same(a.truth, b.truth));
  EXPECT_TRUE(same(a.forces, b.forces));
  EXPECT_TRUE(same(a.rates, b.rates));
  EXPECT_TRUE(same(a.positions, b.positions));
  EXPECT_TRUE(same(a.orientations, b.orientations));
}

TEST(PlantSimulation, DiffersWithTheSeed) {
  const Recording a = fly(noisy_world(), 42);
  const Recording b = fly(noisy_world(), 43);
  EXPECT_FALSE(same(a.truth, b.truth));
  EXPECT_FALSE(same(a.forces, b.forces));
  EXPECT_FALSE(same(a.rates, b.rates));
  EXPECT_FALSE(same(a.positions, b.positions));
  EXPECT_FALSE(same(a.orientations, b.orientations));
}

TEST(PlantSimulation, SensorNoiseDoesNotChangeTheTruth) {
  SimulationSettings quiet = noisy_world();
  quiet.imu = empty_space().imu;
  quiet.mocap.position_error_m = 0.0;
  EXPECT_TRUE(same(fly(noisy_world(), 42).truth, fly(quiet, 42).truth));
}

TEST(PlantSimulation, NoiseStreamsAreIndependent) {
  const Recording all = fly(noisy_world(), 42);
  SimulationSettings settings = noisy_world();
  settings.imu.accelerometer_noise_density = 0.0;
  settings.imu.accelerometer_bias_sigma = 0.0;
  settings.imu.accelerometer_bias_walk = 0.0;
  Recording run = fly(settings, 42);
  EXPECT_FALSE(same(all.forces, run.forces));
  EXPECT_TRUE(same(all.rates, run.rates));
  EXPECT_TRUE(same(all.positions, run.positions));

  settings = noisy_world();
  settings.imu.gyro_noise_density = 0.0;
  settings.imu.gyro_bias_walk = 0.0;
  run = fly(settings, 42);
  EXPECT_TRUE(same(all.forces, run.forces));
  EXPECT_FALSE(same(all.rates, run.rates));

  settings = noisy_world();
  settings.mocap.position_error_m = 0.0;
  run = fly(settings, 42);
  EXPECT_FALSE(same(all.positions, run.positions));
  EXPECT_TRUE(same(all.orientations, run.orientations));
  EXPECT_TRUE(same(all.rates, run.rates));

  settings = noisy_world();
  settings.mocap.misalignment_rad = 0.0;
  run = fly(settings, 42);
  EXPECT_TRUE(same(all.positions, run.positions));
  EXPECT_FALSE(same(all.orientations, run.orientations));
}

TEST(PlantSimulation, StartsWithSamplesOfStampZero) {
  const PlantSimulation plant(kaylion(), SimulationSettings(), 1);
  EXPECT_EQ(plant.stamp_ns(), 0);
  EXPECT_EQ(plant.truth().sequence, 1U);
  EXPECT_TRUE(plant.truth().on_ground);
  ASSERT_TRUE(plant.imu() && plant.battery() && plant.rotor_speeds());
  EXPECT_EQ(plant.imu()->sequence, 1U);
  EXPECT_NEAR(plant.imu()->specific_force_frd.z(), -plant::kGravity, 1.0);
  EXPECT_EQ(plant.battery()->voltage_v, 4.19);
}

}  // namespace swiftlet::tests::plant_simulation_test
