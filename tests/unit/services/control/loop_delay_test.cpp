// The measured delay of the loop, and its comparison with the margin.
#include "swiftlet/services/control/loop_delay.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/control/delay_monitor.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::services::loop_delay_test {

constexpr std::int64_t kPeriodNs = 2'000'000;

std::int64_t ms(std::int64_t time) { return time * 1'000'000; }

// Samples for a time, each obeying a command that answers the sample `age` before it.
void run(LoopDelay& delay, std::int64_t& stamp_ns, std::int64_t duration_ns, std::int64_t age_ns) {
  for (const std::int64_t end_ns = stamp_ns + duration_ns; stamp_ns < end_ns; stamp_ns += kPeriodNs)
    delay.sample(stamp_ns, {true, true, 1, stamp_ns - age_ns});
}

TEST(LoopDelay, IsTheAgeOfTheObeyedCommand) {
  LoopDelay delay;
  std::int64_t stamp_ns = ms(5000);
  run(delay, stamp_ns, ms(90), ms(40));
  EXPECT_EQ(delay.figures().p50_ns, -1) << "too early";
  run(delay, stamp_ns, ms(20), ms(40));
  EXPECT_EQ(delay.figures().p50_ns, ms(40));
  run(delay, stamp_ns, ms(2000), ms(90));
  EXPECT_EQ(delay.figures().p95_ns, ms(90)) << "of the last second only";
}

TEST(LoopDelay, IsUnknownWithoutObeyedCommands) {
  LoopDelay delay;
  std::int64_t stamp_ns = ms(5000);
  run(delay, stamp_ns, ms(1100), ms(40));
  for (const std::int64_t end_ns = stamp_ns + ms(2100); stamp_ns < end_ns; stamp_ns += kPeriodNs)
    delay.sample(stamp_ns, {true, false, 0, 0});
  EXPECT_EQ(delay.figures().p95_ns, -1);
}

TEST(LoopDelay, BeginsAnewWhenTheVehicleRestarts) {
  LoopDelay delay;
  std::int64_t stamp_ns = ms(5000);
  run(delay, stamp_ns, ms(1100), ms(40));
  stamp_ns = 0;
  run(delay, stamp_ns, ms(90), ms(2));
  EXPECT_EQ(delay.figures().p50_ns, -1);
}

TEST(LoopDelay, IgnoresTheCommandThatWasObeyedBeforeTheFirstSample) {
  LoopDelay delay;
  std::int64_t stamp_ns = ms(65'000);
  delay.sample(stamp_ns, {true, true, 1, ms(5000)});
  stamp_ns += kPeriodNs;
  run(delay, stamp_ns, ms(110), ms(70));
  EXPECT_EQ(delay.figures().p95_ns, ms(70));
}

class DelayMargin : public testing::Test {
 protected:
  const control::ControlSettings settings_ =
      io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
  const plant::Vehicle vehicle_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  const control::ControlDesign design_ = control::design(vehicle_, settings_);
  const control::ControlGains gains_ = control::control_gains(design_, settings_);
  const control::ObservedRotors rotors_ = control::observed_rotors(design_.rotor_lag_s, settings_);
};

TEST_F(DelayMargin, IsTheLeastOfTheLoops) {
  const std::array<double, 6> margins_s = control::flown_delay_margins(design_, settings_);
  const double least_s = *std::min_element(margins_s.begin(), margins_s.end());
  const double found_s = control::least_flown_delay_margin(gains_, rotors_);
  EXPECT_LE(found_s, least_s);
  EXPECT_GT(found_s, least_s - control::kLeastDelayAccuracy_s - 1e-5);
}

TEST_F(DelayMargin, WarnsBeforeItIsReached) {
  DelayMonitor monitor(rotors_);
  const double margin_s = monitor.update({}, gains_, true).margin_s;
  const auto near = [&](double share) {
    const auto delay_ns = static_cast<std::int64_t>(1e9 * share * margin_s);
    return monitor.update({delay_ns, delay_ns}, gains_, true).near_margin;
  };
  EXPECT_FALSE(near(0.55));
  EXPECT_TRUE(near(0.65));
  EXPECT_TRUE(near(0.55)) << "with hysteresis";
  EXPECT_FALSE(near(0.45));
  EXPECT_FALSE(monitor.update({}, gains_, true).near_margin) << "not measured";
}

TEST_F(DelayMargin, FollowsTheGainsWhenTheirChangeIsComplete) {
  DelayMonitor monitor(rotors_);
  const double before_s = monitor.update({}, gains_, true).margin_s;
  control::ControlGains stiffer = gains_;
  stiffer.attitude_angle *= 2.0;
  EXPECT_EQ(monitor.update({}, stiffer, false).margin_s, before_s);
  EXPECT_LT(monitor.update({}, stiffer, true).margin_s, before_s);
}

}  // namespace swiftlet::services::loop_delay_test
