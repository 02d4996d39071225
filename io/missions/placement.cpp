#include "swiftlet/io/missions/placement.hpp"

#include <cmath>

#include <fmt/core.h>

#include "swiftlet/math/angles.hpp"

namespace swiftlet::io {
namespace {

// Cosine and sine, exact for multiples of 90 deg: a fence stays where it is.
Eigen::Vector2d direction(double angle_deg) {
  const double quarters = angle_deg / 90.0;
  if (quarters == std::round(quarters)) {
    const auto quarter = static_cast<int>(std::fmod(quarters, 4.0));
    const int turn = (quarter + 4) % 4;
    return {turn == 0 ? 1.0 : turn == 2 ? -1.0 : 0.0, turn == 1 ? 1.0 : turn == 3 ? -1.0 : 0.0};
  }
  return {std::cos(angle_deg * math::kRadPerDeg), std::sin(angle_deg * math::kRadPerDeg)};
}

}  // namespace

bool Placement::is_identity() const { return scale == 1.0 && rotate_deg == 0.0 && offset_ned.isZero(0.0); }

bool Placement::keeps_axes() const { return std::remainder(rotate_deg, 90.0) == 0.0; }

Eigen::Vector3d Placement::position(const Eigen::Vector3d& position_ned) const {
  const Eigen::Vector2d north = direction(rotate_deg);  // of the file, in the room
  const Eigen::Vector3d scaled = scale * position_ned;
  return offset_ned + Eigen::Vector3d(north.x() * scaled.x() - north.y() * scaled.y(),
                                      north.y() * scaled.x() + north.x() * scaled.y(), scaled.z());
}

double Placement::yaw(double yaw_rad) const { return yaw_rad + rotate_deg * math::kRadPerDeg; }

control::PolynomialSegment Placement::segment(const control::PolynomialSegment& segment_ned) const {
  const Eigen::Vector2d north = direction(rotate_deg);
  control::PolynomialSegment placed = segment_ned;
  for (std::size_t k = 0; k < placed.x.size(); ++k) {
    const double x = scale * segment_ned.x[k];
    const double y = scale * segment_ned.y[k];
    placed.x[k] = north.x() * x - north.y() * y;
    placed.y[k] = north.y() * x + north.x() * y;
    placed.z[k] *= scale;
  }
  placed.x[0] += offset_ned.x();
  placed.y[0] += offset_ned.y();
  placed.z[0] += offset_ned.z();
  placed.yaw[0] = yaw(segment_ned.yaw[0]);
  return placed;
}

std::string Placement::sentence() const {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (scale != 1.0) add(fmt::format("scaled by {:g}", scale));
  if (rotate_deg != 0.0)
    add(fmt::format("turned by {:g} deg {}, headings too", std::abs(rotate_deg),
                    rotate_deg > 0.0 ? "clockwise" : "counter-clockwise"));
  if (!offset_ned.isZero(0.0))
    add(fmt::format("moved by ({:g}, {:g}, {:g}) m in NED", offset_ned.x(), offset_ned.y(), offset_ned.z()));
  return text;
}

}  // namespace swiftlet::io
