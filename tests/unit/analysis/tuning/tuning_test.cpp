// The curves and figures of `swiftlet tune plot`.
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/tuning/tuning_figure.hpp"
#include "swiftlet/analysis/tuning/tuning_table.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::analysis::tuning_test {

control::ControlSettings settings(const std::string& name) {
  return io::load_control_settings(tests::in_source("config/control/") + name + ".yaml");
}
plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }

// At the plotted crossover the magnitude is 0 dB, and the phase is the margin above -180 degrees.
TEST(TuningStudy, CurvesAgreeWithTheMargins) {
  const TuningStudy study =
      study_tuning(kaylion(), {settings("motor_lag"), settings("paper")}, {1e-3, 3e-3, "x"});
  for (const SettingsStudy& one : study.settings) {
    for (std::size_t i = 0; i < one.loops.size(); ++i) {
      const LoopStudy& loop = one.loops[i];
      ASSERT_TRUE(loop.stable);
      const auto at = std::lower_bound(loop.omega.begin(), loop.omega.end(), loop.crossover);
      ASSERT_NE(at, loop.omega.end());
      const auto k = static_cast<std::size_t>(at - loop.omega.begin());
      const double part =
          std::log(loop.crossover / loop.omega[k - 1]) / std::log(loop.omega[k] / loop.omega[k - 1]);
      const auto between = [&](const std::vector<double>& values) {
        return values[k - 1] + part * (values[k] - values[k - 1]);
      };
      EXPECT_NEAR(between(loop.magnitude_db), 0.0, 0.02) << one.name << " " << control::kFlownLoopNames[i];
      EXPECT_NEAR(between(loop.phase_deg) + 180.0, loop.margins.phase_deg, 0.2)
          << one.name << " " << control::kFlownLoopNames[i];
      EXPECT_NEAR(loop.margins.delay_s, loop.margins.phase_deg * M_PI / 180.0 / loop.crossover, 1e-9)
          << one.name << " " << control::kFlownLoopNames[i];
    }
  }
}

TEST(TuningStudy, StepFiguresAreThoseOfTheCurve) {
  const TuningStudy study = study_tuning(kaylion(), {settings("motor_lag")}, {});
  const LoopStudy& roll = study.settings.front().loops[0];
  const double most = *std::max_element(roll.response.begin(), roll.response.end());
  EXPECT_NEAR(roll.step.overshoot, most - 1.0, 1e-12);
  EXPECT_GT(roll.step.rise_time_s, 0.05);
  EXPECT_LT(roll.step.rise_time_s, roll.step.settling_time_s);
  EXPECT_NEAR(roll.response.back(), 1.0, 0.01);
}

TEST(TuningStudy, MarksAnUnstableLoop) {
  control::ControlSettings unstable = settings("motor_lag");
  unstable.name = "unstable";
  unstable.position.y.omega_n = 6.0;
  unstable.position.y.zeta = 0.2;
  const TuningStudy study = study_tuning(kaylion(), {settings("motor_lag"), unstable}, {});
  const LoopStudy& y = study.settings[1].loops[4];
  EXPECT_FALSE(y.stable);
  EXPECT_LT(y.time_s.size(), study.settings[0].loops[4].time_s.size()) << "the curve ends where it diverges";
  EXPECT_NE(tuning_table(study).find("unstable\n"), std::string::npos);
  const auto json = nlohmann::json::parse(tuning_json(study));
  EXPECT_EQ(json["settings"][1]["loops"]["y"]["stable"], false);
  EXPECT_TRUE(json["settings"][1]["loops"]["y"]["rise_time_s"].is_null());
}

TEST(TuningTable, NamesItsUnitsAndItsDelay) {
  const TuningStudy study = study_tuning(kaylion(), {settings("motor_lag")}, {1e-3, 5e-4, "flights/A"});
  const std::string table = tuning_table(study);
  EXPECT_NE(table.find("delay 1.50 ms (1.00 ms of sampling, 0.50 ms to the actuator, measured in flights/A)"),
            std::string::npos)
      << table;
  for (const char* unit : {"rad/s", "deg", "dB", "ms", "%"})
    EXPECT_NE(table.find(unit), std::string::npos) << unit;
}

TEST(TuningFigure, HasAStepAndABodePanelForEachLoop) {
  const TuningStudy study = study_tuning(kaylion(), {settings("motor_lag"), settings("paper")}, {});
  const plot::Figure figure = tuning_figure(study);
  ASSERT_EQ(figure.panels.size(), 18U);
  for (std::size_t loop = 0; loop < 6; ++loop) {
    const plot::Panel& step = figure.panels[3 * loop];
    ASSERT_EQ(step.series.size(), 3U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(step.series[i + 1].label, study.settings[i].name);
      ASSERT_EQ(step.series[i + 1].points.size(), study.settings[i].loops[loop].response.size());
      EXPECT_EQ(step.series[i + 1].points[100].y, study.settings[i].loops[loop].response[100]);
    }
    EXPECT_EQ(step.labels.size(), 2U);
  }
}

}  // namespace swiftlet::analysis::tuning_test
