// Where the content of a file is flown: what --scale, --rotate and --offset say. Readers apply it to positions and yaw
// angles in NED, with the heights of the file: first scaled about the origin, then rotated about the down axis, then
// moved. Times stay, so that the speeds of a path grow with its scale.
#pragma once

#include <string>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::io {

struct Placement {
  double scale = 1.0;                                    // > 0
  double rotate_deg = 0.0;                               // clockwise seen from above, as yaw in NED
  Eigen::Vector3d offset_ned = Eigen::Vector3d::Zero();  // m

  bool is_identity() const;
  bool keeps_axes() const;  // a rotation by a multiple of 90 deg

  Eigen::Vector3d position(const Eigen::Vector3d& position_ned) const;
  double yaw(double yaw_rad) const;  // not wrapped
  control::PolynomialSegment segment(const control::PolynomialSegment& segment_ned) const;

  // "scaled by 2, turned by 90 deg clockwise, moved by (1, 0, -0.5) m in NED"
  std::string sentence() const;
};

}  // namespace swiftlet::io
