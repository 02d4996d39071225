#include "swiftlet/control/attitude/attitude_error.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/euler.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kOpposed = 1e-9;  // 1 + cosine below which two directions count as opposed

// 2 sin(angle / 2) from the angle's cosine and sine.
double chord(double cosine, double sine) {
  const double half = 0.5 * (1.0 + cosine);  // cos^2(angle / 2)
  return half < kOpposed ? std::copysign(2.0, sine) : sine / std::sqrt(half);
}

}  // namespace

Matrix3d attitude_along(const Vector3d& body_z_ned, const math::Heading& heading) {
  // Body x lies in the vertical plane of the heading, Eq. (3): it is at right angles to (-s psi, c psi, 0).
  const Vector3d across(-heading.sine, heading.cosine, 0.0);
  Matrix3d axes;
  axes.col(0) = across.cross(body_z_ned).normalized();
  axes.col(1) = body_z_ned.cross(axes.col(0));
  axes.col(2) = body_z_ned;
  return axes;
}

Vector3d euler_error(const Eigen::Quaterniond& q_ned_from_frd, const Vector3d& body_z_ned, double yaw_rad) {
  const math::EulerAngles euler = math::euler_angles(q_ned_from_frd);
  const double cosine = euler.heading.cosine;
  const double sine = euler.heading.sine;
  const Vector3d b(cosine * body_z_ned.x() + sine * body_z_ned.y(),
                   -sine * body_z_ned.x() + cosine * body_z_ned.y(), body_z_ned.z());
  const Vector3d wanted(-std::atan2(b.y(), std::sqrt(b.x() * b.x() + b.z() * b.z())),
                        std::atan2(b.x(), b.z()), yaw_rad);
  Vector3d error = wanted - euler.vector();
  for (double& angle : error) angle = math::wrap_angle(angle);
  return error;
}

RotationError rotation_error(const Eigen::Quaterniond& q_ned_from_frd, const Vector3d& body_z_ned,
                             const math::Heading& heading) {
  RotationError error;
  const Matrix3d r_frd_from_ned = q_ned_from_frd.toRotationMatrix().transpose();
  error.r_frd_from_reference.noalias() = r_frd_from_ned * attitude_along(body_z_ned, heading);
  const Vector3d z = error.r_frd_from_reference.col(2);
  const Vector3d x = error.r_frd_from_reference.col(0);

  const double sum = 1.0 + z.z();
  if (sum < kOpposed) {
    error.angle = {2.0, 0.0, chord(x.x(), -x.y())};  // half a turn about x takes y to -y
    return error;
  }
  // Rotates body z to z the shortest way. What this rotation, undone, leaves of the desired x axis is the
  // yaw.
  const double scale = std::sqrt(2.0 / sum);
  const double part = x.z() / sum;
  error.angle = {-scale * z.y(), scale * z.x(), chord(x.x() - part * z.x(), x.y() - part * z.y())};
  return error;
}

}  // namespace swiftlet::control
