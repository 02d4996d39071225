#include "swiftlet/control/estimation/moment_observer.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
constexpr double kBandwidth = 20.0;  // rad/s

// A body that rotor moments and a disturbance turn, Eq. (6), and its observer. Integrated as the observer does.
struct Body {
  Eigen::Matrix3d inertia = tests::kaylion().inertia;
  Vector3d rates{0.5, -0.3, 0.2};
  MomentObserver observer{inertia};

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

}  // namespace
}  // namespace swiftlet::control
