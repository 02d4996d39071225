#include "swiftlet/plant/model/airframe.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "swiftlet/math/linear_algebra.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::airframe_test {

using tests::kaylion;
using tests::multirotor;
using tests::UniformRandom;

TEST(Airframe, KayLionMatchesEquations27And28) {
  UniformRandom draw;
  const double d = 0.0695 / std::sqrt(2.0);
  const RotorCoefficients& rotor = kaylion().rotor;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector4d speeds(draw(0, 2500), draw(0, 2500), draw(0, 2500), draw(0, 2500));
    Eigen::Vector4d t;
    Eigen::Vector4d q;
    for (int r = 0; r < 4; ++r) {
      t[r] = thrust_from_speed(rotor, speeds[r]);
      q[r] = torque_from_speed(rotor, speeds[r]);
    }
    const Eigen::Vector4d wrench = effectiveness(kaylion()) * t;
    EXPECT_NEAR(wrench[0], t.sum(), 1e-14);
    EXPECT_NEAR(wrench[1], d * (-t[0] + t[1] + t[2] - t[3]), 1e-14);
    EXPECT_NEAR(wrench[2], d * (t[0] + t[1] - t[2] - t[3]), 1e-14);
    EXPECT_NEAR(wrench[3], q[0] - q[1] + q[2] - q[3], 1e-14);
  }
}

TEST(Airframe, MomentsAreLeverTimesForce) {
  // For any geometry: the column of a rotor is its position x (0, 0, -T), plus its torque.
  UniformRandom draw;
  for (int count = kMinRotors; count <= kMaxRotors; ++count) {
    Vehicle vehicle = multirotor(count);
    for (RotorMount& mount : vehicle.rotors)
      mount.position_frd += 0.02 * Eigen::Vector3d(draw(-1, 1), draw(-1, 1), draw(-1, 1));
    const Effectiveness e = effectiveness(vehicle);
    ASSERT_EQ(e.cols(), count);
    for (int i = 0; i < count; ++i) {
      const RotorMount& mount = vehicle.rotors[static_cast<std::size_t>(i)];
      const Eigen::Vector3d moment = mount.position_frd.cross(Eigen::Vector3d(0.0, 0.0, -1.0));
      const double sign = mount.spin == Spin::kCounterClockwise ? 1.0 : -1.0;
      EXPECT_EQ(e(0, i), 1.0);
      EXPECT_NEAR(e(1, i), moment.x(), 1e-15);
      EXPECT_NEAR(e(2, i), moment.y(), 1e-15);
      EXPECT_NEAR(e(3, i), sign * 1.8623e-10 / 3.7901e-8, 1e-15);
    }
  }
}

TEST(Airframe, HoverThrustIsAnEqualShareOfTheWeight) {
  for (int count = kMinRotors; count <= kMaxRotors; ++count) {
    const Vehicle vehicle = multirotor(count);
    EXPECT_NEAR(count * hover_thrust(vehicle), vehicle.mass_kg * kGravity, 1e-15);
    EXPECT_NEAR(thrust_from_speed(vehicle.rotor, hover_speed(vehicle)), hover_thrust(vehicle), 1e-15);
  }
}

TEST(Airframe, TrimBalancesTheWeightWithoutAMoment) {
  UniformRandom draw;
  for (int count = kMinRotors; count <= kMaxRotors; ++count) {
    Vehicle vehicle = multirotor(count);
    if (count % 2 == 1) vehicle.rotors.back().spin = Spin::kClockwise;  // equal to its neighbour
    const Eigen::Vector3d off_centre(draw(-0.01, 0.01), draw(-0.01, 0.01), 0.0);
    for (RotorMount& mount : vehicle.rotors) mount.position_frd += off_centre;
    const RotorThrusts trim = trim_thrusts(vehicle);
    ASSERT_EQ(trim.size(), count);
    const Eigen::Vector4d wrench = effectiveness(vehicle) * trim;
    EXPECT_NEAR(wrench[0], vehicle.mass_kg * kGravity, 1e-12);
    EXPECT_NEAR(wrench.tail<3>().norm(), 0.0, 1e-13);
    // Least squares: the trim lies in the row space of the effectiveness.
    const Eigen::MatrixXd e = effectiveness(vehicle);
    const Eigen::VectorXd within = e.transpose() * math::solve_positive_definite(e * e.transpose(), e * trim);
    EXPECT_NEAR((within - trim).norm(), 0.0, 1e-10);
  }
}

}  // namespace swiftlet::plant::airframe_test
