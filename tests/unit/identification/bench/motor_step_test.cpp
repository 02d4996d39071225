#include "swiftlet/identification/bench/motor_step.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/motor.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::motor_step_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;
using tests::refused;

plant::Vehicle physical() {
  plant::Vehicle vehicle = kaylion();
  vehicle.motor.model = plant::MotorModel::kPhysical;
  return vehicle;
}

TEST(MotorStepExperiment, FindsTheReducedMotor) {
  const MotorStep found = identify_motor_step(*bench_of(kaylion(), 0.0).motor_step, kaylion(), 0.0);
  EXPECT_NEAR(found.reduced.estimates[0].value, 0.0821, 1e-6);
  EXPECT_NEAR(found.reading.value, 0.0821, 2e-4);
  EXPECT_FALSE(found.physical_fits_better);
  EXPECT_TRUE(found.decided);
}

TEST(MotorStepExperiment, FindsThePhysicalMotorAndItsInertia) {
  const MotorStep found = identify_motor_step(*bench_of(physical(), 0.002).motor_step, physical(), 0.0);
  EXPECT_TRUE(found.physical_fits_better);
  EXPECT_TRUE(found.decided);
  EXPECT_NEAR(found.physical.estimates[0].value, 0.0821, found.physical.estimates[0].half_width * 1.5);
  EXPECT_LT(found.physical.estimates[0].half_width, 5e-4);
  EXPECT_NEAR(found.reading.value, 0.0821, 1.5 * found.reading.half_width);
  EXPECT_NEAR(found.rotor_inertia.value / plant::motor_dynamics(physical()).rotor_inertia, 1.0, 0.005);
}

TEST(MotorStepExperiment, FindsTheStepAtAnySpeedAndTime) {
  // A step between two speeds at a non-sampled time: closed form of the reduced model.
  MotorStepData data;
  for (int i = 0; i < 500; ++i) {
    const double time = 1000.0 + 1e-3 * i;
    const double elapsed = time - 1000.0523;
    data.time_s.push_back(time);
    data.speed_rad_s.push_back(elapsed <= 0.0 ? 900.0 : 1600.0 - 700.0 * std::exp(-elapsed / 0.05));
  }
  const MotorStep found = identify_motor_step(data, kaylion(), 0.0);
  EXPECT_NEAR(found.reduced.estimates[0].value, 0.05, 1e-5);
  EXPECT_NEAR(found.step_time_s, 1000.0523, 1e-5);
  EXPECT_NEAR(found.reading.value, 0.05, 5e-4);
}

TEST(MotorStepExperiment, PropagatesTheErrorOfTheTorqueFactor) {
  const MotorStepData data = *bench_of(physical(), 0.005).motor_step;
  const ParameterEstimate without = identify_motor_step(data, physical(), 0.0).rotor_inertia;
  const ParameterEstimate with = identify_motor_step(data, physical(), 0.05).rotor_inertia;
  EXPECT_NEAR(with.standard_error / with.value, std::hypot(0.05, without.standard_error / without.value),
              1e-9);
}

TEST(MotorStepExperiment, ListsSpikesOfTheTachometer) {
  MotorStepData data = *bench_of(kaylion(), 0.005).motor_step;
  for (const std::size_t row : {40U, 130U, 300U, 301U})
    data.speed_rad_s[row] *= 2.0, data.speed_rad_s[row] += 300.0;
  const MotorStep found = identify_motor_step(data, kaylion(), 0.0);
  EXPECT_EQ(found.reduced.outliers, (std::vector<std::size_t>{40, 130, 300, 301}));
  EXPECT_NEAR(found.reduced.estimates[0].value, 0.0821, 1e-3);
}

TEST(MotorStepExperiment, WarnsOfARecordThatEndsEarly) {
  MotorStepData data = *bench_of(kaylion(), 0.005).motor_step;
  for (std::vector<double>* column : {&data.time_s, &data.speed_rad_s, &data.motor_voltage_v})
    column->resize(270);
  EXPECT_TRUE(
      contains(identify_motor_step(data, kaylion(), 0.0).reduced.warnings, "time constants after the step"));
}

TEST(MotorStepExperiment, RefusesRecordsWithoutAValidStep) {
  const MotorStepData good = *bench_of(kaylion(), 0.005).motor_step;
  const auto refusal = [&](const auto& spoil) {
    MotorStepData bad = good;
    spoil(bad);
    return refused([&] { identify_motor_step(bad, kaylion(), 0.0); });
  };
  EXPECT_NE(refusal([](MotorStepData& d) { d.time_s = tests::times(d.time_s, 1000.0); }).find("tau_m = 8"),
            std::string::npos);  // ms instead of s
  EXPECT_NE(refusal([](MotorStepData& d) { d.time_s[7] = d.time_s[3]; }).find("must rise"),
            std::string::npos);
  EXPECT_NE(refusal([](MotorStepData& d) {
              for (double& speed : d.speed_rad_s) speed = 2000.0 - speed;
            }).find("must step up"),
            std::string::npos);
  EXPECT_NE(refusal([](MotorStepData& d) {
              d.speed_rad_s.assign(d.speed_rad_s.size(), 1500.0);
            }).find("is 1500 rad/s in all"),
            std::string::npos);
  EXPECT_NE(refusal([](MotorStepData& d) {
              for (std::vector<double>* column : {&d.time_s, &d.speed_rad_s, &d.motor_voltage_v})
                column->erase(column->begin(), column->begin() + 99);
            }).find("rows before the step"),
            std::string::npos);
}

}  // namespace swiftlet::identification::motor_step_test
