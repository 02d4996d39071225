#include "swiftlet/control/position/thrust_attitude_map.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kLeastLift = kMinimumLift * plant::kGravity;  // m/s^2

// R_z(psi)' v.
Vector3d unyawed(const Vector3d& v, double cosine, double sine) {
  return {cosine * v.x() + sine * v.y(), -sine * v.x() + cosine * v.y(), v.z()};
}

// e3 x v.
Vector3d e3_cross(const Vector3d& v) { return {-v.y(), v.x(), 0.0}; }

// b, the specific force of the rotors, and its derivatives in a frame that yaws with the reference.
struct YawedForce {
  Vector3d b, b_1, b_2;
};

YawedForce yawed_force(const Reference& reference, const math::Heading& heading) {
  const double psi_1 = reference.yaw_rate;
  const double psi_2 = reference.yaw_acceleration;
  const Vector3d n0 = Vector3d(0.0, 0.0, plant::kGravity) - reference.acceleration_ned;
  const Vector3d& jerk = reference.jerk_ned;
  const Vector3d& snap = reference.snap_ned;
  const Vector3d n2 =
      -snap + 2.0 * psi_1 * e3_cross(jerk) - psi_2 * e3_cross(n0) + psi_1 * psi_1 * e3_cross(e3_cross(n0));
  return {unyawed(n0, heading.cosine, heading.sine),
          unyawed(-jerk - psi_1 * e3_cross(n0), heading.cosine, heading.sine),
          unyawed(n2, heading.cosine, heading.sine)};
}

}  // namespace

ThrustAttitude thrust_attitude(double mass_kg, const Vector3d& acceleration_ned, double max_tilt_tangent) {
  ThrustAttitude out;
  Vector3d b(0.0, 0.0, plant::kGravity);
  out.limited = !acceleration_ned.allFinite();
  if (!out.limited) b -= acceleration_ned;
  if (b.z() < kLeastLift) {
    b.z() = kLeastLift;
    out.limited = true;
  }
  const double longest = b.z() * max_tilt_tangent;
  const double horizontal_squared = b.head<2>().squaredNorm();
  if (horizontal_squared > longest * longest) {
    b.head<2>() *= longest / std::sqrt(horizontal_squared);
    out.limited = true;
  }
  const double length = b.norm();
  out.thrust_n = mass_kg * length;
  out.body_z_ned = (1.0 / length) * b;
  return out;
}

ReferenceMotion reference_motion(double mass_kg, const Reference& reference, const math::Heading& heading) {
  const double psi_1 = reference.yaw_rate;
  const double psi_2 = reference.yaw_acceleration;
  auto [b, b_1, b_2] = yawed_force(reference, heading);

  ReferenceMotion out;
  if (!(b.z() >= kLeastLift)) {
    b.z() = kLeastLift;
    out.thrust_n = mass_kg * b.norm();
    return out;
  }

  // theta = atan2(b_x, b_z), with rho its radius.
  const double rho_squared = b.x() * b.x() + b.z() * b.z();
  const double rho = std::sqrt(rho_squared);
  const double per_rho = 1.0 / rho;
  const double per_rho_squared = per_rho * per_rho;
  const double rho_1 = (b.x() * b_1.x() + b.z() * b_1.z()) * per_rho;
  const double rho_2 =
      (b_1.x() * b_1.x() + b_1.z() * b_1.z() + b.x() * b_2.x() + b.z() * b_2.z() - rho_1 * rho_1) * per_rho;
  const double theta_1 = (b_1.x() * b.z() - b.x() * b_1.z()) * per_rho_squared;
  const double theta_2 =
      (b_2.x() * b.z() - b.x() * b_2.z()) * per_rho_squared - 2.0 * theta_1 * rho_1 * per_rho;

  // phi = -atan2(b_y, rho), with |b| its radius.
  const double norm_squared = rho_squared + b.y() * b.y();
  const double norm = std::sqrt(norm_squared);
  const double per_norm = 1.0 / norm;
  const double per_norm_squared = per_norm * per_norm;
  const double norm_1 = b.dot(b_1) * per_norm;
  const double phi_1 = -(b_1.y() * rho - b.y() * rho_1) * per_norm_squared;
  const double phi_2 = -(b_2.y() * rho - b.y() * rho_2) * per_norm_squared - 2.0 * phi_1 * norm_1 * per_norm;

  // omega = S1^-1 Theta', the inverse of Eq. (29)-(31), and its derivative.
  const double sin_phi = -b.y() * per_norm;
  const double cos_phi = rho * per_norm;
  const double sin_theta = b.x() * per_rho;
  const double cos_theta = b.z() * per_rho;
  const double q = cos_phi * theta_1 + sin_phi * cos_theta * psi_1;
  const double r = cos_phi * cos_theta * psi_1 - sin_phi * theta_1;
  const double psi_1_turned = psi_1 * theta_1 * sin_theta;
  out.body_rates = {phi_1 - sin_theta * psi_1, q, r};
  out.body_accelerations = {
      phi_2 - sin_theta * psi_2 - theta_1 * cos_theta * psi_1,
      cos_phi * theta_2 + sin_phi * cos_theta * psi_2 + phi_1 * r - sin_phi * psi_1_turned,
      cos_phi * cos_theta * psi_2 - sin_phi * theta_2 - phi_1 * q - cos_phi * psi_1_turned};
  out.thrust_n = mass_kg * norm;
  out.thrust_rate = mass_kg * norm_1;
  return out;
}

}  // namespace swiftlet::control
