// The commands of docs/tuning.md: gains that change in flight, and the plot of control settings.
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/text_file.hpp"
#include "tests/support/online_flight.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

using Replacements = std::vector<std::pair<std::string, std::string>>;

std::string replaced(const std::string& file, const Replacements& replacements) {
  std::string text = io::read_text_file(in_source(file));
  for (const auto& [from, to] : replacements) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

// That do not learn the weight at lift-off.
std::string settings_file(Replacements replacements) {
  replacements.push_back({"learn_lift: true", "learn_lift: false"});
  return replaced("config/control/motor_lag.yaml", replacements);
}

// Without integral and disturbance observer, so that the vehicle sags under a weight that the controller does
// not know; z with half the bandwidth.
const Replacements kSagging = {{"name: motor_lag", "name: sagging"},
                               {"z: {omega_n: 3.0", "z: {omega_n: 2.0"},
                               {"integral_limit_m_s2: 2.0", "integral_limit_m_s2: 0.0"},
                               {"limit_m_s2: 3.0", "limit_m_s2: 0.0"}};
constexpr double kSaggingP = 5.6;  // omega^2 + 2 zeta omega pole

// A vehicle that is 5 % heavier than in the controller's file.
class Tuning : public OnlineFlight {
 protected:
  static constexpr double kHeight_m = 0.6;
  static constexpr double kSag_m = 0.05 * 9.81 / kSaggingP;

  void SetUp() override {
    start("10",
          {"--vehicle",
           folder_.write("heavy.yaml", replaced("config/vehicles/kaylion.yaml",
                                                {{"mass: {value: 0.040", "mass: {value: 0.042"}}))},
          {"--control", usual_});
  }
  bool hovers_at(double height_m) const {
    return reaches("height", [height_m](const VehicleState& now) {
      return std::abs(-now.position_ned_m.z() - height_m) < 0.01 && std::abs(now.velocity_ned_m_s.z()) < 0.01;
    });
  }
  void expect_change_refused(const std::string& file, const std::string& reason) const {
    const ProgramResult result = swiftlet({"set", "control", file});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors, "swiftlet: set control: " + reason + "\n");
  }

  const std::string usual_ = folder_.write("usual.yaml", settings_file({}));
};

TEST_F(Tuning, ChangesTheGainsInHoverOrSaysWhyNot) {
  take_off();
  ASSERT_TRUE(hovers_at(kHeight_m));
  const json before = status().at("settings");
  EXPECT_EQ(before.at("name"), "motor_lag");
  EXPECT_NEAR(before.at("gains").at("position_p_per_s2")[2].get<double>(), 11.4, 1e-9);

  expect_change_refused(
      folder_.write("fast.yaml", settings_file({{"max_speed_m_s: 2.0", "max_speed_m_s: 3.0"}})),
      "limits.max_speed_m_s: cannot change in flight: is 2.0, the file has 3.0");
  expect_change_refused(
      folder_.write("shaky.yaml",
                    settings_file({{"x: {omega_n: 2.0, zeta: 1.0", "x: {omega_n: 6.0, zeta: 0.2"}})),
      "position.x: with the rotor lag the loop is unstable");
  const std::string broken = folder_.write("broken.yaml", settings_file({{"zeta: 1.0", "zeta: -1"}}));
  EXPECT_EQ(swiftlet({"set", "control", broken}).exit_code, 2);
  EXPECT_EQ(status().at("settings").at("name"), "motor_lag");

  const std::string sagging = folder_.write("sagging.yaml", settings_file(kSagging));
  const ProgramResult changed = swiftlet({"set", "control", sagging, "--ramp", "1", "--wait", "25"});
  EXPECT_EQ(changed.exit_code, 0) << changed.errors;
  EXPECT_EQ(changed.output, "set control: accepted by kl7\nset control: done\n");
  const json after = status();
  EXPECT_EQ(after.at("mode"), "holding");
  EXPECT_EQ(after.at("settings").at("name"), "sagging");
  EXPECT_EQ(after.at("settings").at("progress"), 1.0);
  EXPECT_NEAR(after.at("settings").at("gains").at("position_p_per_s2")[2].get<double>(), kSaggingP, 1e-9);
  EXPECT_TRUE(hovers_at(kHeight_m - kSag_m)) << "the vehicle sags by weight over gain";

  const ProgramResult restored = swiftlet({"set", "control", usual_, "--ramp", "1"});
  ASSERT_EQ(restored.exit_code, 0) << restored.errors;
  EXPECT_EQ(status().at("settings").at("gains"), before.at("gains"));
  EXPECT_TRUE(hovers_at(kHeight_m));

  ASSERT_TRUE(vehicle_.land(0.01).accepted());
  expect_change_refused(usual_, "cannot change the gains while landing");
}

TEST(TunePlot, DrawsSettingsOverEachOther) {
  const TemporaryFolder folder;
  const std::string soft = folder.write(
      "soft.yaml",
      settings_file({{"name: motor_lag", "name: soft"}, {"x: {omega_n: 2.0", "x: {omega_n: 1.0"}}));
  const std::string picture = folder.path() / "tuning.png";
  const ProgramResult result = run_program(
      "swiftlet", {"tune", "plot", "motor_lag", soft, "--delay", "0.004", "-o", picture, "--json"},
      folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json study = json::parse(result.output);
  EXPECT_EQ(study.at("delay").at("actuation_s"), 0.004);
  ASSERT_EQ(study.at("settings").size(), 2U);
  EXPECT_EQ(study.at("settings")[1].at("name"), "soft");
  EXPECT_GT(study.at("settings")[1].at("loops").at("x").at("rise_time_s"),
            study.at("settings")[0].at("loops").at("x").at("rise_time_s"));
  std::ifstream in(picture, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_GT(png.size(), 50'000U);
}

TEST(TunePlot, RefusesARecordWithoutAMeasuredDelay) {
  const TemporaryFolder folder;
  folder.write("report.json",
               R"({"imu_rate_hz": 500, "sense_to_actuate_us": {"p50": 0, "p99": 0, "max": 0}})");
  const ProgramResult result =
      run_program("swiftlet", {"tune", "plot", "motor_lag", "--flight", folder.path()}, folder.path());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("no latency was measured; fly in real time"), std::string::npos)
      << result.errors;
}

}  // namespace
}  // namespace swiftlet::tests
