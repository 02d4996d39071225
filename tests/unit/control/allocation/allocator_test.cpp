#include "swiftlet/control/allocation/allocator.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::allocator_test {

using Eigen::Vector2d;
using Eigen::Vector3d;
using plant::PerRotor;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// The wrench that the vehicle gives in the steady state under these throttles, by the forward model.
Wrench forward(const plant::Vehicle& vehicle, const PerRotor& throttle, double supply) {
  const plant::Effectiveness e = plant::effectiveness(vehicle);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int i = 0; i < vehicle.rotor_count(); ++i) {
    sum +=
        e.col(i) * plant::steady_thrust_from_throttle(vehicle, supply, throttle[static_cast<std::size_t>(i)]);
  }
  return {sum[0], sum.tail<3>()};
}

// KayLion's frame with one arm longer than the others and its hub lower, so that nothing is symmetric.
plant::Vehicle lopsided() {
  plant::Vehicle vehicle = tests::kaylion();
  vehicle.rotors[0].position_frd = {0.070, 0.055, -0.004};
  vehicle.rotors[2].position_frd = {-0.050, -0.045, 0.002};
  return vehicle;
}

class AllocatorTest : public testing::TestWithParam<int> {
 protected:
  AllocatorTest() {
    vehicle_ = GetParam() == 0   ? lopsided()
               : GetParam() == 4 ? tests::kaylion()
                                 : tests::multirotor(GetParam());
    count_ = vehicle_.rotor_count();
    effectiveness_ = plant::effectiveness(vehicle_);
    pseudo_inverse_ = effectiveness_.transpose() * (effectiveness_ * effectiveness_.transpose()).inverse();
  }

  double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  // A wrench whose pseudo-inverse solution is feasible at this supply, often close to the limits.
  Wrench feasible(double supply) {
    const plant::ThrustRange range = plant::steady_thrust_range(vehicle_, supply);
    while (true) {
      Eigen::VectorXd thrusts(count_);
      for (double& t : thrusts)
        t = std::clamp(draw(range.min - 0.05, range.max + 0.05), range.min, range.max);
      const Eigen::Vector4d w = effectiveness_ * thrusts;
      const Eigen::VectorXd t = pseudo_inverse_ * w;
      if (t.minCoeff() >= range.min && t.maxCoeff() <= range.max) return {w[0], w.tail<3>()};
    }
  }

  plant::Vehicle vehicle_;
  int count_ = 0;
  Eigen::MatrixXd effectiveness_, pseudo_inverse_;
  std::mt19937 generator_{6};
};

Allocation allocate(const Allocator& allocator, const Wrench& wanted, double supply_voltage_v) {
  return allocator.allocate(wanted, allocator.supply_at(supply_voltage_v));
}

INSTANTIATE_TEST_SUITE_P(Rotors, AllocatorTest, testing::Values(0, 4, 5, 6, 7, 8), [](const auto& rotors) {
  return rotors.param == 0 ? "Lopsided4" : "Even" + std::to_string(rotors.param);
});

constexpr double kTolerance = 1e-10;  // N and N m

TEST_P(AllocatorTest, InvertsTheModelExactlyIfFeasible) {
  const Allocator allocator(vehicle_);
  for (int trial = 0; trial < 1000; ++trial) {
    const double supply = draw(3.3, 4.3);
    const Wrench wanted = feasible(supply);
    const Allocation a = allocate(allocator, wanted, supply);
    EXPECT_FALSE(a.saturated);
    EXPECT_FALSE(a.invalid_input);
    const Wrench got = forward(vehicle_, a.throttle, supply);
    EXPECT_NEAR(got.thrust_n, wanted.thrust_n, kTolerance);
    EXPECT_LT((got.moment_frd - wanted.moment_frd).norm(), kTolerance);
  }
}

TEST_P(AllocatorTest, IsFiniteWithinLimitsAndReportsSaturation) {
  const Allocator allocator(vehicle_);
  const double odd[] = {kNaN, kInf, -kInf, 0.0, -0.0, 1e308, -1e308, 1e-308, 1.0, -5.0};
  const auto any = [&](double size) {
    const double pick = draw(0.0, 1.0);
    if (pick < 0.15) return odd[static_cast<std::size_t>(draw(0.0, 9.999))];
    return pick < 0.4 ? draw(-1e3, 1e3) : draw(-size, size);
  };
  for (int trial = 0; trial < 20000; ++trial) {
    const Wrench wanted{any(1.0), {any(0.03), any(0.03), any(0.005)}};
    const double supply = draw(0.0, 1.0) < 0.8 ? draw(3.3, 4.3) : any(5.0);
    const Allocation a = allocate(allocator, wanted, supply);

    const Allocator::SupplyRange& plausible = allocator.plausible_supply();
    const bool supply_valid = supply >= plausible.min && supply <= plausible.max;
    const bool wrench_valid = std::isfinite(wanted.thrust_n) && wanted.moment_frd.allFinite();
    EXPECT_EQ(a.invalid_input, !(supply_valid && wrench_valid));

    for (int i = 0; i < plant::kMaxRotors; ++i) {
      const double throttle = a.throttle[static_cast<std::size_t>(i)];
      ASSERT_TRUE(throttle >= 0.0 && throttle <= 1.0) << "rotor " << i << " of trial " << trial;
      if (i >= count_) {
        EXPECT_EQ(throttle, 0.0);
      }
    }
    const Wrench got = forward(vehicle_, a.throttle, supply_valid ? supply : plausible.assumed);
    EXPECT_NEAR(got.thrust_n, allocator.wrench(a.thrust_n).thrust_n, kTolerance);
    EXPECT_LT((got.moment_frd - allocator.wrench(a.thrust_n).moment_frd).norm(), kTolerance);
    if (wrench_valid) {
      const bool met = std::abs(got.thrust_n - wanted.thrust_n) < kTolerance &&
                       (got.moment_frd - wanted.moment_frd).norm() < kTolerance;
      EXPECT_EQ(a.saturated, !met) << "trial " << trial;
    }
  }
}

// The wanted wrench has roll and pitch moment of a feasible one, and any thrust and yaw moment.
TEST_P(AllocatorTest, PrioritisesRollAndPitchOverThrustAndYaw) {
  const Allocator allocator(vehicle_);
  for (int trial = 0; trial < 5000; ++trial) {
    const double supply = draw(3.3, 4.3);
    const Wrench known = feasible(supply);
    Wrench wanted = known;
    wanted.thrust_n = draw(-0.5, 1.5) * count_ / 4.0;
    wanted.moment_frd.z() = draw(-0.01, 0.01);
    const Wrench got = allocator.wrench(allocate(allocator, wanted, supply).thrust_n);
    EXPECT_LT((got.moment_frd - wanted.moment_frd).head<2>().norm(), kTolerance);
    // The thrust error is no larger than that of the feasible wrench.
    EXPECT_LE(std::abs(got.thrust_n - wanted.thrust_n),
              std::abs(known.thrust_n - wanted.thrust_n) + kTolerance);
  }
}

TEST_P(AllocatorTest, PrioritisesThrustOverYaw) {
  const Allocator allocator(vehicle_);
  for (int trial = 0; trial < 5000; ++trial) {
    const double supply = draw(3.3, 4.3);
    const Wrench known = feasible(supply);
    Wrench wanted = known;
    wanted.moment_frd.z() = draw(-0.01, 0.01);
    const Wrench got = allocator.wrench(allocate(allocator, wanted, supply).thrust_n);
    EXPECT_LT((got.moment_frd - wanted.moment_frd).head<2>().norm(), kTolerance);
    EXPECT_NEAR(got.thrust_n, wanted.thrust_n, kTolerance);
    EXPECT_LE(std::abs(got.moment_frd.z() - wanted.moment_frd.z()),
              std::abs(known.moment_frd.z() - wanted.moment_frd.z()) + kTolerance);
  }
}

TEST_P(AllocatorTest, KeepsTheDirectionOfSaturatedRollAndPitch) {
  const Allocator allocator(vehicle_);
  for (int trial = 0; trial < 5000; ++trial) {
    const double supply = draw(3.3, 4.3);
    const Wrench known = feasible(supply);
    const Vector2d tilt = known.moment_frd.head<2>();
    Wrench wanted{draw(-0.5, 1.5) * count_ / 4.0, {0.0, 0.0, draw(-0.01, 0.01)}};
    wanted.moment_frd.head<2>() = draw(1.0, 10.0) * tilt;
    const Vector2d got = allocator.wrench(allocate(allocator, wanted, supply).thrust_n).moment_frd.head<2>();
    EXPECT_LE(std::abs(got.x() * tilt.y() - got.y() * tilt.x()), kTolerance * tilt.norm());
    EXPECT_GE(got.dot(tilt), tilt.squaredNorm() - kTolerance);
    EXPECT_LE(got.norm(), wanted.moment_frd.head<2>().norm() + kTolerance);
  }
}

TEST(Allocator, MatchesTheHoverAnchors) {
  plant::Vehicle vehicle = tests::kaylion();
  vehicle.mass_kg = 0.040;
  const Allocator allocator(vehicle);
  const Wrench hover{0.040 * plant::kGravity, Vector3d::Zero()};
  EXPECT_NEAR(allocate(allocator, hover, 3.6).throttle[0], 0.417, 1e-3);
  EXPECT_NEAR(allocate(allocator, hover, 3.7).throttle[1], 0.394, 1e-3);
  EXPECT_NEAR(allocate(allocator, hover, 4.2).throttle[3], 0.306, 1e-3);
}

TEST(Allocator, MomentsChangeTheThrustsAsInEq28) {
  const Allocator allocator(tests::kaylion());
  const auto thrusts = [&](const Vector3d& moment) {
    return allocate(allocator, {0.4, moment}, 3.9).thrust_n;
  };
  const PerRotor roll = thrusts({1e-3, 0.0, 0.0});  // -T1 + T2 + T3 - T4
  EXPECT_TRUE(roll[0] < 0.1 && roll[1] > 0.1 && roll[2] > 0.1 && roll[3] < 0.1);
  const PerRotor pitch = thrusts({0.0, 1e-3, 0.0});  // T1 + T2 - T3 - T4
  EXPECT_TRUE(pitch[0] > 0.1 && pitch[1] > 0.1 && pitch[2] < 0.1 && pitch[3] < 0.1);
  const PerRotor yaw = thrusts({0.0, 0.0, 1e-4});  // Q1 - Q2 + Q3 - Q4
  EXPECT_TRUE(yaw[0] > 0.1 && yaw[1] < 0.1 && yaw[2] > 0.1 && yaw[3] < 0.1);
}

TEST(Allocator, ClampsThrustWithoutMoments) {
  const plant::Vehicle& vehicle = tests::kaylion();
  const Allocator allocator(vehicle);
  const plant::ThrustRange range = plant::steady_thrust_range(vehicle, 3.7);
  const Allocation full = allocate(allocator, {2.0, Vector3d::Zero()}, 3.7);
  EXPECT_TRUE(full.saturated);
  EXPECT_NEAR(allocator.wrench(full.thrust_n).thrust_n, 4.0 * range.max, kTolerance);
  EXPECT_NEAR(allocator.wrench(full.thrust_n).thrust_n, 0.743, 5e-4);
  EXPECT_LT(allocator.wrench(full.thrust_n).moment_frd.norm(), kTolerance);
  const Allocation none = allocate(allocator, {0.0, Vector3d::Zero()}, 3.7);
  EXPECT_TRUE(none.saturated);  // throttle 0 is not zero thrust
  EXPECT_NEAR(allocator.wrench(none.thrust_n).thrust_n, 4.0 * range.min, kTolerance);
  EXPECT_LT(allocator.wrench(none.thrust_n).moment_frd.norm(), kTolerance);
}

TEST(Allocator, ReplacesInvalidInput) {
  const plant::Vehicle& vehicle = tests::kaylion();
  const Allocator allocator(vehicle);
  const double weight = vehicle.mass_kg * plant::kGravity;
  const Vector3d moment(2e-3, -1e-3, 1e-4);
  const double assumed = allocator.plausible_supply().assumed;
  const auto same = [](const Allocation& a, const Allocation& b) {
    EXPECT_TRUE(a.invalid_input);
    EXPECT_FALSE(b.invalid_input);
    EXPECT_EQ(a.throttle, b.throttle);
  };
  same(allocate(allocator, {kNaN, moment}, 3.8), allocate(allocator, {weight, moment}, 3.8));
  same(allocate(allocator, {kInf, moment}, 3.8), allocate(allocator, {weight, moment}, 3.8));
  same(allocate(allocator, {0.4, {kNaN, -1e-3, -kInf}}, 3.8),
       allocate(allocator, {0.4, {0.0, -1e-3, 0.0}}, 3.8));
  for (const double supply : {0.0, -4.0, 1.0, 40.0, kNaN, kInf}) {
    same(allocate(allocator, {0.4, moment}, supply), allocate(allocator, {0.4, moment}, assumed));
  }
}

TEST(Allocator, RefusesRotorsThatCannotGiveAllMoments) {
  plant::Vehicle vehicle = tests::kaylion();
  for (plant::RotorMount& mount : vehicle.rotors) mount.spin = plant::Spin::kClockwise;
  EXPECT_THROW(Allocator{vehicle}, std::invalid_argument);
  vehicle = tests::kaylion();
  for (plant::RotorMount& mount : vehicle.rotors) mount.position_frd.x() = 0.0;
  EXPECT_THROW(Allocator{vehicle}, std::invalid_argument);
  vehicle = tests::kaylion();
  vehicle.rotors.pop_back();
  EXPECT_THROW(Allocator{vehicle}, std::invalid_argument);
  vehicle = tests::kaylion();
  vehicle.battery.open_circuit_voltage_v.clear();
  EXPECT_THROW(Allocator{vehicle}, std::invalid_argument);
}

}  // namespace swiftlet::control::allocator_test
