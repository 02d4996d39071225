#include "swiftlet/identification/fitting/inertia_triangle_inequality.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace swiftlet::identification::inertia_triangle_inequality_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Variances = std::array<std::optional<double>, 3>;

constexpr double kUnit = 1e-5;  // kg m^2

Matrix3d inertia_of(double xx, double yy, double zz) {
  Matrix3d inertia = (kUnit * Vector3d(xx, yy, zz)).asDiagonal();
  inertia(0, 1) = inertia(1, 0) = 0.1 * kUnit;
  return inertia;
}
double variance(double deviation) { return std::pow(deviation * kUnit, 2); }

TEST(InertiaTriangleInequality, KeepsAValidInertia) {
  Matrix3d inertia = inertia_of(4.4, 4.5, 8.89);
  const Matrix3d before = inertia;
  EXPECT_FALSE(
      enforce_triangle_inequality(inertia, {variance(1.0), variance(1.0), variance(1.0)}).has_value());
  EXPECT_FALSE(enforce_triangle_inequality(inertia, {std::nullopt, std::nullopt, variance(1.0)}).has_value());
  EXPECT_EQ(inertia, before);
}

TEST(InertiaTriangleInequality, KeepsMomentsThatWereAllGiven) {
  Matrix3d inertia = inertia_of(4.0, 5.0, 12.0);
  const Matrix3d before = inertia;
  EXPECT_FALSE(enforce_triangle_inequality(inertia, {}).has_value());
  EXPECT_EQ(inertia, before);
}

// For each axis: an excess of 3 is distributed to the two others in proportion to their squares, 16 to 25.
TEST(InertiaTriangleInequality, AdaptsTheMomentsThatWereNotIdentified) {
  for (int largest = 0; largest < 3; ++largest) {
    const int small = (largest + 1) % 3;
    const int middle = (largest + 2) % 3;
    Vector3d moments;
    moments[largest] = 12.0;
    moments[small] = 4.0;
    moments[middle] = 5.0;
    Matrix3d inertia = inertia_of(moments[0], moments[1], moments[2]);
    Variances variances;
    variances[static_cast<std::size_t>(largest)] = variance(1e-3);
    const auto said = enforce_triangle_inequality(inertia, variances);
    ASSERT_TRUE(said.has_value()) << largest;
    EXPECT_EQ(said->rfind(largest == 0   ? "inertia.xx"
                          : largest == 1 ? "inertia.yy"
                                         : "inertia.zz",
                          0),
              0U)
        << *said;
    EXPECT_DOUBLE_EQ(inertia(largest, largest), 12.0 * kUnit);
    EXPECT_NEAR(inertia(small, small), (4.0 + 3.0 * 16.0 / 41.0) * kUnit, 1e-12 * kUnit);
    EXPECT_NEAR(inertia(middle, middle), (5.0 + 3.0 * 25.0 / 41.0) * kUnit, 1e-12 * kUnit);
    EXPECT_EQ(inertia(0, 1), 0.1 * kUnit);
  }
}

// GIVEN roll and pitch identified and a yaw moment of the base
TEST(InertiaTriangleInequality, LowersALargestMomentThatWasNotIdentified) {
  Matrix3d inertia = inertia_of(4.0, 5.0, 12.0);
  ASSERT_TRUE(enforce_triangle_inequality(inertia, {variance(0.1), variance(0.1), std::nullopt}).has_value());
  EXPECT_DOUBLE_EQ(inertia(0, 0), 4.0 * kUnit);
  EXPECT_DOUBLE_EQ(inertia(1, 1), 5.0 * kUnit);
  EXPECT_NEAR(inertia(2, 2), 9.0 * kUnit, 1e-12 * kUnit);
}

// No valid inertia is nearer to the identified one, in its standard deviations.
TEST(InertiaTriangleInequality, TakesTheNearestWhenAllWereIdentified) {
  const Vector3d deviation(0.3, 0.6, 0.2);
  const Vector3d identified(4.4, 4.5, 9.4);
  Matrix3d inertia = inertia_of(identified[0], identified[1], identified[2]);
  ASSERT_TRUE(
      enforce_triangle_inequality(inertia, {variance(0.3), variance(0.6), variance(0.2)}).has_value());
  const Vector3d found = inertia.diagonal() / kUnit;
  EXPECT_NEAR(found[2], found[0] + found[1], 1e-9);
  const auto distance = [&](const Vector3d& at) { return (at - identified).cwiseQuotient(deviation).norm(); };
  std::mt19937 generator(4);
  std::normal_distribution<double> normal(0.0, 0.3);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d other = found + Vector3d(normal(generator), normal(generator), normal(generator));
    const bool possible = other[2] <= other[0] + other[1];
    EXPECT_TRUE(!possible || distance(other) >= distance(found)) << other.transpose();
  }
}

// An excess of 0.5 is corrected if it is at most 4 standard deviations of the sum, and kept otherwise.
TEST(InertiaTriangleInequality, KeepsAViolationBeyondFourDeviations) {
  const double just_enough = 0.5 / 4.0 / std::sqrt(3.0);
  for (const double factor : {0.99, 1.01}) {
    Matrix3d inertia = inertia_of(4.4, 4.5, 9.4);
    const double v = variance(factor * just_enough);
    EXPECT_EQ(enforce_triangle_inequality(inertia, {v, v, v}).has_value(), factor > 1.0);
    EXPECT_EQ(inertia(2, 2) == 9.4 * kUnit, factor < 1.0);
  }
}

}  // namespace swiftlet::identification::inertia_triangle_inequality_test
