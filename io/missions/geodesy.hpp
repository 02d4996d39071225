// Geographic coordinates near a home position as metres on its tangent plane.
#pragma once

#include <Eigen/Core>

namespace swiftlet::ground {

struct GeographicPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

// North and east of home, m: by the radii of curvature of WGS 84 at home. Within 1 km of it that is right to
// some centimetres.
Eigen::Vector2d north_east_of(const GeographicPosition& home, const GeographicPosition& position);

}  // namespace swiftlet::ground
