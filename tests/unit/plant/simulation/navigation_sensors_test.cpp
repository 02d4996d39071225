// Barometer, magnetometer and GPS: signs, statistics, schedule.
#include "swiftlet/plant/simulation/navigation_sensors.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/atmosphere.hpp"

namespace swiftlet::tests::navigation_sensors_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::Barometer;
using plant::BarometerSample;
using plant::Gps;
using plant::GpsSample;
using plant::Magnetometer;
using plant::NavigationSamples;
using plant::NavigationSensors;

plant::SimulationSettings without_errors() {
  plant::SimulationSettings settings;
  settings.barometer.noise_pa = settings.barometer.bias_sigma_pa = settings.barometer.bias_walk_pa = 0.0;
  settings.magnetometer.noise_gauss = settings.magnetometer.bias_sigma_gauss = 0.0;
  settings.gps.position_noise_ned.setZero();
  settings.gps.position_drift_ned.setZero();
  settings.gps.velocity_noise_ned.setZero();
  return settings;
}

// ISO 2533 tabulates 1013.25, 954.61 and 898.76 hPa at 0, 500 and 1000 m, and 15, 11.75 and 8.5 deg C.
TEST(Barometer, MatchesTheStandardAtmosphere) {
  Barometer barometer(without_errors().barometer, 1);
  const double tabulated[][3] = {{0.0, 101325.0, 15.0}, {500.0, 95461.0, 11.75}, {1000.0, 89876.0, 8.5}};
  for (const auto& [altitude_m, pressure_pa, temperature_c] : tabulated) {
    const BarometerSample sample = barometer.sample(altitude_m);
    EXPECT_NEAR(sample.pressure_pa, pressure_pa, 1.5);
    EXPECT_NEAR(sample.temperature_c, temperature_c, 0.01);
    EXPECT_NEAR(sample.altitude_m, altitude_m, 1e-6);
  }
}

TEST(Barometer, PressureFallsWithHeight) {
  Barometer barometer(without_errors().barometer, 1);
  const double per_metre = barometer.sample(488.0).pressure_pa - barometer.sample(489.0).pressure_pa;
  EXPECT_NEAR(per_metre, 11.4, 0.1);  // density times gravity: 1.168 kg/m^3 * g
}

TEST(Barometer, NoiseAndBiasHaveTheirStandardDeviations) {
  plant::BarometerSettings settings = without_errors().barometer;
  settings.noise_pa = 3.0;
  settings.bias_sigma_pa = 40.0;
  constexpr int kRuns = 2000;
  constexpr int kSamples = 20;
  double bias_square = 0.0;
  double noise_square = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Barometer barometer(settings, seed);
    double sum = 0.0;
    double square = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double error = barometer.sample(0.0).pressure_pa - plant::atmosphere::kSeaLevelPressure_pa;
      sum += error;
      square += error * error;
    }
    const double mean = sum / kSamples;
    bias_square += mean * mean / kRuns;
    noise_square += (square - kSamples * mean * mean) / (kSamples - 1) / kRuns;
  }
  EXPECT_NEAR(std::sqrt(noise_square), 3.0, 0.05);
  EXPECT_NEAR(std::sqrt(bias_square), 40.0, 2.0);  // its standard error is 0.6
}

TEST(Barometer, BiasWalksWithTheRootOfTime) {
  plant::BarometerSettings settings = without_errors().barometer;
  settings.bias_walk_pa = 0.5;
  settings.rate_hz = 10.0;
  constexpr int kRuns = 1000;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Barometer barometer(settings, seed);
    double error = 0.0;
    for (int i = 0; i < 160; ++i)  // 16 s
      error = barometer.sample(0.0).pressure_pa - plant::atmosphere::kSeaLevelPressure_pa;
    square += error * error / kRuns;
  }
  EXPECT_NEAR(std::sqrt(square), 0.5 * 4.0, 0.15);
}

TEST(Magnetometer, FieldTurnsAgainstTheVehicle) {
  const plant::SimulationSettings settings = without_errors();
  Magnetometer magnetometer(settings.magnetometer, Vector3d(0.2, 0.0, 0.4), 1);
  EXPECT_TRUE(magnetometer.sample(Quaterniond::Identity()).isApprox(Vector3d(0.2, 0.0, 0.4)));
  // Nose to the east: north is to the left.
  const Quaterniond east(AngleAxisd(M_PI / 2.0, Vector3d::UnitZ()));
  EXPECT_TRUE(magnetometer.sample(east).isApprox(Vector3d(0.0, -0.2, 0.4)));
  // Nose up: down is backwards, north is down.
  const Quaterniond up(AngleAxisd(M_PI / 2.0, Vector3d::UnitY()));
  EXPECT_TRUE(magnetometer.sample(up).isApprox(Vector3d(-0.4, 0.0, 0.2)));
}

TEST(Magnetometer, NoiseAndBiasHaveTheirStandardDeviations) {
  plant::MagnetometerSettings settings = without_errors().magnetometer;
  settings.noise_gauss = 0.002;
  settings.bias_sigma_gauss = 0.005;
  double bias_square = 0.0;
  double noise_square = 0.0;
  constexpr int kRuns = 1000;
  constexpr int kSamples = 20;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Magnetometer magnetometer(settings, Vector3d::Zero(), seed);
    bias_square += magnetometer.bias().squaredNorm() / (3 * kRuns);
    for (int i = 0; i < kSamples; ++i) {
      const Vector3d noise = magnetometer.sample(Quaterniond::Identity()) - magnetometer.bias();
      noise_square += noise.squaredNorm() / (3 * kRuns * kSamples);
    }
  }
  EXPECT_NEAR(std::sqrt(noise_square), 0.002, 2e-5);
  EXPECT_NEAR(std::sqrt(bias_square), 0.005, 2e-4);
}

TEST(Gps, MeasuresPositionAndVelocity) {
  const plant::SimulationSettings settings = without_errors();
  Gps gps(settings.gps, settings.site, 1);
  const GpsSample sample = gps.sample({100.0, -50.0, -20.0}, {1.0, -2.0, 0.5});
  const Eigen::Vector2d north_east =
      math::north_east_of({settings.site.latitude_deg, settings.site.longitude_deg}, sample.position);
  EXPECT_LT((north_east - Eigen::Vector2d(100.0, -50.0)).norm(), 1e-6);
  EXPECT_GT(sample.position.latitude_deg, settings.site.latitude_deg);
  EXPECT_LT(sample.position.longitude_deg, settings.site.longitude_deg);
  EXPECT_DOUBLE_EQ(sample.altitude_m, settings.site.altitude_m + 20.0);
  EXPECT_EQ(sample.velocity_ned, Vector3d(1.0, -2.0, 0.5));
}

TEST(Gps, ErrorsHaveTheirStandardDeviationsAndCorrelation) {
  plant::SimulationSettings settings = without_errors();
  settings.gps.position_drift_ned = Vector3d(0.3, 0.4, 0.6);
  settings.gps.velocity_noise_ned = Vector3d(0.05, 0.05, 0.1);
  settings.gps.drift_time_constant_s = 2.0;
  Gps gps(settings.gps, settings.site, 3);
  constexpr int kSamples = 200'000;  // 10,000 time constants
  constexpr int kLag = 20;           // one of them
  std::vector<double> vertical;
  double velocity_square = 0.0;
  double square = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const GpsSample sample = gps.sample(Vector3d::Zero(), Vector3d::Zero());
    vertical.push_back(settings.site.altitude_m - sample.altitude_m);
    square += vertical.back() * vertical.back() / kSamples;
    velocity_square += sample.velocity_ned.z() * sample.velocity_ned.z() / kSamples;
  }
  double lagged = 0.0;
  for (std::size_t i = kLag; i < vertical.size(); ++i) lagged += vertical[i] * vertical[i - kLag] / kSamples;
  EXPECT_NEAR(std::sqrt(square), 0.6, 0.02);
  EXPECT_NEAR(lagged / square, std::exp(-1.0), 0.03);
  EXPECT_NEAR(std::sqrt(velocity_square), 0.1, 0.001);
  const GpsSample sample = gps.sample(Vector3d::Zero(), Vector3d::Zero());
  EXPECT_DOUBLE_EQ(sample.horizontal_accuracy_m, 0.5);
  EXPECT_DOUBLE_EQ(sample.vertical_accuracy_m, 0.6);
}

struct Counts {
  int barometer = 0, magnetometer = 0, gps = 0;
};

Counts samples_of_a_second(const plant::SimulationSettings& settings) {
  NavigationSensors sensors(settings, 1);
  Counts counts;
  plant::TruthSample truth;
  for (int i = 0; i < 500; ++i) {
    truth.stamp_ns = i * 2'000'000;
    const NavigationSamples samples = sensors.sample(truth);
    counts.barometer += samples.barometer.has_value() ? 1 : 0;
    counts.magnetometer += samples.magnetic_field_frd.has_value() ? 1 : 0;
    counts.gps += samples.gps.has_value() ? 1 : 0;
  }
  return counts;
}

TEST(NavigationSensors, SampleAtTheirRates) {
  plant::SimulationSettings settings;
  settings.barometer.rate_hz = 30.0;  // not a divisor of the rate of the IMU
  Counts counts = samples_of_a_second(settings);
  EXPECT_EQ(counts.barometer, 30);
  EXPECT_EQ(counts.magnetometer, 100);
  EXPECT_EQ(counts.gps, 10);
  settings.gps.rate_hz = 0.0;
  EXPECT_EQ(samples_of_a_second(settings).gps, 0);
}

TEST(NavigationSensors, RepeatWithTheirSeed) {
  const plant::SimulationSettings settings;
  NavigationSensors first(settings, 4);
  NavigationSensors same(settings, 4);
  NavigationSensors other(settings, 5);
  const plant::TruthSample truth;
  const double pressure_pa = first.sample(truth).barometer->pressure_pa;
  EXPECT_EQ(pressure_pa, same.sample(truth).barometer->pressure_pa);
  EXPECT_NE(pressure_pa, other.sample(truth).barometer->pressure_pa);
}

}  // namespace swiftlet::tests::navigation_sensors_test
