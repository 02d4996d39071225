#include "swiftlet/ground/batch/gains_report.hpp"

#include <complex>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::ground::gains_report_test {

using Json = nlohmann::json;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr FlownDelays kDelays_s = {0.041, 0.042, kAny, 0.031, 0.032, 0.033};

control::ControlSettings settings(control::AttitudeModel model, double integral_pole) {
  control::ControlSettings s = io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
  s.attitude.model = model;
  s.attitude.roll = {Eigen::Vector3d(625.0, 2.0, 0.5), 4.0};
  s.attitude.pitch = {Eigen::Vector3d(500.0, 2.0, 0.5), 4.0};
  s.attitude.yaw = {Eigen::Vector3d(100.0, 2.0, 0.5), 4.0};
  s.position.x = s.position.y = s.position.z = {1.5, 0.8, 0.5, integral_pole};
  return s;
}

control::ControlDesign design(control::AttitudeModel model, double integral_pole) {
  const plant::Vehicle vehicle = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  return control::design(vehicle, settings(model, integral_pole));
}

TEST(GainsJson, ListsEveryAttitudeAxisWithItsModel) {
  for (const control::AttitudeModel model :
       {control::AttitudeModel::kDoubleIntegrator, control::AttitudeModel::kMotorLag}) {
    const bool lag = model == control::AttitudeModel::kMotorLag;
    const control::ControlDesign d = design(model, 0.0);
    const Json out = Json::parse(gains_json(d, {}, kDelays_s, "kaylion", "test"));
    EXPECT_EQ(out["vehicle"], "kaylion");
    EXPECT_EQ(out["control"], "test");
    struct Axis {
      const char* name;
      double q;
      const decltype(d.roll)& design;
    };
    for (const Axis& wanted :
         {Axis{"roll", 625.0, d.roll}, {"pitch", 500.0, d.pitch}, {"yaw", 100.0, d.yaw}}) {
      const Json& axis = out["attitude"][wanted.name];
      EXPECT_EQ(axis["model"], lag ? "motor_lag" : "double_integrator");
      EXPECT_EQ(axis["q"], lag ? Json({wanted.q, 2.0, 0.5}) : Json({wanted.q, 2.0}));
      EXPECT_EQ(axis["r"], 4.0);
      ASSERT_EQ(axis["k"].size(), lag ? 3U : 2U);
      for (std::size_t i = 0; i < axis["k"].size(); ++i) {
        EXPECT_EQ(axis["k"][i], wanted.design.k[static_cast<Eigen::Index>(i)]);
      }
      ASSERT_EQ(axis["poles"].size(), axis["k"].size());
      for (std::size_t i = 0; i < axis["poles"].size(); ++i) {
        EXPECT_EQ(axis["poles"][i], Json({wanted.design.poles[i].real(), wanted.design.poles[i].imag()}));
      }
      EXPECT_EQ(axis["poles_with_motor_lag"].size(), 3U);
      EXPECT_EQ(axis["phase_margin_deg"], wanted.design.phase_margin_deg);
    }
  }
}

TEST(GainsJson, ListsEq49AndTheIntegralForm) {
  for (const double integral_pole : {0.0, 0.4}) {
    const Json out = Json::parse(
        gains_json(design(control::AttitudeModel::kMotorLag, integral_pole), {}, kDelays_s, "v", "c"));
    for (const char* name : {"x", "y", "z"}) {
      const Json& axis = out["position"][name];
      EXPECT_EQ(axis["omega_n"], 1.5);
      EXPECT_EQ(axis["zeta"], 0.8);
      EXPECT_EQ(axis["epsilon"], 0.5);
      EXPECT_EQ(axis["integral_pole"], integral_pole);
      ASSERT_EQ(axis["f"].size(), 5U);
      const double expected[] = {9.0, 4.8, 1.0, -9.0, -4.8};
      for (std::size_t i = 0; i < 5; ++i) EXPECT_DOUBLE_EQ(axis["f"][i], expected[i]);
      ASSERT_EQ(axis.contains("integral_form"), integral_pole > 0.0);
      if (integral_pole > 0.0) {
        EXPECT_DOUBLE_EQ(axis["integral_form"]["k_v"], (2.0 * 0.8 * 1.5 + 0.4) / 0.5);
        EXPECT_DOUBLE_EQ(axis["integral_form"]["k_p"], (2.25 + 2.0 * 0.8 * 1.5 * 0.4) / 0.25);
        EXPECT_DOUBLE_EQ(axis["integral_form"]["k_i"], 0.4 * 2.25 / 0.125);
      }
    }
  }
}

TEST(GainsTable, HasARowForEveryAxis) {
  const std::string table =
      gains_table(design(control::AttitudeModel::kMotorLag, 0.0), {}, kDelays_s, "kaylion", "test");
  for (const char* axis : {"\n  roll ", "\n  pitch ", "\n  yaw ", "\n  x ", "\n  y ", "\n  z "}) {
    EXPECT_NE(table.find(axis), std::string::npos) << axis;
  }
}

TEST(Gains, HoldTheDelayOfEachLoopInFlight) {
  const control::ControlDesign d = design(control::AttitudeModel::kMotorLag, 0.0);
  const Json out = Json::parse(gains_json(d, {}, kDelays_s, "kaylion", "test"))["flown_delay_s"];
  EXPECT_EQ(out["roll"], 0.041);
  EXPECT_TRUE(out["yaw"].is_null()) << "stable with any";
  EXPECT_EQ(out["z"], 0.033);
  const std::string table = gains_table(d, {}, kDelays_s, "kaylion", "test");
  EXPECT_NE(table.find("\n  roll     41.0\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\n  yaw       any\n"), std::string::npos) << table;
}

}  // namespace swiftlet::ground::gains_report_test
