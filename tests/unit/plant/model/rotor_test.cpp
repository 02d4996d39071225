#include "swiftlet/plant/model/rotor.hpp"

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::rotor_test {

using tests::kaylion;
using tests::UniformRandom;

TEST(Rotor, ThrustAndTorqueMatchEquations25And26) {
  EXPECT_DOUBLE_EQ(thrust_from_speed(kaylion().rotor, 1600.0), 3.7901e-8 * 1600.0 * 1600.0);
  EXPECT_DOUBLE_EQ(torque_from_speed(kaylion().rotor, 1600.0), 1.8623e-10 * 1600.0 * 1600.0);
  EXPECT_NEAR(torque_per_thrust(kaylion().rotor), 4.9136e-3, 1e-7);
}

TEST(Rotor, SpeedInvertsThrust) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double speed = draw(0.0, 3000.0);
    EXPECT_NEAR(speed_from_thrust(kaylion().rotor, thrust_from_speed(kaylion().rotor, speed)), speed, 1e-9);
  }
  EXPECT_EQ(speed_from_thrust(kaylion().rotor, -0.1), 0.0);
}

TEST(Rotor, BladeCoefficientsMatchEquations23And24) {
  const BladeCoefficients blade{0.012, 0.0015, 0.0275, 1.2};
  const RotorCoefficients rotor = rotor_coefficients(blade);
  const double area = 3.14159265358979 * 0.0275 * 0.0275;
  const double omega = 1500.0;
  EXPECT_NEAR(thrust_from_speed(rotor, omega), 0.012 * 1.2 * area * std::pow(0.0275, 2) * omega * omega,
              1e-12);
  EXPECT_NEAR(torque_from_speed(rotor, omega), 0.0015 * 1.2 * area * std::pow(0.0275, 3) * omega * omega,
              1e-14);
}

TEST(Rotor, BladeCoefficientsRoundTrip) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const BladeCoefficients blade{draw(0.001, 0.1), draw(0.0001, 0.01), draw(0.01, 0.2), draw(0.9, 1.4)};
    const BladeCoefficients again =
        blade_coefficients(rotor_coefficients(blade), blade.radius_m, blade.air_density);
    EXPECT_NEAR(again.thrust / blade.thrust, 1.0, 1e-12);
    EXPECT_NEAR(again.torque / blade.torque, 1.0, 1e-12);
  }
}

}  // namespace swiftlet::plant::rotor_test
