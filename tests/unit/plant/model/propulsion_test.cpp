#include "swiftlet/plant/model/propulsion.hpp"

#include <ostream>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/airframe.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::propulsion_test {

using tests::kaylion;
using tests::UniformRandom;

// Values of the identified model, computed independently of this code, for g = 9.81 m/s^2.
struct HoverAnchor {
  double mass_kg, speed, voltage;
  double throttle_36, throttle_37, throttle_42;  // at a supply of 3.6, 3.7 and 4.2 V
};

void PrintTo(const HoverAnchor& anchor, std::ostream* out) { *out << anchor.mass_kg << " kg"; }

class HoverAnchors : public testing::TestWithParam<HoverAnchor> {};

TEST_P(HoverAnchors, MatchTheModel) {
  const HoverAnchor& anchor = GetParam();
  const double thrust = anchor.mass_kg * 9.81 / 4.0;
  const double speed = speed_from_thrust(kaylion().rotor, thrust);
  EXPECT_NEAR(speed, anchor.speed, 0.05);
  EXPECT_NEAR(voltage_from_steady_speed(kaylion().motor, speed), anchor.voltage, 5e-4);
  EXPECT_NEAR(throttle_from_steady_thrust(kaylion(), 3.6, thrust), anchor.throttle_36, 5e-4);
  EXPECT_NEAR(throttle_from_steady_thrust(kaylion(), 3.7, thrust), anchor.throttle_37, 5e-4);
  EXPECT_NEAR(throttle_from_steady_thrust(kaylion(), 4.2, thrust), anchor.throttle_42, 5e-4);
}

INSTANTIATE_TEST_SUITE_P(KayLion, HoverAnchors,
                         testing::Values(HoverAnchor{0.036, 1526.3, 2.213, 0.356, 0.337, 0.262},
                                         HoverAnchor{0.040, 1608.8, 2.370, 0.417, 0.394, 0.306}));

TEST(Propulsion, MatchesTheFullThrottleAnchors) {
  EXPECT_NEAR(steady_speed_from_throttle(kaylion(), 3.7, 1.0), 2214.0, 0.5);
  EXPECT_NEAR(4.0 * steady_thrust_range(kaylion(), 3.7).max, 0.743, 5e-4);
  EXPECT_NEAR(steady_speed_from_throttle(kaylion(), 4.2, 1.0), 2416.0, 0.5);
  EXPECT_NEAR(4.0 * steady_thrust_range(kaylion(), 4.2).max, 0.885, 5e-4);
}

TEST(Propulsion, RotorsTurnAtZeroThrottle) {
  EXPECT_NEAR(steady_speed_from_throttle(kaylion(), 3.7, 0.0), 666.0, 0.5);
  EXPECT_GT(steady_thrust_range(kaylion(), 3.7).min, 0.0);
}

TEST(Propulsion, ThrottleRoundTripsThroughSpeedAndThrust) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double supply = draw(3.0, 4.3);
    const double throttle = draw(0.0, 1.0);
    const double speed = steady_speed_from_throttle(kaylion(), supply, throttle);
    const double thrust = steady_thrust_from_throttle(kaylion(), supply, throttle);
    EXPECT_NEAR(throttle_from_steady_speed(kaylion(), supply, speed), throttle, 1e-11);
    EXPECT_NEAR(throttle_from_steady_thrust(kaylion(), supply, thrust), throttle, 1e-11);
  }
}

TEST(Propulsion, ThrustRisesWithThrottleAndSupply) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double supply = draw(3.0, 4.3);
    const double throttle = draw(0.0, 0.99);
    const double thrust = steady_thrust_from_throttle(kaylion(), supply, throttle);
    EXPECT_LT(thrust, steady_thrust_from_throttle(kaylion(), supply, throttle + 0.01));
    EXPECT_LE(thrust, steady_thrust_from_throttle(kaylion(), supply + 0.1, throttle));
  }
}

TEST(Propulsion, ClampsUnreachableThrust) {
  const ThrustRange range = steady_thrust_range(kaylion(), 3.7);
  EXPECT_EQ(throttle_from_steady_thrust(kaylion(), 3.7, 0.9 * range.min), 0.0);
  EXPECT_EQ(throttle_from_steady_thrust(kaylion(), 3.7, 1.1 * range.max), 1.0);
  EXPECT_EQ(throttle_from_steady_thrust(kaylion(), 3.7, -1.0), 0.0);
}

}  // namespace swiftlet::plant::propulsion_test
