#include "swiftlet/io/missions/geodesy.hpp"

#include <cmath>

namespace swiftlet::ground {

Eigen::Vector2d north_east_of(const GeographicPosition& home, const GeographicPosition& position) {
  constexpr double kEquatorialRadius_m = 6378137.0;
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);
  constexpr double kRadPerDeg = M_PI / 180.0;
  const double sine = std::sin(home.latitude_deg * kRadPerDeg);
  const double w = 1.0 - kEccentricitySquared * sine * sine;
  const double meridian_m = kEquatorialRadius_m * (1.0 - kEccentricitySquared) / (w * std::sqrt(w));
  const double parallel_m = kEquatorialRadius_m / std::sqrt(w) * std::cos(home.latitude_deg * kRadPerDeg);
  const double east_deg = std::remainder(position.longitude_deg - home.longitude_deg, 360.0);
  return {meridian_m * (position.latitude_deg - home.latitude_deg) * kRadPerDeg,
          parallel_m * east_deg * kRadPerDeg};
}

}  // namespace swiftlet::ground
