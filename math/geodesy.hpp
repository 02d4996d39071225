// Converts between geographic coordinates near a home position and metres on its tangent plane.
#pragma once

#include <Eigen/Core>

namespace swiftlet::math {

struct GeographicPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

// Returns north and east of home, m, from the radii of curvature of the WGS 84 ellipsoid at home. Within 1 km
// of home the error is a few centimetres.
Eigen::Vector2d north_east_of(const GeographicPosition& home, const GeographicPosition& position);

// The inverse: the position at this distance, m, north and east of home. The longitude is within -180 .. 180.
// Precondition: home is not at a pole.
GeographicPosition position_at(const GeographicPosition& home, const Eigen::Vector2d& north_east);

}  // namespace swiftlet::math
