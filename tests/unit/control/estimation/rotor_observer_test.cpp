#include "swiftlet/control/estimation/rotor_observer.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::rotor_observer_test {

using Eigen::Vector3d;
using tests::kaylion;
using tests::multirotor;

constexpr double kSupply_v = 3.7;
constexpr double kTau_s = 0.0821;     // Eq. (18)
constexpr double kBandwidth = 112.0;  // rad/s

// Eq. (9) and (22) with the paper's numbers.
double steady_speed(double throttle, double offset_v2 = 0.6472) {
  const double v_a = std::sqrt(std::max(0.9205 * kSupply_v * kSupply_v * throttle + offset_v2, 0.0));
  return (-1.020e-3 + std::sqrt(1.020e-3 * 1.020e-3 + 4.0 * 2.817e-7 * v_a)) / (2.0 * 2.817e-7);
}

plant::ActuatorCommand running(int rotor_count, const plant::PerRotor& throttle) {
  plant::ActuatorCommand command;
  command.rotor_state = plant::RotorState::kRunning;
  command.rotor_count = rotor_count;
  command.throttle = throttle;
  return command;
}

const plant::PerRotor kThrottles = {0.1, 0.3, 0.5, 0.9};

// First-order lag: after a time t in any steps, exp(-t / tau) of the initial difference is left.
TEST(RotorObserver, SpeedsFollowTheLagForAnySteps) {
  for (const int rotors : {4, 6}) {
    RotorObserver observer(rotors == 4 ? kaylion() : multirotor(rotors), kBandwidth);
    plant::PerRotor throttles = kThrottles;
    if (rotors == 6) throttles[5] = 0.7;
    double t = 0.0;
    for (const double dt_s : {0.002, 0.002, 0.001, 0.03, 0.002, 0.1, 0.002}) {
      observer.step(dt_s, running(rotors, throttles), kSupply_v);
      t += dt_s;
      for (int i = 0; i < plant::kMaxRotors; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const double expected = i < rotors ? steady_speed(throttles[n]) * (1.0 - std::exp(-t / kTau_s)) : 0.0;
        EXPECT_NEAR(observer.speeds()[n], expected, 1e-8) << "rotor " << i << " of " << rotors << " at " << t;
      }
    }
  }
}

// Without throttles: all rotors approach the speed of their share of the thrust, with the same lag.
TEST(RotorObserver, RotorsShareACommandedThrust) {
  for (const int rotors : {4, 6}) {
    RotorObserver observer(rotors == 4 ? kaylion() : multirotor(rotors), kBandwidth);
    observer.step(kTau_s, 0.8);
    const double steady = std::sqrt(0.8 / rotors / 3.7901e-8);
    for (int i = 0; i < rotors; ++i) {
      EXPECT_NEAR(observer.speeds()[static_cast<std::size_t>(i)], steady * (1.0 - std::exp(-1.0)), 1e-6);
    }
    observer.step(10.0, 0.8);
    EXPECT_NEAR(observer.thrust_n(), 0.8, 1e-9);
    EXPECT_LT(observer.moment_frd().norm(), 1e-9);
    observer.step(10.0, 0.0);
    EXPECT_NEAR(observer.thrust_n(), 0.0, 1e-9);
  }
}

TEST(RotorObserver, RotorsThatAreOffDecayForAnySteps) {
  RotorObserver observer(kaylion(), kBandwidth);
  observer.step(10.0, running(4, kThrottles), kSupply_v);
  double t = 0.0;
  for (const double dt_s : {0.002, 0.004, 0.001}) {
    observer.step(dt_s, {}, kSupply_v);
    t += dt_s;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(observer.speeds()[i], steady_speed(kThrottles[i]) * std::exp(-t / kTau_s), 1e-8) << i;
  }
}

// Eq. (27) and (28), with k_T, k_Q and l / sqrt 2 of the paper.
TEST(RotorObserver, WrenchFollowsFromTheSpeeds) {
  RotorObserver observer(kaylion(), kBandwidth);
  observer.step(10.0, running(4, kThrottles), kSupply_v);
  double t[4], q[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const double square = std::pow(steady_speed(kThrottles[i]), 2);
    t[i] = 3.7901e-8 * square;
    q[i] = 1.8623e-10 * square;
  }
  const double d = 0.0695 / std::sqrt(2.0);
  const Vector3d moment(d * (-t[0] + t[1] + t[2] - t[3]), d * (t[0] + t[1] - t[2] - t[3]),
                        q[0] - q[1] + q[2] - q[3]);
  EXPECT_NEAR(observer.thrust_n(), t[0] + t[1] + t[2] + t[3], 1e-9);
  EXPECT_LT((observer.moment_frd() - moment).norm(), 2e-6 * moment.norm())
      << observer.moment_frd().transpose();
  observer.step(kTau_s, {}, kSupply_v);
  EXPECT_NEAR(observer.thrust_n(), std::exp(-2.0) * (t[0] + t[1] + t[2] + t[3]), 1e-9)
      << "after one time constant with rotors off";
}

// Below the dead zone of the ESC there is no voltage, not the root of a negative number.
TEST(RotorObserver, ThrottleInTheDeadZoneGivesNoSpeed) {
  plant::Vehicle vehicle = kaylion();
  vehicle.esc.offset_v2 = -1.0;
  RotorObserver observer(vehicle, kBandwidth);
  observer.step(10.0, running(4, {0.0, 0.01, 0.2, 0.4}), kSupply_v);
  EXPECT_EQ(observer.speeds()[0], 0.0);
  EXPECT_EQ(observer.speeds()[1], 0.0);
  EXPECT_NEAR(observer.speeds()[3], steady_speed(0.4, -1.0), 1e-8);
  EXPECT_GT(observer.thrust_n(), 0.0);
}

TEST(RotorObserver, TakesTheFirstMeasurementAsItIs) {
  RotorObserver observer(kaylion(), kBandwidth);
  observer.step(10.0, running(4, kThrottles), kSupply_v);
  plant::RotorSpeedSample sample;
  sample.rotor_count = 4;
  sample.speeds = {100.0, 2000.0, 0.0, 1500.0};
  sample.stamp_ns = 1;
  observer.correct(sample);
  EXPECT_EQ(observer.speeds(), sample.speeds) << "the first measurement is taken as it is";
  EXPECT_NEAR(observer.thrust_n(), 3.7901e-8 * (100.0 * 100.0 + 2000.0 * 2000.0 + 1500.0 * 1500.0), 1e-9);
}

TEST(RotorObserver, IgnoresSamplesThatAreNotMeasurements) {
  RotorObserver observer(kaylion(), kBandwidth);
  observer.step(10.0, running(4, kThrottles), kSupply_v);
  const plant::PerRotor before = observer.speeds();
  plant::RotorSpeedSample sample;
  sample.stamp_ns = 1;
  sample.rotor_count = 6;
  sample.speeds = {100.0, 100.0, 100.0, 100.0, 100.0, 100.0};
  observer.correct(sample);
  sample.rotor_count = 4;
  for (const double speed : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    sample.speeds[3] = speed;
    observer.correct(sample);
  }
  EXPECT_EQ(observer.speeds(), before);
}

}  // namespace swiftlet::control::rotor_observer_test
