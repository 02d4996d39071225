#include "swiftlet/identification/bench/propeller.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/rotor.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::propeller_test {

using tests::refused;

const Propeller kPropeller{0.0275, 1.2};

ParameterEstimate factor(double value) { return {"", "", "", value, 0.01 * value, 0.02 * value}; }

TEST(PropellerCoefficients, FollowEq23And24) {
  const PropellerCoefficients found =
      propeller_coefficients(factor(3.7901e-8), factor(1.8623e-10), kPropeller, 2200.0);
  const plant::RotorCoefficients back =
      plant::rotor_coefficients({found.thrust->value, found.torque->value, 0.0275, 1.2});
  EXPECT_NEAR(back.thrust / 3.7901e-8, 1.0, 1e-12);
  EXPECT_NEAR(back.torque / 1.8623e-10, 1.0, 1e-12);
  EXPECT_NEAR(found.thrust->half_width / found.thrust->value, 0.02, 1e-12);
  EXPECT_GT(*found.figure_of_merit, 0.3);
  EXPECT_LT(*found.figure_of_merit, 0.8);
}

TEST(PropellerCoefficients, RefuseValuesNoPropellerCanHave) {
  const auto refusal = [](double thrust, double torque, double speed) {
    return refused([&] { propeller_coefficients(factor(thrust), factor(torque), kPropeller, speed); });
  };
  EXPECT_NE(refusal(3.7901e-8, 1.8623e-10, 20000.0).find("speed of sound"), std::string::npos);
  const double rpm = 3600.0 / (4.0 * 9.8696);  // rpm^2 over (rad/s)^2
  EXPECT_NE(refusal(3.7901e-8 / rpm, 1.8623e-10 / rpm, 2200.0).find("C_T = "), std::string::npos);
  EXPECT_NE(refusal(3.7901e-8, 1.8623e-11, 2200.0).find("figure of merit"), std::string::npos);
}

}  // namespace swiftlet::identification::propeller_test
