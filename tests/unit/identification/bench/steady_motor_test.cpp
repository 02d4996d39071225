#include "swiftlet/identification/bench/steady_motor.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::steady_motor_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;

TEST(SteadyMotorExperiment, FindsEq22WithoutNoise) {
  const Experiment found = identify_steady_motor(*bench_of(kaylion(), 0.0).steady_motor, {});
  EXPECT_NEAR(found.estimate("motor.k2").value / 1.020e-3, 1.0, 1e-8);
  EXPECT_NEAR(found.estimate("motor.k3").value / 2.817e-7, 1.0, 1e-8);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(SteadyMotorExperiment, IsUnbiasedWithANoisyTachometer) {
  // GIVEN 4,000 readings whose speeds are noisy and whose voltages are not
  SteadyMotorData data;
  math::RandomStream random(1, 1);
  for (int i = 0; i < 4000; ++i) {
    const double voltage = 0.4 + 3.6 * i / 3999.0;
    data.motor_voltage_v.push_back(voltage);
    data.speed_rad_s.push_back(plant::steady_speed_from_voltage(kaylion().motor, voltage) +
                               60.0 * random.normal());
  }
  // WHEN the noise of both instruments is given THEN K3 is right; least squares on v_a alone is far off
  Instruments known;
  known.motor_voltage_v = 1e-4;
  known.speed_rad_s = 60.0;
  const ParameterEstimate k3 = identify_steady_motor(data, known).estimate("motor.k3");
  EXPECT_LT(std::abs(k3.value - 2.817e-7), 1.5 * k3.half_width);
  EXPECT_LT(k3.half_width, 0.02 * k3.value);
  known.speed_rad_s = 1e-6;
  known.motor_voltage_v = 1.0;
  const ParameterEstimate naive = identify_steady_motor(data, known).estimate("motor.k3");
  EXPECT_GT(std::abs(naive.value - 2.817e-7), 2.0 * naive.half_width);
}

TEST(SteadyMotorExperiment, WarnsOfCoulombFriction) {
  SteadyMotorData data = *bench_of(kaylion(), 0.003).steady_motor;
  for (double& voltage : data.motor_voltage_v) voltage += 0.3;
  EXPECT_TRUE(contains(identify_steady_motor(data, {}).warnings, "Coulomb friction"));
  EXPECT_FALSE(
      contains(identify_steady_motor(*bench_of(kaylion(), 0.003).steady_motor, {}).warnings, "Coulomb"));
}

TEST(SteadyMotorExperiment, WarnsWhenK2AndK3AreNotSeparable) {
  SteadyMotorData data;
  math::RandomStream random(3, 1);
  for (int i = 0; i < 30; ++i) {
    data.speed_rad_s.push_back(1500.0 + 3.0 * i + 2.0 * random.normal());
    data.motor_voltage_v.push_back(plant::voltage_from_steady_speed(kaylion().motor, 1500.0 + 3.0 * i) +
                                   0.003 * random.normal());
  }
  EXPECT_TRUE(contains(identify_steady_motor(data, {}).warnings, "these data barely separate K2 and K3"));
}

}  // namespace swiftlet::identification::steady_motor_test
