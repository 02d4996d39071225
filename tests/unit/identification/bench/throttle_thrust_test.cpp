#include "swiftlet/identification/bench/throttle_thrust.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::throttle_thrust_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;

TEST(ThrottleThrustExperiment, FindsTheThrustFactorOfAKnownEscAndMotor) {
  plant::Vehicle base = kaylion();
  base.rotor.thrust *= 1.3;
  const Experiment found =
      identify_throttle_thrust(*bench_of(kaylion(), 0.0).throttle_thrust, base, {true, true, false}, {});
  EXPECT_NEAR(found.estimate("rotor.thrust_factor").value / 3.7901e-8, 1.0, 1e-8);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(ThrottleThrustExperiment, FindsTheMotorBehindAKnownEsc) {
  plant::Vehicle base = kaylion();
  base.motor.k2 *= 0.7;
  base.motor.k3 *= 1.5;
  const Experiment found =
      identify_throttle_thrust(*bench_of(kaylion(), 0.0).throttle_thrust, base, {true, false, true}, {});
  EXPECT_NEAR(found.estimate("motor.k2").value / 1.020e-3, 1.0, 1e-6);
  EXPECT_NEAR(found.estimate("motor.k3").value / 2.817e-7, 1.0, 1e-6);
}

// GIVEN thrust over throttle alone and a base that differs from the vehicle: only the whole chain is
// identifiable.
TEST(ThrottleThrustExperiment, FitsTheChainWhenItsPartsAreUnknown) {
  plant::Vehicle base = kaylion();
  base.esc.gain *= 0.8;
  base.esc.offset_v2 = 0.1;
  base.rotor.thrust *= 2.0;
  base.motor.k2 *= 1.4;
  const Experiment found =
      identify_throttle_thrust(*bench_of(kaylion(), 0.0).throttle_thrust, base, {false, false, false}, {});
  EXPECT_TRUE(contains(found.warnings,
                       "thrust without speed does not identify K2, K3, k_T and the ESC's gain separately"));
  plant::Vehicle fitted = base;
  fitted.esc.offset_v2 = found.estimate("esc.offset").value;
  fitted.motor.k2 = found.estimate("motor.k2").value;
  fitted.motor.k3 = found.estimate("motor.k3").value;
  for (const double supply : {3.6, 3.9, 4.2}) {
    for (const double throttle : {0.05, 0.4, 1.0}) {
      EXPECT_NEAR(plant::steady_thrust_from_throttle(fitted, supply, throttle) /
                      plant::steady_thrust_from_throttle(kaylion(), supply, throttle),
                  1.0, 1e-6);
    }
  }
}

}  // namespace swiftlet::identification::throttle_thrust_test
