#include "swiftlet/plant/model/airframe.hpp"

#include <algorithm>
#include <limits>

#include "swiftlet/math/linear_algebra.hpp"

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

Allocation pseudo_inverse(const Effectiveness& effectiveness) {
  const Eigen::Vector4d scale = effectiveness.rowwise().norm().cwiseInverse();
  const Effectiveness scaled = scale.asDiagonal() * effectiveness;
  return math::solve_positive_definite(scaled * scaled.transpose(), scaled).transpose() * scale.asDiagonal();
}

double least_authority(const Effectiveness& effectiveness) {
  Effectiveness rows = effectiveness;
  for (int i = 0; i < rows.rows(); ++i) {
    const double length = rows.row(i).norm();
    if (length > 0.0) rows.row(i) /= length;
  }
  return math::singular_values(rows)[3];
}

double width(const Vehicle& vehicle) {
  double furthest = 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = (vehicle.rotors[i].position_frd - vehicle.rotors[j].position_frd).head<2>().norm();
      furthest = std::max(furthest, apart);
      nearest = std::min(nearest, apart);
    }
  }
  return furthest + nearest;
}

RotorThrusts trim_thrusts(const Vehicle& vehicle) {
  return pseudo_inverse(effectiveness(vehicle)) * Eigen::Vector4d(vehicle.mass_kg * kGravity, 0.0, 0.0, 0.0);
}

}  // namespace swiftlet::plant
