#include "swiftlet/services/px4/thrust_scale.hpp"

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::px4::thrust_scale_test {

constexpr std::int64_t kPeriodNs = 10'000'000;

class Px4ThrustScale : public testing::Test {
 protected:
  const plant::Vehicle vehicle_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  const double weight_n_ = vehicle_.mass_kg * plant::kGravity;

  double thrust_of(double throttle, double voltage_v) const {
    return vehicle_.rotor_count() * plant::steady_thrust_from_throttle(vehicle_, voltage_v, throttle);
  }
};

TEST_F(Px4ThrustScale, InvertsTheCurveOfTheVehicleFile) {
  ThrustScale scale(vehicle_);
  scale.set_voltage(3.8);
  for (const double share : {0.5, 1.0, 1.4}) {
    const double thrust_n = share * weight_n_;
    EXPECT_NEAR(thrust_of(scale.throttle(thrust_n), 3.8), thrust_n, 1e-9);
  }
  EXPECT_EQ(scale.throttle(0.0), 0.0);
  EXPECT_EQ(scale.throttle(100.0), 1.0);
}

TEST_F(Px4ThrustScale, TheVoltageOfAnotherBatteryIsNotUsed) {
  ThrustScale scale(vehicle_);
  const double before = scale.hover_throttle();
  scale.set_voltage(16.2);
  EXPECT_EQ(scale.hover_throttle(), before);
  scale.set_voltage(3.6);
  EXPECT_GT(scale.hover_throttle(), before);
}

TEST_F(Px4ThrustScale, BeginsWithAGivenHoverThrottle) {
  const ThrustScale scale(vehicle_, 0.42);
  EXPECT_NEAR(scale.hover_throttle(), 0.42, 1e-12);
}

// GIVEN rotors that give 80 % of the thrust of the vehicle file WHEN the vehicle hovers THEN the throttle of hover is learnt.
TEST_F(Px4ThrustScale, LearnsTheHoverThrottleInFlight) {
  ThrustScale scale(vehicle_);
  scale.set_voltage(3.8);
  double thrust_n = 0.0;
  for (int i = 1; i < 800; ++i) {
    thrust_n = 0.8 * thrust_of(scale.throttle(weight_n_), 3.8);
    scale.learn(weight_n_, thrust_n / vehicle_.mass_kg, true, i * kPeriodNs);
  }
  EXPECT_NEAR(thrust_n, weight_n_, 0.01 * weight_n_);
}

// GIVEN a vehicle that has learnt its throttle WHEN it lands, and the ground carries more and more of it before PX4 tells
// THEN the throttle of hover stays.
TEST_F(Px4ThrustScale, ATouchdownIsNotLearnt) {
  ThrustScale scale(vehicle_);
  int i = 1;
  for (; i < 800; ++i)
    scale.learn(weight_n_, 0.8 * thrust_of(scale.throttle(weight_n_), 3.8) / vehicle_.mass_kg, true,
                i * kPeriodNs);
  const double learnt = scale.hover_throttle();
  for (const int end = i + 80; i < end; ++i)
    scale.learn((0.6 + 0.005 * (end - i)) * weight_n_, plant::kGravity, true, i * kPeriodNs);
  EXPECT_LT(scale.hover_throttle(), 0.95 * learnt) << "misled";
  scale.learn(0.5 * weight_n_, plant::kGravity, false, i * kPeriodNs);
  EXPECT_NEAR(scale.hover_throttle(), learnt, 0.01 * learnt);
}

TEST_F(Px4ThrustScale, LearnsNothingOnTheGroundOrInAFall) {
  ThrustScale scale(vehicle_);
  for (int i = 1; i < 300; ++i) scale.learn(weight_n_, 3.0, false, i * kPeriodNs);
  for (int i = 300; i < 600; ++i) scale.learn(0.1 * weight_n_, 3.0, true, i * kPeriodNs);
  EXPECT_EQ(scale.factor(), 1.0);
}

}  // namespace swiftlet::px4::thrust_scale_test
