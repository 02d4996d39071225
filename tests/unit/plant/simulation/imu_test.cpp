#include "swiftlet/plant/simulation/imu.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::imu_test {

using Eigen::Vector3d;
using plant::Imu;
using plant::ImuSample;
using plant::ImuSettings;

const Vector3d kForce(0.5, -0.3, -9.8);
const Vector3d kRates(0.1, 0.2, -0.4);

TEST(Imu, MeasuresTheTruthWithoutErrors) {
  Imu imu(empty_space().imu, 1);
  for (std::uint64_t sequence = 1; sequence < 5; ++sequence) {
    const ImuSample sample = imu.sample(1234, kForce, kRates);
    EXPECT_EQ(sample.stamp_ns, 1234);
    EXPECT_EQ(sample.sequence, sequence);
    EXPECT_EQ(sample.specific_force_frd, kForce);
    EXPECT_EQ(sample.body_rates_frd, kRates);
  }
}

class ImuAtRate : public testing::TestWithParam<double> {};

TEST_P(ImuAtRate, NoiseIsDensityTimesRootOfRate) {
  ImuSettings settings = empty_space().imu;
  settings.rate_hz = GetParam();
  settings.accelerometer_noise_density = 4.0e-3;
  settings.gyro_noise_density = 2.0e-4;
  Imu imu(settings, 5);
  constexpr int kCount = 100'000;  // the standard error of the standard deviation is 0.22 %
  Vector3d sums[2] = {Vector3d::Zero(), Vector3d::Zero()};
  Vector3d squares[2] = {Vector3d::Zero(), Vector3d::Zero()};
  Vector3d neighbours = Vector3d::Zero();
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const ImuSample sample = imu.sample(0, kForce, kRates);
    const Vector3d force = sample.specific_force_frd - kForce;
    const Vector3d rates = sample.body_rates_frd - kRates;
    sums[0] += force;
    sums[1] += rates;
    squares[0] += force.cwiseAbs2();
    squares[1] += rates.cwiseAbs2();
    neighbours += force.cwiseProduct(last);
    last = force;
  }
  const double sigmas[2] = {4.0e-3 * std::sqrt(GetParam()), 2.0e-4 * std::sqrt(GetParam())};
  for (int sensor = 0; sensor < 2; ++sensor) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(std::sqrt(squares[sensor][axis] / kCount), sigmas[sensor], 0.01 * sigmas[sensor]);
      EXPECT_NEAR(sums[sensor][axis] / kCount, 0.0, 5.0 * sigmas[sensor] / std::sqrt(kCount));
    }
  }
  EXPECT_LT((neighbours / kCount).norm(), 0.03 * sigmas[0] * sigmas[0]) << "the noise is not white";
}

INSTANTIATE_TEST_SUITE_P(Rates, ImuAtRate, testing::Values(500.0, 1000.0));

TEST(Imu, BiasIsConstantInARunAndVariesBetweenRuns) {
  ImuSettings settings = empty_space().imu;
  settings.accelerometer_bias_sigma = 0.1;
  settings.gyro_bias_sigma = 0.01;
  double force_squares = 0.0;
  double rates_squares = 0.0;
  constexpr int kRuns = 3000;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    Imu imu(settings, seed);
    const ImuSample first = imu.sample(0, kForce, kRates);
    const ImuSample second = imu.sample(0, kForce, kRates);
    EXPECT_EQ(first.specific_force_frd, second.specific_force_frd);
    EXPECT_EQ(first.body_rates_frd, second.body_rates_frd);
    EXPECT_EQ(first.specific_force_frd, Vector3d(kForce + imu.accelerometer_bias()));
    EXPECT_EQ(first.body_rates_frd, Vector3d(kRates + imu.gyro_bias()));
    force_squares += imu.accelerometer_bias().squaredNorm();
    rates_squares += imu.gyro_bias().squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(force_squares / (3 * kRuns)), 0.1, 0.1 * 0.03);
  EXPECT_NEAR(std::sqrt(rates_squares / (3 * kRuns)), 0.01, 0.01 * 0.03);
}

TEST_P(ImuAtRate, BiasWalksWithTheRootOfTime) {
  ImuSettings settings = empty_space().imu;
  settings.rate_hz = GetParam();
  settings.accelerometer_bias_walk = 1.0e-3;
  settings.gyro_bias_walk = 1.0e-4;
  double force_squares = 0.0;
  double rates_squares = 0.0;
  constexpr int kRuns = 1000;
  const int four_seconds = static_cast<int>(4.0 * GetParam());
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    Imu imu(settings, seed);
    for (int i = 0; i < four_seconds; ++i) imu.sample(0, kForce, kRates);
    force_squares += imu.accelerometer_bias().squaredNorm();
    rates_squares += imu.gyro_bias().squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(force_squares / (3 * kRuns)), 2.0e-3, 0.05 * 2.0e-3);
  EXPECT_NEAR(std::sqrt(rates_squares / (3 * kRuns)), 2.0e-4, 0.05 * 2.0e-4);
}

TEST(Imu, SaturatesAtItsRange) {
  ImuSettings settings = empty_space().imu;
  settings.accelerometer_range = 20.0;
  settings.gyro_range = 5.0;
  Imu imu(settings, 1);
  const ImuSample sample = imu.sample(0, {21.0, -25.0, 19.0}, {-6.0, 4.0, 5.5});
  EXPECT_EQ(sample.specific_force_frd, Vector3d(20.0, -20.0, 19.0));
  EXPECT_EQ(sample.body_rates_frd, Vector3d(-5.0, 4.0, 5.0));
}

TEST_P(ImuAtRate, SamplesComeAtTheirRates) {
  plant::SimulationSettings settings = empty_space();
  settings.imu.rate_hz = GetParam();
  settings.rotor_speed_rate_hz = 250.0;
  settings.supply.rate_hz = 10.0;
  plant::PlantSimulation plant(kaylion(), settings, 1);
  const std::int64_t imu_period = std::llround(1.0e9 / GetParam());
  std::uint64_t imu_count = 0;
  std::uint64_t speed_count = 0;
  std::uint64_t battery_count = 0;
  for (std::int64_t stamp = 0; stamp < 2'000'000'000; stamp += 1'000'000) {
    ASSERT_EQ(plant.stamp_ns(), stamp);
    ASSERT_EQ(plant.imu().has_value(), stamp % imu_period == 0);
    ASSERT_EQ(plant.rotor_speeds().has_value(), stamp % 4'000'000 == 0);
    ASSERT_EQ(plant.battery().has_value(), stamp % 100'000'000 == 0);
    if (plant.imu()) {
      ASSERT_EQ(plant.imu()->stamp_ns, stamp);
      ASSERT_EQ(plant.imu()->sequence, ++imu_count);
    }
    if (plant.rotor_speeds()) {
      ASSERT_EQ(plant.rotor_speeds()->stamp_ns, stamp);
      ASSERT_EQ(plant.rotor_speeds()->sequence, ++speed_count);
      ASSERT_EQ(plant.rotor_speeds()->rotor_count, 4);
      ASSERT_EQ(plant.rotor_speeds()->speeds, plant.state().rotor_speeds);
    }
    if (plant.battery()) {
      ASSERT_EQ(plant.battery()->stamp_ns, stamp);
      ASSERT_EQ(plant.battery()->sequence, ++battery_count);
      ASSERT_EQ(plant.battery()->voltage_v, plant.truth().supply_voltage_v);
      ASSERT_EQ(plant.battery()->state_of_charge, 1.0);
    }
    plant.step(running(0.4));
  }
}

TEST(Imu, SendsNoRotorSpeedsAtRateZero) {
  plant::SimulationSettings settings = empty_space();
  settings.rotor_speed_rate_hz = 0.0;
  plant::PlantSimulation plant(kaylion(), settings, 1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(plant.rotor_speeds().has_value());
    plant.step(running(0.3));
  }
}

// Sliding north with the nose to the east: friction points south, to the right of the body (Coulomb's law).
TEST(Imu, MeasuresFrictionInBodyAxes) {
  plant::SimulationSettings settings = empty_space();
  settings.ground.present = true;
  settings.ground.friction = 0.2;
  settings.imu.rate_hz = 500.0;
  plant::VehicleState start;
  start.velocity_ned = {1.0, 0.0, 0.0};
  start.q_ned_from_frd = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ());
  plant::PlantSimulation plant(kaylion(), settings, 1, start);
  const Vector3d expected_frd(0.0, 0.2 * plant::kGravity, -plant::kGravity);
  for (int i = 0; i < 200; ++i) {
    plant.step({});
    if (!plant.imu()) continue;
    ASSERT_LT((plant.imu()->specific_force_frd - expected_frd).norm(), 0.05) << i;
  }
}

TEST(Imu, IntegratesToTheVelocityChangeOfAnImpact) {
  plant::SimulationSettings settings = empty_space();
  settings.ground.present = true;
  settings.imu.rate_hz = 500.0;
  settings.imu.accelerometer_range = 1.0e6;
  plant::VehicleState start;
  start.position_ned.z() = -0.1;
  plant::PlantSimulation plant(kaylion(), settings, 1, start);
  double change = 0.0;
  for (int i = 0; i < 1000; ++i) {
    plant.step({});
    if (plant.imu()) change += (plant.imu()->specific_force_frd.z() + plant::kGravity) * 0.002;
  }
  EXPECT_TRUE(plant.on_ground());
  EXPECT_NEAR(change, 0.0, 1.0e-9);  // from rest to rest
}

}  // namespace swiftlet::tests::imu_test
