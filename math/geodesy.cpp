#include "swiftlet/math/geodesy.hpp"

#include <cmath>

#include "swiftlet/math/angles.hpp"

namespace swiftlet::math {
namespace {

// Metres per degree at home.
struct Scale {
  double north;
  double east;
};

Scale scale_at(const GeographicPosition& home) {
  constexpr double kEquatorialRadius_m = 6378137.0;
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(home.latitude_deg * math::kRadPerDeg);
  const double w = 1.0 - kEccentricitySquared * sine * sine;
  const double meridian_m = kEquatorialRadius_m * (1.0 - kEccentricitySquared) / (w * std::sqrt(w));
  const double parallel_m =
      kEquatorialRadius_m / std::sqrt(w) * std::cos(home.latitude_deg * math::kRadPerDeg);
  return {meridian_m * math::kRadPerDeg, parallel_m * math::kRadPerDeg};
}

}  // namespace

Eigen::Vector2d north_east_of(const GeographicPosition& home, const GeographicPosition& position) {
  const Scale scale = scale_at(home);
  const double east_deg = std::remainder(position.longitude_deg - home.longitude_deg, 360.0);
  return {scale.north * (position.latitude_deg - home.latitude_deg), scale.east * east_deg};
}

GeographicPosition position_at(const GeographicPosition& home, const Eigen::Vector2d& north_east) {
  const Scale scale = scale_at(home);
  return {home.latitude_deg + north_east.x() / scale.north,
          std::remainder(home.longitude_deg + north_east.y() / scale.east, 360.0)};
}

}  // namespace swiftlet::math
