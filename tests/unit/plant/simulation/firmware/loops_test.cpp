// The loops of the simulated firmware one by one.
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/plant/simulation/firmware/attitude_loop.hpp"
#include "swiftlet/plant/simulation/firmware/gains.hpp"
#include "swiftlet/plant/simulation/firmware/mixer.hpp"
#include "swiftlet/plant/simulation/firmware/position_loop.hpp"
#include "swiftlet/plant/simulation/firmware/rate_loop.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::tests::loops_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;

TEST(RateLoop, IsAPidScaledByTheInertia) {
  const plant::RateGains gains = plant::firmware_gains(kaylion()).rates;
  plant::RateLoop loop(gains, kaylion().inertia);
  const Vector3d wanted(1.0, -2.0, 0.5);
  const Vector3d proportional = kaylion().inertia.diagonal().cwiseProduct(gains.p.cwiseProduct(wanted));
  EXPECT_TRUE(loop.step(wanted, Vector3d::Zero(), kStep_s, false).isApprox(proportional, 1e-12));
  EXPECT_EQ(loop.integral(), Vector3d::Zero()) << "the integral stands still";
  loop.step(wanted, Vector3d::Zero(), kStep_s, true);
  EXPECT_TRUE(loop.integral().isApprox(kStep_s * gains.i.cwiseProduct(wanted), 1e-12));
}

TEST(RateLoop, BrakesARisingRate) {
  plant::RateLoop loop(plant::firmware_gains(kaylion()).rates, kaylion().inertia);
  double rate = 0.0;
  for (int i = 0; i < 50; ++i) loop.step(Vector3d::Zero(), {rate += 0.01, 0.0, 0.0}, kStep_s, false);
  const Vector3d steady = kaylion().inertia.diagonal().cwiseProduct(
      plant::firmware_gains(kaylion()).rates.p.cwiseProduct(Vector3d(-rate, 0.0, 0.0)));
  EXPECT_LT(loop.step(Vector3d::Zero(), {rate + 0.01, 0.0, 0.0}, kStep_s, false).x(), 1.1 * steady.x());
}

TEST(RateLoop, TheIntegralStaysWithinItsLimit) {
  const plant::RateGains gains = plant::firmware_gains(kaylion()).rates;
  plant::RateLoop loop(gains, kaylion().inertia);
  for (int i = 0; i < 5000; ++i) loop.step(Vector3d::Constant(5.0), Vector3d::Zero(), kStep_s, true);
  EXPECT_EQ(loop.integral(), Vector3d::Constant(gains.integral_limit));
}

TEST(AttitudeLoop, TurnsTheShortWay) {
  const plant::AttitudeGains gains = plant::firmware_gains(kaylion()).attitude;
  const plant::AttitudeLoop loop(gains);
  const Quaterniond now = math::rotation(Vector3d(0.3, -0.2, 2.0));
  const Vector3d turn(0.01, -0.02, 0.03);
  const Quaterniond wanted = now * math::rotation(turn);
  const Vector3d expected = gains.p.cwiseProduct(turn);
  EXPECT_TRUE(loop.step(wanted, Vector3d::Zero(), now).isApprox(expected, 1e-3));
  EXPECT_TRUE(loop.step(Quaterniond(-wanted.coeffs()), Vector3d::Zero(), now).isApprox(expected, 1e-3));
}

TEST(AttitudeLoop, FeedsRatesForwardInTheAxesOfTheWantedAttitude) {
  const plant::AttitudeLoop loop(plant::firmware_gains(kaylion()).attitude);
  const Quaterniond level = Quaterniond::Identity();
  const Vector3d ahead(0.4, -0.5, 0.6);
  EXPECT_TRUE(loop.step(level, ahead, level).isApprox(ahead, 1e-12));
  const Quaterniond turned = math::rotation(Vector3d(0.0, 0.0, 0.2));
  const Vector3d difference = loop.step(turned, ahead, level) - loop.step(turned, Vector3d::Zero(), level);
  EXPECT_TRUE(difference.isApprox(turned * ahead, 1e-12));
}

class PositionLoop : public testing::Test {
 protected:
  plant::AttitudeAndThrust step(const plant::TrajectorySetpoint& wanted, bool integrate = false) {
    return loop_.step(wanted, position_, velocity_, Quaterniond::Identity(), kStep_s, integrate);
  }
  plant::PositionGains gains_ = plant::firmware_gains(kaylion()).position;
  plant::PositionLoop loop_{gains_, kaylion().mass_kg};
  Vector3d position_{1.0, 2.0, -1.0};
  Vector3d velocity_ = Vector3d::Zero();
};

TEST_F(PositionLoop, CarriesTheWeightAtTheWantedPosition) {
  plant::TrajectorySetpoint wanted;
  wanted.position_used = true;
  wanted.position_ned = position_;
  wanted.yaw_rad = 0.7;
  const plant::AttitudeAndThrust out = step(wanted);
  EXPECT_NEAR(out.thrust_n, kaylion().mass_kg * plant::kGravity, 1e-12);
  EXPECT_TRUE(out.q_ned_from_frd.isApprox(Quaterniond(Eigen::AngleAxisd(0.7, Vector3d::UnitZ())), 1e-9));
}

TEST_F(PositionLoop, TiltsTowardsTheWantedAcceleration) {
  plant::TrajectorySetpoint wanted;
  wanted.acceleration_ned = {2.0, -1.0, 0.5};
  const plant::AttitudeAndThrust out = step(wanted);
  const Vector3d direction = out.q_ned_from_frd * Vector3d::UnitZ();
  const Vector3d expected = Vector3d(-2.0, 1.0, plant::kGravity - 0.5).normalized();
  EXPECT_TRUE(direction.isApprox(expected, 1e-9));
}

TEST_F(PositionLoop, IgnoresAPositionThatIsNotUsed) {
  plant::TrajectorySetpoint wanted;
  wanted.position_ned = {100.0, 100.0, 100.0};
  EXPECT_NEAR(step(wanted).thrust_n, kaylion().mass_kg * plant::kGravity, 1e-12);
}

TEST_F(PositionLoop, FreeFallAsksForNoThrust) {
  plant::TrajectorySetpoint wanted;
  wanted.acceleration_ned.z() = plant::kGravity;
  EXPECT_NEAR(step(wanted).thrust_n, 0.0, 1e-12);
}

TEST_F(PositionLoop, NeverTiltsBeyondItsLimit) {
  plant::TrajectorySetpoint wanted;
  wanted.position_used = true;
  wanted.position_ned = {50.0, 0.0, 50.0};
  wanted.acceleration_ned.x() = 20.0;
  const Vector3d body_z = step(wanted).q_ned_from_frd * Vector3d::UnitZ();
  EXPECT_LE(std::acos(body_z.z()), gains_.max_tilt_rad + 1e-9);
}

TEST_F(PositionLoop, IntegratesOnlyInFlight) {
  plant::TrajectorySetpoint wanted;
  wanted.velocity_ned = {1.0, 0.0, 0.0};
  step(wanted, false);
  EXPECT_EQ(loop_.integral(), Vector3d::Zero());
  step(wanted, true);
  EXPECT_GT(loop_.integral().x(), 0.0);
  loop_.reset();
  EXPECT_EQ(loop_.integral(), Vector3d::Zero());
}

// The wrench that these throttles give once the rotors are steady.
Eigen::Vector4d wrench_of(const plant::PerRotor& throttle, double voltage_v) {
  plant::RotorThrusts thrusts(kaylion().rotor_count());
  for (int i = 0; i < kaylion().rotor_count(); ++i) {
    thrusts[i] =
        plant::steady_thrust_from_throttle(kaylion(), voltage_v, throttle[static_cast<std::size_t>(i)]);
  }
  return plant::effectiveness(kaylion()) * thrusts;
}

TEST(Mixer, GivesTheWantedWrenchAtAnySupply) {
  const plant::Mixer mixer(kaylion());
  const double weight_n = kaylion().mass_kg * plant::kGravity;
  const Vector3d moment(1e-3, -2e-3, 5e-4);
  for (const double voltage_v : {3.7, 4.1}) {
    const Eigen::Vector4d wrench = wrench_of(mixer.throttles(weight_n, moment, voltage_v), voltage_v);
    EXPECT_NEAR(wrench[0], weight_n, 1e-9);
    EXPECT_TRUE(wrench.tail<3>().isApprox(moment, 1e-6));
  }
}

TEST(Mixer, KeepsMomentsAtTheExpenseOfThrust) {
  const plant::Mixer mixer(kaylion());
  const double most_n = 4.0 * plant::steady_thrust_from_throttle(kaylion(), 4.0, 1.0);
  const Vector3d moment(2e-3, 0.0, 0.0);
  const Eigen::Vector4d wrench = wrench_of(mixer.throttles(most_n, moment, 4.0), 4.0);
  EXPECT_LT(wrench[0], most_n);
  EXPECT_NEAR(wrench[1], moment.x(), 1e-6);
}

}  // namespace swiftlet::tests::loops_test
