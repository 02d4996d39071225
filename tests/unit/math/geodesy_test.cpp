#include "swiftlet/math/geodesy.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace swiftlet::math::geodesy_test {

TEST(Geodesy, MatchesTheWgs84Ellipsoid) {
  // A degree of latitude and of longitude at 45 deg north, WGS 84: 111,132 m and 78,847 m.
  const GeographicPosition home{45.0, 179.9999};
  EXPECT_NEAR(north_east_of(home, {45.01, 179.9999}).x(), 1111.32, 0.05);
  EXPECT_NEAR(north_east_of(home, {45.0, -179.9901}).y(), 788.47, 0.05);  // across the date line
  EXPECT_NEAR(north_east_of(home, {44.99, 179.9999}).x(), -1111.32, 0.05);
}

TEST(Geodesy, PositionAtIsTheInverse) {
  const GeographicPosition homes[] = {{47.4, 8.5}, {-33.9, 151.2}, {0.0, 179.9999}, {60.0, -180.0}};
  for (const GeographicPosition& home : homes) {
    for (const Eigen::Vector2d& north_east :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(120.0, -80.0), Eigen::Vector2d(-950.0, 730.0)}) {
      const GeographicPosition position = position_at(home, north_east);
      EXPECT_LE(std::abs(position.longitude_deg), 180.0);
      EXPECT_LT((north_east_of(home, position) - north_east).norm(), 1e-6);
    }
  }
}

}  // namespace swiftlet::math::geodesy_test
