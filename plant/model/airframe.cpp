#include "plant/model/airframe.hpp"

#include <Eigen/LU>

namespace swiftlet::plant {

Effectiveness effectiveness(const Vehicle& vehicle) {
  Effectiveness out(4, vehicle.rotor_count());
  const double yaw = torque_per_thrust(vehicle.rotor);
  for (int i = 0; i < vehicle.rotor_count(); ++i) {
    const RotorMount& mount = vehicle.rotors[static_cast<std::size_t>(i)];
    out.col(i) << 1.0, -mount.position_frd.y(), mount.position_frd.x(),
        mount.spin == Spin::kCounterClockwise ? yaw : -yaw;
  }
  return out;
}

RotorThrusts trim_thrusts(const Vehicle& vehicle) {
  const Effectiveness e = effectiveness(vehicle);
  // Rows of one size, so that the inverse of e e^T is accurate.
  const Eigen::Vector4d scale = e.rowwise().norm().cwiseInverse();
  const Effectiveness scaled = scale.asDiagonal() * e;
  const Eigen::Vector4d wrench(scale[0] * vehicle.mass_kg * kGravity, 0.0, 0.0, 0.0);
  const Eigen::Matrix4d gram = scaled * scaled.transpose();
  return scaled.transpose() * gram.inverse() * wrench;
}

}  // namespace swiftlet::plant
