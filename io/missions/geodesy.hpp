// Converts geographic coordinates near a home position to metres on its tangent plane.
#pragma once

#include <Eigen/Core>

namespace swiftlet::ground {

struct GeographicPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

// Returns north and east of home, m, from the radii of curvature of the WGS 84 ellipsoid at home. Within 1 km
// of home the error is a few centimetres.
Eigen::Vector2d north_east_of(const GeographicPosition& home, const GeographicPosition& position);

}  // namespace swiftlet::ground
