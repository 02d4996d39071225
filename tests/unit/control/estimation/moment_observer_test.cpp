#include "swiftlet/control/estimation/moment_observer.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::moment_observer_test {

using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
constexpr double kBandwidth = 20.0;                 // rad/s
const Vector3d kLimit_frd(1.0e-3, 1.0e-3, 1.0e-3);  // N m

// A body that rotor moments and a disturbance turn, Eq. (6), and its observer. Integrated as the observer does.
struct Body {
  Eigen::Matrix3d inertia = tests::kaylion().inertia;
  Vector3d rates{0.5, -0.3, 0.2};
  MomentObserver observer{inertia, kLimit_frd};

  void run(double duration_s, const Vector3d& disturbance) {
    for (double t = 0.0; t < duration_s; t += kStep_s) {
      const Vector3d rotors = -2.0e-4 * rates;
      observer.step(kStep_s, kBandwidth, rates, rotors);
      rates += kStep_s * (inertia.inverse() * (rotors + disturbance - rates.cross(inertia * rates)));
    }
  }
};

TEST(MomentObserver, FindsAConstantMoment) {
  Body body;
  const Vector3d disturbance(1.0e-4, -5.0e-5, 2.0e-5);  // N m
  body.run(2.0, disturbance);
  EXPECT_LT((body.observer.moment_frd() - disturbance).norm(), 1.0e-7);
}

// Both sides pass one filter: after the start, explained moments leave nothing.
TEST(MomentObserver, FindsNothingInTheMomentsOfTheRotors) {
  Body body;
  body.run(1.0, Vector3d::Zero());
  body.rates = {0.4, 0.2, -0.1};
  body.observer.reset();
  EXPECT_TRUE(body.observer.moment_frd().isZero(0.0));
  body.run(1.0, Vector3d::Zero());
  EXPECT_LT(body.observer.moment_frd().norm(), 1.0e-7);
}

TEST(MomentObserver, IgnoresInvalidInput) {
  Body body;
  body.run(0.5, {1.0e-4, 0.0, 0.0});
  const Vector3d before = body.observer.moment_frd();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  body.observer.step(kStep_s, kBandwidth, {nan, 0.0, 0.0}, Vector3d::Zero());
  body.observer.step(kStep_s, kBandwidth, Vector3d::Zero(), {0.0, nan, 0.0});
  EXPECT_EQ(body.observer.moment_frd(), before);
}

// GIVEN a body under a growing moment WHEN the bandwidth goes to 0 THEN the moment ends at 0 and stays there.
TEST(MomentObserver, EndsAtZeroWithABandwidthThatGoesToZero) {
  Body body;
  body.run(0.5, {1.0e-4, 0.0, 0.0});
  Vector3d rates = body.rates;
  for (int i = 0; i <= 5000; ++i) {
    rates.x() += kStep_s * 2.0;
    const double bandwidth = kBandwidth * std::max(0.0, 1.0 - i / 500.0);
    body.observer.step(kStep_s, bandwidth, rates, Vector3d::Zero());
    if (i >= 500) {
      ASSERT_TRUE(body.observer.moment_frd().isZero(0.0)) << i;
    }
  }
}

// GIVEN bandwidth 0 from the start THEN the first moment of the rotors is none of the disturbance.
TEST(MomentObserver, IsZeroWithoutBandwidth) {
  MomentObserver observer(tests::kaylion().inertia, kLimit_frd);
  for (int i = 0; i < 10; ++i) {
    observer.step(kStep_s, 0.0, {0.1, 0.2, 0.3}, {3.0e-4, 0.0, 0.0});
    EXPECT_TRUE(observer.moment_frd().isZero(0.0));
  }
}

// GIVEN steps of 0.1 s, at which an explicit method diverges THEN it settles within its limits.
TEST(MomentObserver, IsStableAtLongSteps) {
  MomentObserver observer(tests::kaylion().inertia, kLimit_frd);
  const Vector3d rotors(1.0e-4, -2.0e-4, 0.5e-4);
  for (int i = 0; i < 100; ++i) observer.step(0.1, 500.0, {(i == 0 ? 1.0 : 0.0), 0.0, 0.0}, rotors);
  EXPECT_LT((observer.moment_frd() + rotors).norm(), 1.0e-9);
}

TEST(MomentObserver, StaysWithinItsLimits) {
  MomentObserver observer(tests::kaylion().inertia, kLimit_frd);
  for (int i = 0; i < 1000; ++i)
    observer.step(kStep_s, kBandwidth, Vector3d::Zero(), {1.0, -1.0, 0.5 * kLimit_frd.z()});
  EXPECT_LT((observer.moment_frd() - kLimit_frd.cwiseProduct(Vector3d(-1.0, 1.0, -0.5))).norm(), 1.0e-9);
}

}  // namespace swiftlet::control::moment_observer_test
