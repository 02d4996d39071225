#include "swiftlet/identification/bench/thrust_torque.hpp"

#include <gtest/gtest.h>

#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::thrust_torque_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;
using tests::refused;

TEST(ThrustTorqueExperiment, FindsEq25And26WithoutNoise) {
  const ThrustTorque found = identify_thrust_torque(*bench_of(kaylion(), 0.0).thrust_torque, {});
  EXPECT_NEAR(found.thrust->estimates[0].value / 3.7901e-8, 1.0, 1e-9);
  EXPECT_NEAR(found.torque->estimates[0].value / 1.8623e-10, 1.0, 1e-9);
  EXPECT_TRUE(found.thrust->warnings.empty());
}

TEST(ThrustTorqueExperiment, IdentifiesFromThrustAlone) {
  ThrustTorqueData data = *bench_of(kaylion(), 0.005).thrust_torque;
  data.torque_n_m.clear();
  const ThrustTorque found = identify_thrust_torque(data, {});
  EXPECT_TRUE(found.thrust);
  EXPECT_FALSE(found.torque);
  data.thrust_n.clear();
  EXPECT_NE(refused([&] { identify_thrust_torque(data, {}); }).find("neither thrust nor torque"),
            std::string::npos);
}

TEST(ThrustTorqueExperiment, WarnsOfASensorThatWasNotZeroed) {
  ThrustTorqueData data = *bench_of(kaylion(), 0.005).thrust_torque;
  for (double& thrust : data.thrust_n) thrust += 0.01;
  EXPECT_TRUE(contains(identify_thrust_torque(data, {}).thrust->warnings, "was the sensor zeroed"));
}

// GIVEN a photo-interrupter that counts both blades
TEST(ThrustTorqueExperiment, ListsSpeedsThatWereCountedTwice) {
  ThrustTorqueData data = *bench_of(kaylion(), 0.005).thrust_torque;
  for (const std::size_t row : {5U, 14U, 30U}) data.speed_rad_s[row] *= 2.0;
  const ThrustTorque found = identify_thrust_torque(data, {});
  EXPECT_EQ(found.thrust->outliers, (std::vector<std::size_t>{5, 14, 30}));
  EXPECT_NEAR(found.thrust->estimates[0].value / 3.7901e-8, 1.0, 0.01);
}

TEST(ThrustTorqueExperiment, RefusesGramsTakenForNewtons) {
  const ThrustTorqueData good = *bench_of(kaylion(), 0.005).thrust_torque;
  ThrustTorqueData bad = good;
  bad.thrust_n = tests::times(good.thrust_n, 1000.0 / 9.80665);
  EXPECT_NE(refused([&] { identify_thrust_torque(bad, {}); }).find("m times the thrust"), std::string::npos);
  bad = good;
  bad.torque_n_m = tests::times(good.torque_n_m, 1000.0);
  EXPECT_NE(refused([&] { identify_thrust_torque(bad, {}); }).find("m times the thrust"), std::string::npos);
}

}  // namespace swiftlet::identification::thrust_torque_test
