#include "swiftlet/control/types/gains.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace swiftlet::control::gains_test {

GainChange change() {
  GainChange out;
  out.from.position_p = {4.0, 5.0, 6.0};
  out.from.integral_limit = 2.0;
  out.to.position_p = {8.0, 1.0, 6.0};
  out.to.integral_limit = 1.0;
  out.to.attitude_rate = {30.0, 30.0, 5.0};
  out.start_ns = 1'000'000'000;
  out.duration_s = 2.0;
  return out;
}

TEST(GainChange, GoesFromOneSetToTheOther) {
  const GainChange c = change();
  EXPECT_EQ(c.at(0), c.from);
  EXPECT_EQ(c.at(c.start_ns), c.from);
  EXPECT_EQ(c.at(c.start_ns + 2'000'000'000), c.to);
  EXPECT_EQ(c.at(c.start_ns + 9'000'000'000), c.to);
  const ControlGains half_way = c.at(c.start_ns + 1'000'000'000);
  EXPECT_DOUBLE_EQ(half_way.position_p.x(), 6.0);
  EXPECT_DOUBLE_EQ(half_way.attitude_rate.z(), 2.5);
  EXPECT_DOUBLE_EQ(c.progress(c.start_ns + 500'000'000), 0.25);
  EXPECT_DOUBLE_EQ(c.remaining_s(c.start_ns + 500'000'000), 1.5);
}

// The largest step between two samples is that of the cubic's steepest place, 1.5 / duration.
TEST(GainChange, DoesNotStepAndBeginsAndEndsAtRateZero) {
  const GainChange c = change();
  constexpr std::int64_t kSample_ns = 2'000'000;
  const double most = 1.5 * 2e-3 / c.duration_s * 30.0;
  double before = c.at(c.start_ns - kSample_ns).attitude_rate.x();
  for (std::int64_t now_ns = c.start_ns; now_ns < c.start_ns + 2'100'000'000; now_ns += kSample_ns) {
    const double now = c.at(now_ns).attitude_rate.x();
    ASSERT_GE(now, before);
    ASSERT_LE(now - before, most * 1.001);
    before = now;
  }
  EXPECT_LT(c.at(c.start_ns + kSample_ns).attitude_rate.x(), 0.01 * most * 1.5);
}

TEST(GainChange, OfNoDurationIsInForce) {
  GainChange c = change();
  c.duration_s = 0.0;
  EXPECT_EQ(c.at(0), c.to);
  EXPECT_EQ(c.progress(0), 1.0);
}

TEST(SettingsName, IsCutToItsLength) {
  EXPECT_STREQ(settings_name("soft").data(), "soft");
  EXPECT_EQ(std::string(settings_name(std::string(50, 'a')).data()), std::string(kMaxSettingsName, 'a'));
}

}  // namespace swiftlet::control::gains_test
