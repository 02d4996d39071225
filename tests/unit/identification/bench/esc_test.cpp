#include "swiftlet/identification/bench/esc.hpp"

#include <gtest/gtest.h>

#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::esc_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;
using tests::refused;

TEST(EscExperiment, FindsEq9WithoutNoise) {
  const Experiment found = identify_esc(*bench_of(kaylion(), 0.0).esc, {});
  EXPECT_NEAR(found.estimate("esc.gain").value, 0.9205, 1e-8);
  EXPECT_NEAR(found.estimate("esc.offset").value, 0.6472, 1e-7);
  EXPECT_NEAR(found.r_squared, 1.0, 1e-12);
  EXPECT_TRUE(found.outliers.empty());
  EXPECT_TRUE(found.warnings.empty());
}

TEST(EscExperiment, ReportsThatEq9FitsBetterThanTheNaiveRatio) {
  const EscData data = *bench_of(kaylion(), 0.005).esc;
  const Experiment found = identify_esc(data, {});
  EXPECT_TRUE(contains(found.findings, "Eq. (9) fits better"));
  EXPECT_GT(naive_esc(data, {}).residual_sd_v, 0.3);
}

TEST(EscExperiment, ReportsThatTheNaiveRatioFitsBetter) {
  EscData data = *bench_of(kaylion(), 0.005, 2).esc;
  for (std::size_t i = 0; i < data.throttle.size(); ++i)
    data.motor_voltage_v[i] = 0.95 * data.supply_voltage_v[i] * data.throttle[i];
  const Experiment found = identify_esc(data, {});
  EXPECT_TRUE(contains(found.findings, "the naive one fits better"));
  EXPECT_NEAR(naive_esc(data, {}).factor, 0.95, 1e-12);
  EXPECT_TRUE(contains(found.warnings, "not quite a straight line"));
}

TEST(EscExperiment, ListsAnOutlier) {
  EscData data = *bench_of(kaylion(), 0.005).esc;
  data.motor_voltage_v[17] = 0.3;
  const Experiment found = identify_esc(data, {});
  EXPECT_EQ(found.outliers, std::vector<std::size_t>{17});
  EXPECT_NEAR(found.estimate("esc.gain").value, 0.9205, 0.02);
}

TEST(EscExperiment, RefusesReadingsNoEscCanProduce) {
  const EscData good = *bench_of(kaylion(), 0.005).esc;
  EscData bad = good;
  bad.motor_voltage_v = tests::times(good.motor_voltage_v, 1000.0);  // mV instead of V
  EXPECT_NE(refused([&] { identify_esc(bad, {}); }).find("an ESC cannot raise its supply"),
            std::string::npos);
  bad = good;
  bad.throttle = tests::times(good.throttle, 100.0);  // percent instead of fractions
  EXPECT_NE(refused([&] { identify_esc(bad, {}); }).find("throttle: is 10, must be 0 to 1"),
            std::string::npos)
      << refused([&] { identify_esc(bad, {}); });
  bad = good;
  bad.throttle = tests::times(good.throttle, 0.01);  // fractions divided by 100
  EXPECT_NE(refused([&] { identify_esc(bad, {}); }).find("throttle: at full throttle the ESC would give 9.6"),
            std::string::npos)
      << refused([&] { identify_esc(bad, {}); });
  bad = good;
  bad.throttle.assign(good.throttle.size(), 0.5);
  EXPECT_EQ(refused([&] { identify_esc(bad, {}); }), "throttle: is 0.5 in all 45 rows, must vary");
}

}  // namespace swiftlet::identification::esc_test
