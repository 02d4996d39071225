// Gains that tolerate a delay of the loop.
#include "swiftlet/analysis/tuning/delay_design.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "swiftlet/io/edit_yaml.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::analysis::delay_design_test {

const std::string kFile = tests::in_source("config/control/motor_lag.yaml");

class DelayDesignTest : public testing::Test {
 protected:
  const control::ControlSettings settings_ = io::load_control_settings(kFile);
  const plant::Vehicle vehicle_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
};

TEST_F(DelayDesignTest, EveryLoopToleratesTwiceTheDelay) {
  for (const double delay_s : {0.03, 0.1}) {
    const DelayDesign design = design_for_delay(vehicle_, settings_, delay_s);
    const double least_s = *std::min_element(design.margins_s.begin(), design.margins_s.end());
    EXPECT_GE(least_s, kDelayReserve * delay_s);
    EXPECT_LE(least_s, 1.05 * kDelayReserve * delay_s) << "slower than needed";
    EXPECT_LT(design.factor, 1.0);
  }
}

TEST_F(DelayDesignTest, LeavesGainsThatTolerateIt) {
  EXPECT_EQ(design_for_delay(vehicle_, settings_, 0.01).factor, 1.0);
}

TEST_F(DelayDesignTest, RefusesAHopelessDelay) {
  EXPECT_THROW(design_for_delay(vehicle_, settings_, 2.0), std::invalid_argument);
}

TEST_F(DelayDesignTest, WritesSettingsThatReadBack) {
  control::ControlSettings slow = slowed(settings_, 0.25);
  slow.name = "slow";
  const std::string text = io::with_scalars(io::read_text_file(kFile), kFile, slowed_values(slow));
  const control::ControlSettings read = io::parse_control_settings(text, "slow.yaml");
  EXPECT_EQ(read.name, "slow");
  EXPECT_DOUBLE_EQ(read.attitude.roll.q[0], 40000.0 / 256.0);
  EXPECT_DOUBLE_EQ(read.position.x.omega_n, 0.5);
  EXPECT_DOUBLE_EQ(read.position.z.integral_pole, 0.1);
  EXPECT_DOUBLE_EQ(read.disturbance.bandwidth, 5.0);
  EXPECT_EQ(read.limits.max_tilt_rad, settings_.limits.max_tilt_rad);
}

}  // namespace swiftlet::analysis::delay_design_test
