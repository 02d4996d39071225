// From a request for other settings to gains, or to a refusal by key.
#include "swiftlet/services/control/gain_designer.hpp"

#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/fixed_settings.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::services::gain_designer_test {

const std::string kFile = tests::in_source("config/control/motor_lag.yaml");

class GainDesignerTest : public testing::Test {
 protected:
  // The request for the settings of the file, after a replacement in its text.
  control::SettingsRequest request(const std::string& old_text = "", const std::string& new_text = "") const {
    std::string text = io::read_text_file(kFile);
    if (!old_text.empty()) text.replace(text.find(old_text), old_text.size(), new_text);
    return control::settings_request(io::parse_control_settings(text, "mine.yaml"),
                                     io::parse_fixed_settings(text, "mine.yaml"), 2.0);
  }
  std::string refusal(const control::SettingsRequest& asked) {
    return designer_.design(asked, designer_.initial(), change_).reason;
  }

  GainDesigner designer_{io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
                         io::load_control_settings(kFile), io::load_fixed_settings(kFile)};
  control::GainChange change_;
};

TEST_F(GainDesignerTest, DesignsTheGainsOfTheRequest) {
  EXPECT_EQ(refusal(request("x: {omega_n: 2.0", "x: {omega_n: 1.0")), "");
  EXPECT_EQ(change_.from, designer_.initial());
  EXPECT_EQ(change_.duration_s, 2.0);
  EXPECT_STREQ(change_.name.data(), "motor_lag");
  // (2 zeta omega + pole), omega^2 + 2 zeta omega pole, pole omega^2
  EXPECT_DOUBLE_EQ(change_.to.position_v.x(), 2.4);
  EXPECT_DOUBLE_EQ(change_.to.position_p.x(), 1.8);
  EXPECT_DOUBLE_EQ(change_.to.position_i.x(), 0.4);
  EXPECT_EQ(change_.to.position_v.y(), designer_.initial().position_v.y());
}

TEST_F(GainDesignerTest, RefusesWhatCannotChangeByItsKey) {
  EXPECT_EQ(refusal(request("max_speed_m_s: 2.0", "max_speed_m_s: 3.0")),
            "limits.max_speed_m_s: cannot change in flight: is 2.0, the file has 3.0");
  EXPECT_EQ(refusal(request("error: rotation", "error: euler_angles")),
            "attitude.error: cannot change in flight: is rotation, the file has euler_angles");
  EXPECT_EQ(refusal(request("same: 1.0e-8", "same: 1.0e-9")),
            "estimator.detectors.stuck_pose.same: cannot change in flight: is 1.0e-8, the file has 1.0e-9");
  control::SettingsRequest unknown = request();
  unknown.fixed.push_back({"limits.max_flips", "2"});
  EXPECT_EQ(refusal(unknown), "limits.max_flips: the controller has no such setting");
}

TEST_F(GainDesignerTest, TakesEqualNumbersForTheSame) {
  EXPECT_EQ(refusal(request("max_speed_m_s: 2.0", "max_speed_m_s: 2")), "");
  EXPECT_EQ(refusal(request("fence_max_ned_m: [3.0, 3.0, 0.0]", "fence_max_ned_m: [3,3,0]")), "");
}

TEST_F(GainDesignerTest, RefusesSettingsThatBreakARuleOrAreUnstable) {
  control::SettingsRequest asked = request();
  asked.tunable.position.z.zeta = -1.0;
  EXPECT_EQ(refusal(asked), "position.z.zeta: is -1, must be a finite number above 0");
  EXPECT_EQ(refusal(request("y: {omega_n: 2.0, zeta: 1.0", "y: {omega_n: 6.0, zeta: 0.2")),
            "position.y: with the rotor lag the loop is unstable");
  asked = request();
  asked.tunable.disturbance.bandwidth = 0.0;
  EXPECT_EQ(refusal(asked).rfind("disturbance.bandwidth_rad_s: cannot change to 0 in flight", 0), 0U);
}

}  // namespace swiftlet::services::gain_designer_test
