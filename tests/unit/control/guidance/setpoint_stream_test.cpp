// Streams of setpoints: each kind, at every rate, within limits and fence.
#include "swiftlet/control/guidance/setpoint_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::setpoint_stream_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

constexpr double kStep_s = 1e-9 * static_cast<double>(SupervisedFlight::kStep_ns);
constexpr double kRounding = 1e-6;

class Stream : public testing::Test, protected SupervisedFlight {
 protected:
  Stream() {
    EXPECT_TRUE(take_off());
    before_ = control_setpoint_.reference;
  }

  // One step. Checks that the reference is continuous up to the acceleration, within limits and fence.
  void step_smoothly() {
    step();
    const Reference& now = control_setpoint_.reference;
    const double acceleration = std::max(allowed_acceleration_, 1e-9);
    ASSERT_LE((now.position_ned - before_.position_ned - kStep_s * before_.velocity_ned).norm(),
              acceleration * kStep_s * kStep_s + kRounding);
    ASSERT_LE((now.velocity_ned - before_.velocity_ned).norm(), acceleration * kStep_s + kRounding);
    ASSERT_LE((now.acceleration_ned - before_.acceleration_ned).norm(), allowed_jerk_ * kStep_s + kRounding)
        << "at " << 1e-9 * static_cast<double>(inputs_.stamp_ns);
    ASSERT_LE(now.acceleration_ned.norm(), allowed_acceleration_ + kRounding);
    ASSERT_LE(now.velocity_ned.norm(), limits_.max_speed + kRounding);
    ASSERT_NO_FATAL_FAILURE(check_promises());
    before_ = now;
  }
  void check_promises() const {
    const Reference& now = control_setpoint_.reference;
    // Braking begins with the acceleration that it finds.
    ASSERT_LE(now.velocity_ned.norm(), limits_.max_speed + std::pow(limits_.max_reference_acceleration, 2) /
                                                               (2.0 * limits_.max_reference_jerk));
    ASSERT_LE(std::abs(now.yaw_rate), limits_.max_yaw_rate * (1.0 + 3e-4));
    for (int i = 0; i < 3; ++i) {
      ASSERT_GE(now.position_ned[i], limits_.fence_min_ned[i]);
      ASSERT_LE(now.position_ned[i], limits_.fence_max_ned[i]);
    }
  }
  // Streams for a duration, with the setpoint of time t each 1/rate_hz.
  template <class Setpoints>
  void stream(double duration_s, double rate_hz, const Setpoints& setpoint_at) {
    const auto steps = static_cast<int>(std::lround(duration_s / kStep_s));
    const auto period = static_cast<int>(std::lround(1.0 / rate_hz / kStep_s));
    for (int i = 0; i < steps; ++i) {
      if (i % period == 0) last_ = supervisor_.setpoint(setpoint_at(i * kStep_s), inputs_);
      ASSERT_NO_FATAL_FAILURE(step_smoothly());
    }
  }
  Outcome send(const Setpoint& setpoint) { return supervisor_.setpoint(setpoint, inputs_); }
  std::string refusal(const Setpoint& setpoint) {
    const Outcome outcome = send(setpoint);
    return outcome.accepted ? "accepted" : outcome.reason;
  }

  const Limits limits_;
  double allowed_acceleration_ = limits_.max_reference_acceleration * (1.0 + 1e-4);
  double allowed_jerk_ = limits_.max_reference_jerk * (1.0 + 1e-4);
  Reference before_;
  Outcome last_;
};

Setpoint of_kind(SetpointKind kind) {
  Setpoint setpoint;
  setpoint.kind = kind;
  setpoint.yaw_free = true;
  setpoint.specific_thrust = plant::kGravity;
  return setpoint;
}

// A circle of 0.5 m with a slow start, 8 s for a turn.
struct Circle {
  static constexpr double kRadius = 0.5, kRate = 2.0 * M_PI / 8.0, kStart_s = 4.0;
  bool velocity = true;
  bool acceleration = true;

  Setpoint operator()(double t) const {
    // The rate rises as (1 - cos) / 2.
    const double phase = M_PI * std::min(t, kStart_s) / kStart_s;
    const double rate = 0.5 * kRate * (1.0 - std::cos(phase));
    const double angle = 0.5 * kRate * (std::min(t, kStart_s) - std::sin(phase) * kStart_s / M_PI) +
                         kRate * std::max(t - kStart_s, 0.0);
    const double rate_change = t < kStart_s ? 0.5 * kRate * M_PI / kStart_s * std::sin(phase) : 0.0;
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0), along(-std::sin(angle), std::cos(angle), 0.0);
    Setpoint setpoint = of_kind(SetpointKind::kPosition);
    setpoint.position_ned = kRadius * (out - Vector3d::UnitX()) - Vector3d::UnitZ();
    if (velocity) setpoint.velocity_ned = kRadius * rate * along;
    if (acceleration) setpoint.acceleration_ned = kRadius * (rate_change * along - rate * rate * out);
    return setpoint;
  }
};

class Rates : public Stream, public testing::WithParamInterface<double> {};

TEST_P(Rates, FollowsPositionsWithDerivativesWithoutLag) {
  const Circle circle;
  double farthest_m = 0.0;
  const auto next = [&](double t) {
    if (t > 1.0) {
      farthest_m =
          std::max(farthest_m, (control_setpoint_.reference.position_ned - circle(t).position_ned).norm());
    }
    return circle(t);
  };
  ASSERT_NO_FATAL_FAILURE(stream(14.0, GetParam(), next));
  EXPECT_EQ(supervisor_.mode(), Mode::kSetpoint);
  EXPECT_LT(farthest_m, GetParam() < 5.0 ? 0.03 : 0.003);
}

TEST_P(Rates, FollowsPositionsAloneSmoothly) {
  const Circle circle{false, false};
  ASSERT_NO_FATAL_FAILURE(stream(14.0, GetParam(), circle));
  EXPECT_EQ(supervisor_.mode(), Mode::kSetpoint);
  EXPECT_LT((control_setpoint_.reference.position_ned - circle(14.0).position_ned).norm(), 0.6);
  ASSERT_TRUE(step_until(Mode::kHolding, 1.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kSetpointsStopped);
}

TEST_P(Rates, SmoothsAStepOfThePosition) {
  Setpoint setpoint = of_kind(SetpointKind::kPosition);
  setpoint.position_ned = {0.6, -0.4, -1.3};
  ASSERT_NO_FATAL_FAILURE(stream(5.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_LT((control_setpoint_.reference.position_ned - setpoint.position_ned).norm(), 1e-3);
  EXPECT_LT(control_setpoint_.reference.velocity_ned.norm(), 1e-3);
}

TEST_P(Rates, ReachesAndKeepsAVelocity) {
  Setpoint setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.velocity_ned = {0.3, -0.2, -0.1};
  ASSERT_NO_FATAL_FAILURE(stream(3.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_LT((control_setpoint_.reference.velocity_ned - setpoint.velocity_ned).norm(), 1e-3);
  EXPECT_LT(
      (control_setpoint_.reference.position_ned - 3.0 * setpoint.velocity_ned + Vector3d::UnitZ()).norm(),
      0.3);
}

TEST_P(Rates, ReachesAndKeepsAnAcceleration) {
  Setpoint setpoint = of_kind(SetpointKind::kAcceleration);
  setpoint.acceleration_ned = {0.0, 0.5, 0.0};
  ASSERT_NO_FATAL_FAILURE(stream(1.5, GetParam(), [&](double) { return setpoint; }));
  EXPECT_LT((control_setpoint_.reference.acceleration_ned - setpoint.acceleration_ned).norm(), 1e-2);
  EXPECT_NEAR(control_setpoint_.reference.velocity_ned.y(), 0.5 * 1.5, 0.2);
}

TEST_P(Rates, StopsAVelocityBeforeTheFence) {
  Setpoint setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.velocity_ned = {0.8, 0.0, 0.0};
  ASSERT_NO_FATAL_FAILURE(stream(12.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_FALSE(last_.accepted);
  EXPECT_GT(control_setpoint_.reference.position_ned.x(), 1.8);
}

TEST_P(Rates, StopsAnAccelerationBelowTheSpeedLimit) {
  Setpoint setpoint = of_kind(SetpointKind::kAcceleration);
  setpoint.acceleration_ned = {1.2, 0.0, 0.0};
  ASSERT_NO_FATAL_FAILURE(stream(6.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_FALSE(last_.accepted) << "must be refused for the speed or for the fence";
  EXPECT_LT(control_setpoint_.reference.velocity_ned.norm(), limits_.max_speed);
}

TEST_P(Rates, TurnsToAHeadingWithinTheYawRate) {
  Setpoint setpoint = of_kind(SetpointKind::kPosition);
  setpoint.position_ned = {0, 0, -1};
  setpoint.yaw_free = false;
  setpoint.yaw_rad = 3.0;
  ASSERT_NO_FATAL_FAILURE(stream(9.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_NEAR(std::remainder(control_setpoint_.reference.yaw_rad - 3.0, 2.0 * M_PI), 0.0, 1e-3);
  setpoint.yaw_rad = -3.0;
  ASSERT_NO_FATAL_FAILURE(stream(0.1, GetParam(), [&](double) { return setpoint; }));
  EXPECT_GT(control_setpoint_.reference.yaw_rate, 0.0) << "the short way, through south";
  ASSERT_NO_FATAL_FAILURE(stream(4.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_NEAR(std::remainder(control_setpoint_.reference.yaw_rad + 3.0, 2.0 * M_PI), 0.0, 1e-3);
  setpoint.yaw_free = true;
  setpoint.yaw_rate = -0.5;
  const double before = control_setpoint_.reference.yaw_rad;
  ASSERT_NO_FATAL_FAILURE(stream(2.0, GetParam(), [&](double) { return setpoint; }));
  EXPECT_NEAR(control_setpoint_.reference.yaw_rad - before, -1.0, 0.3);
}

// Yaw rates and headings at random, each a valid setpoint, of which some arrive late or not at all.
TEST_P(Rates, TurnsWithinTheYawRateWhateverIsStreamed) {
  std::mt19937 random(45);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int flight = 0; flight < 40; ++flight) {
    Setpoint setpoint = of_kind(flight % 2 == 0 ? SetpointKind::kPosition : SetpointKind::kVelocity);
    setpoint.position_ned = {0, 0, -1};
    const double lost = flight % 3 == 0 ? 0.3 : 0.0;
    const auto next = [&](double) {
      if (0.5 * (share(random) + 1.0) < lost) return setpoint;
      const double extreme = share(random) > 0.0 ? 1.0 : std::abs(share(random));
      setpoint.yaw_rate = std::copysign(extreme * limits_.max_yaw_rate, share(random));
      setpoint.yaw_free = share(random) > 0.0;
      setpoint.yaw_rad = 4.0 * share(random);
      return setpoint;
    };
    ASSERT_NO_FATAL_FAILURE(stream(6.0, GetParam(), next)) << "flight " << flight;
    EXPECT_TRUE(last_.accepted) << last_.reason;
    setpoint.yaw_rate = 0.0;
    setpoint.yaw_free = true;
    ASSERT_NO_FATAL_FAILURE(stream(1.0, 100.0, [&](double) { return setpoint; }));
  }
}

// Any kinds, within their limits or not, of which some are lost. What is refused changes nothing.
TEST_P(Rates, KeepsTheLimitsWhateverIsStreamed) {
  std::mt19937 random(46);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const auto vector = [&](double most) -> Vector3d {
    return most * Vector3d(share(random), share(random), share(random));
  };
  const std::array<SetpointKind, 3> kinds{SetpointKind::kPosition, SetpointKind::kVelocity,
                                          SetpointKind::kAcceleration};
  int accepted = 0;
  for (int flight = 0; flight < 12; ++flight) {
    const double lost = flight % 3 == 0 ? 0.3 : 0.0;
    const bool mixes = flight % 2 == 0;
    Setpoint setpoint = of_kind(kinds[static_cast<std::size_t>(flight / 2) % 3]);
    setpoint.position_ned = {0, 0, -1};
    const auto next = [&](double) {
      accepted += last_.accepted ? 1 : 0;
      if (0.5 * (share(random) + 1.0) < lost) return setpoint;
      if (mixes) setpoint.kind = kinds[random() % 3];
      setpoint.position_ned = 0.5 * control_setpoint_.reference.position_ned + vector(0.5);
      setpoint.position_ned.z() -= 0.5;
      setpoint.velocity_ned = vector(0.7 * limits_.max_speed);
      setpoint.acceleration_ned = vector(0.7 * limits_.max_reference_acceleration);
      setpoint.yaw_rate = share(random) * limits_.max_yaw_rate;
      setpoint.yaw_free = share(random) > 0.0;
      setpoint.yaw_rad = 4.0 * share(random);
      return setpoint;
    };
    const auto period = static_cast<int>(std::lround(1.0 / GetParam() / kStep_s));
    for (int i = 0; i < 3000; ++i) {
      if (i % period == 0) last_ = supervisor_.setpoint(next(i * kStep_s), inputs_);
      step();
      ASSERT_NO_FATAL_FAILURE(check_promises()) << "flight " << flight;
    }
  }
  EXPECT_GT(accepted, 30);
}

// Both ways as fast as allowed, which a path to the heading after the time would overshoot.
TEST_P(Rates, ReversesWithinTheYawRate) {
  Setpoint setpoint = of_kind(SetpointKind::kPosition);
  setpoint.position_ned = {0, 0, -1};
  const auto next = [&](double t) {
    setpoint.yaw_rate = static_cast<int>(t) % 2 == 0 ? 1.4 : -1.4;
    return setpoint;
  };
  ASSERT_NO_FATAL_FAILURE(stream(8.0, GetParam(), next));
  EXPECT_TRUE(last_.accepted) << last_.reason;
}

INSTANTIATE_TEST_SUITE_P(Hz, Rates, testing::Values(2.0, 5.0, 20.0, 100.0, 500.0));

// The blend takes the minimum of 0.1 s, since no setpoint before it gives an interval. The fence check uses
// the same path.
TEST_F(Stream, BlendsIntoTheFirstSetpointWithoutDelay) {
  Setpoint setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.velocity_ned = {0.005, 0.0, 0.0};
  ASSERT_TRUE(send(setpoint).accepted);
  const auto steps = static_cast<int>(std::lround(0.1 / kStep_s));
  for (int i = 0; i < steps; ++i) ASSERT_NO_FATAL_FAILURE(step_smoothly());
  EXPECT_NEAR(control_setpoint_.reference.velocity_ned.x(), 0.005, 1e-6);
}

TEST_F(Stream, BlendsIntoTheFirstSetpointAfterAPauseWithoutDelay) {
  Setpoint setpoint = of_kind(SetpointKind::kPosition);
  setpoint.position_ned = control_setpoint_.reference.position_ned;
  ASSERT_TRUE(send(setpoint).accepted);
  ASSERT_TRUE(step_until(Mode::kHolding, 2.0));
  setpoint.position_ned = control_setpoint_.reference.position_ned + Vector3d(2e-5, 0.0, 0.0);
  before_ = control_setpoint_.reference;
  ASSERT_TRUE(send(setpoint).accepted);
  const auto steps = static_cast<int>(std::lround(0.1 / kStep_s));
  for (int i = 0; i < steps; ++i) ASSERT_NO_FATAL_FAILURE(step_smoothly());
  EXPECT_NEAR(control_setpoint_.reference.position_ned.x(), setpoint.position_ned.x(), 1e-7);
}

// A slow sine in x at 500 Hz, so small that the limits lengthen no blend.
class Sine : public Stream {
 protected:
  static constexpr double kAmplitude = 0.002, kRate = 2.0 * M_PI / 10.0;

  // From the first harmonic of the reference over the second period.
  double lag_s(bool with_derivatives) {
    double in_phase = 0.0, behind = 0.0;
    const auto next = [&](double t) {
      const double x = control_setpoint_.reference.position_ned.x();
      if (t >= 10.0) in_phase += x * std::sin(kRate * t), behind -= x * std::cos(kRate * t);
      Setpoint setpoint = of_kind(SetpointKind::kPosition);
      setpoint.position_ned = {kAmplitude * std::sin(kRate * t), 0.0, -1.0};
      if (with_derivatives) {
        setpoint.velocity_ned.x() = kAmplitude * kRate * std::cos(kRate * t);
        setpoint.acceleration_ned.x() = -kAmplitude * kRate * kRate * std::sin(kRate * t);
      }
      return setpoint;
    };
    stream(20.0, 1.0 / kStep_s, next);
    return std::atan2(behind, in_phase) / kRate;
  }
};

// The error of a blend over t obeys s^3 + 9/t s^2 + 36/t^2 s + 60/t^3, which lags by 36/60 t.
TEST_F(Sine, OfPositionsAloneLagsByThreeFifthsOfTheBlendTime) { EXPECT_NEAR(lag_s(false), 0.06, 0.003); }

TEST_F(Sine, OfPositionsWithDerivativesDoesNotLag) { EXPECT_NEAR(lag_s(true), 0.0, 0.003); }

TEST_F(Stream, ReferenceIsContinuousBetweenKinds) {
  Setpoint velocity = of_kind(SetpointKind::kVelocity);
  velocity.velocity_ned = {0.4, 0, 0};
  Setpoint acceleration = of_kind(SetpointKind::kAcceleration);
  acceleration.acceleration_ned = {0, 0.4, 0};
  ASSERT_NO_FATAL_FAILURE(stream(1.0, 20.0, [&](double) { return velocity; }));
  ASSERT_NO_FATAL_FAILURE(stream(0.6, 20.0, [&](double) { return acceleration; }));
  Setpoint place = of_kind(SetpointKind::kPosition);
  place.position_ned = control_setpoint_.reference.position_ned;
  ASSERT_NO_FATAL_FAILURE(stream(4.0, 20.0, [&](double) { return place; }));
  EXPECT_LT((control_setpoint_.reference.position_ned - place.position_ned).norm(), 1e-3);
}

TEST_F(Stream, StandbyContinuesTheStream) {
  for (const SetpointKind kind :
       {SetpointKind::kPosition, SetpointKind::kVelocity, SetpointKind::kAcceleration,
        SetpointKind::kAttitude, SetpointKind::kBodyRates}) {
    SCOPED_TRACE(static_cast<int>(kind));
    SupervisedFlight flight;
    ASSERT_TRUE(flight.take_off());
    Setpoint setpoint = of_kind(kind);
    setpoint.position_ned = {0.2, 0, -1};
    setpoint.velocity_ned = {0.2, 0, 0};
    setpoint.acceleration_ned = {0.1, 0, 0};
    setpoint.q_ned_from_frd = Eigen::AngleAxisd(0.1, Vector3d::UnitX());
    setpoint.body_rates_frd = {0.1, 0.2, 0.3};
    ASSERT_TRUE(flight.supervisor_.setpoint(setpoint, flight.inputs_).accepted);
    for (int i = 0; i < 100; ++i) flight.step();
    Supervisor standby({});
    standby.adopt(flight.supervisor_.state(), nullptr, nullptr);
    for (int i = 0; i < 400; ++i) {
      flight.step();
      const ControlSetpoint theirs = standby.step(flight.inputs_);
      ASSERT_EQ(theirs.control_mode, flight.control_setpoint_.control_mode);
      ASSERT_EQ(theirs.reference.position_ned, flight.control_setpoint_.reference.position_ned);
      ASSERT_EQ(theirs.q_ned_from_frd.coeffs(), flight.control_setpoint_.q_ned_from_frd.coeffs());
      ASSERT_EQ(theirs.body_rates_frd, flight.control_setpoint_.body_rates_frd);
      ASSERT_EQ(theirs.specific_thrust, flight.control_setpoint_.specific_thrust);
    }
    EXPECT_EQ(standby.reason(), Reason::kSetpointsStopped);
  }
}

TEST_F(Stream, RefusesValuesBeyondALimitAndNamesBoth) {
  const double nan = std::nan("");
  Setpoint setpoint = of_kind(SetpointKind::kPosition);
  setpoint.position_ned = {0, 0, -2.6};
  EXPECT_EQ(refusal(setpoint), "setpoint: z is -2.600 m, outside the fence of -2.500 to 0.000 m");
  setpoint.position_ned = {1.5, 0, -1};
  EXPECT_EQ(refusal(setpoint), "setpoint: 1.50 m away from the vehicle, the limit is 1.00 m");
  setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.velocity_ned = {2.5, 0, 0};
  EXPECT_EQ(refusal(setpoint), "setpoint: speed is 2.50 m/s, the limit is 2.00 m/s");
  setpoint.velocity_ned = {nan, 0, 0};
  EXPECT_EQ(refusal(setpoint), "setpoint: a value is not a finite number");
  setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.yaw_rate = -1.6;
  EXPECT_EQ(refusal(setpoint), "setpoint: yaw rate is -1.60 rad/s, the limit is 1.50 rad/s");
  setpoint = of_kind(SetpointKind::kAcceleration);
  setpoint.acceleration_ned = {0, 6, 0};
  EXPECT_EQ(refusal(setpoint), "setpoint: acceleration is 6.00 m/s^2, the limit is 5.00 m/s^2");
  setpoint = of_kind(SetpointKind::kAttitude);
  setpoint.q_ned_from_frd = Eigen::AngleAxisd(0.7, Vector3d::UnitY());
  EXPECT_EQ(refusal(setpoint), "setpoint: tilt is 0.70 rad, the limit is 0.60 rad");
  setpoint.q_ned_from_frd = Eigen::Quaterniond(0.9, 0, 0, 0);
  EXPECT_EQ(refusal(setpoint), "setpoint: the attitude is not a unit quaternion");
  setpoint = of_kind(SetpointKind::kAttitude);
  setpoint.specific_thrust = 15.0;
  EXPECT_EQ(refusal(setpoint), "setpoint: thrust is 15.00 m/s^2, must be at least 0 and at most 14.81 m/s^2");
  setpoint.specific_thrust = nan;
  EXPECT_NE(refusal(setpoint), "accepted");
  setpoint = of_kind(SetpointKind::kBodyRates);
  setpoint.body_rates_frd = {0, 0, 6.5};
  EXPECT_EQ(refusal(setpoint), "setpoint: body rate is 6.50 rad/s, the limit is 6.00 rad/s");
  setpoint.body_rates_frd = {nan, 0, 0};
  EXPECT_NE(refusal(setpoint), "accepted");
  setpoint.kind = static_cast<SetpointKind>(9);
  EXPECT_EQ(refusal(setpoint), "setpoint: unknown kind 9");
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding) << "no refused setpoint may be applied";
}

TEST_F(Stream, IgnoresFieldsThatAKindDoesNotUse) {
  Setpoint setpoint = of_kind(SetpointKind::kAttitude);
  setpoint.position_ned = {99, 99, 99};
  setpoint.velocity_ned = {99, 99, 99};
  EXPECT_EQ(refusal(setpoint), "accepted");
  setpoint = of_kind(SetpointKind::kVelocity);
  setpoint.position_ned = {99, 99, 99};
  setpoint.specific_thrust = -1.0;
  EXPECT_EQ(refusal(setpoint), "accepted");
}

}  // namespace swiftlet::control::setpoint_stream_test
