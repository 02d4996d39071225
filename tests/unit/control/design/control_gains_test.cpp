// The gains of a design, and the stability of the way from one set to another.
#include "swiftlet/control/design/control_gains.hpp"

#include <gtest/gtest.h>

#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::control_gains_test {

ControlGains gains_of(const std::string& name) {
  const ControlSettings settings =
      io::load_control_settings(tests::in_source("config/control/") + name + ".yaml");
  return control_gains(design(io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")), settings),
                       settings);
}

constexpr double kLag_s = 0.0821;

TEST(GainChange, BetweenTheSettingsOfTheProjectIsStable) {
  EXPECT_FALSE(unstable_change(gains_of("motor_lag"), gains_of("paper"), kLag_s));
  EXPECT_FALSE(unstable_change(gains_of("paper"), gains_of("motor_lag"), kLag_s));
}

TEST(GainChange, NamesTheLoopThatBecomesUnstable) {
  ControlGains to = gains_of("motor_lag");
  to.position_v[1] = 0.2;
  const auto fault = unstable_change(gains_of("motor_lag"), to, kLag_s);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->key, "position.y");
  EXPECT_EQ(fault->message, "with the rotor lag the loop is unstable");
}

TEST(GainChange, RefusesALoopThatToleratesLittleDelay) {
  ControlGains to = gains_of("motor_lag");
  to.attitude_acceleration[2] = 60.0;  // stable, but with a crossover far above the sampling
  ASSERT_LT(closed_loop_poles(attitude_loop({to.attitude_angle[2], to.attitude_rate[2], 60.0}, {kLag_s}))
                .back()
                .real(),
            0.0);
  const auto fault = unstable_change(gains_of("motor_lag"), to, kLag_s);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->key, "attitude.yaw");
  EXPECT_EQ(fault->message.rfind("the loop tolerates a delay of ", 0), 0U) << fault->message;
}

// (1 + k2) k1 > tau k0 holds for both sets and fails between them: the left side is convex, the right linear.
TEST(GainChange, BetweenTwoStableSetsIsCheckedToo) {
  ControlGains from = gains_of("motor_lag");
  ControlGains to = from;
  const auto set_yaw = [](ControlGains& gains, double k0, double k1, double k2) {
    gains.attitude_angle[2] = k0;
    gains.attitude_rate[2] = k1;
    gains.attitude_acceleration[2] = k2;
  };
  set_yaw(from, 3.65, 1.0, 0.0);    // 1.0 > 0.3
  set_yaw(to, 2436.0, 100.0, 3.0);  // 400 > 200; at a fifth of the way 33 < 40
  const auto between = blend(from, to, 0.2);
  ASSERT_GT(closed_loop_poles(attitude_loop({between.attitude_angle[2], between.attitude_rate[2],
                                             between.attitude_acceleration[2]},
                                            {kLag_s}))
                .back()
                .real(),
            0.0);
  const auto fault = unstable_change(from, to, kLag_s);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->key, "attitude.yaw");
  EXPECT_NE(fault->message.find(" of the change"), std::string::npos) << fault->message;
}

}  // namespace swiftlet::control::control_gains_test
