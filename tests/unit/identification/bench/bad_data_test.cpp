// Data that every experiment refuses.
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/identification/bench/steady_motor.hpp"
#include "swiftlet/identification/fitting/checks.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::bad_data_test {

using tests::bench_of;
using tests::kaylion;
using tests::refused;

TEST(BadBenchData, RefusesTooFewRows) {
  EXPECT_EQ(refused([] {
              identify_steady_motor({{1.0, 2.0, 3.0}, {500.0, 900.0, 1200.0}}, {});
            }),
            "has 3 rows, must have at least 6");
}

TEST(BadBenchData, RefusesNaNAndNamesItsRow) {
  SteadyMotorData data = *bench_of(kaylion(), 0.005).steady_motor;
  data.speed_rad_s[4] = std::numeric_limits<double>::quiet_NaN();
  try {
    identify_steady_motor(data, {});
    FAIL() << "expected BadData";
  } catch (const BadData& fault) {
    EXPECT_STREQ(fault.what(), "speed: is not a finite number, must be");
    EXPECT_EQ(fault.row(), 4U);
  }
}

TEST(BadBenchData, RefusesAConstantColumnEvenWithOneOutlier) {
  SteadyMotorData data = *bench_of(kaylion(), 0.005).steady_motor;
  data.speed_rad_s.assign(data.speed_rad_s.size(), 1500.0);
  EXPECT_EQ(refused([&] { identify_steady_motor(data, {}); }),
            "speed: is 1500 rad/s in all 40 rows, must vary");
  data.speed_rad_s[9] = 9000.0;
  EXPECT_NE(refused([&] { identify_steady_motor(data, {}); }).find("must vary"), std::string::npos);
}

TEST(BadBenchData, RefusesColumnsOfUnequalLength) {
  EXPECT_EQ(refused([] {
              identify_steady_motor({{1, 2, 3, 4, 5, 6}, {1, 2, 3}}, {});
            }),
            "speed: has 3 values, must have 6");
}

TEST(BadBenchData, RefusesValuesInAWrongUnit) {
  SteadyMotorData data = *bench_of(kaylion(), 0.005).steady_motor;
  data.motor_voltage_v = tests::times(data.motor_voltage_v, 1000.0);
  EXPECT_NE(refused([&] { identify_steady_motor(data, {}); }).find("is the unit right?"), std::string::npos);
}

TEST(BadBenchData, RefusesABenchWithoutExperiments) {
  EXPECT_THROW(identify_bench({}, kaylion()), BenchError);
}

}  // namespace swiftlet::identification::bad_data_test
