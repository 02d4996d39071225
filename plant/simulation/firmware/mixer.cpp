#include "swiftlet/plant/simulation/firmware/mixer.hpp"

#include <algorithm>

#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::plant {

Mixer::Mixer(const Vehicle& vehicle)
    : vehicle_(vehicle), thrust_per_wrench_(pseudo_inverse(effectiveness(vehicle))) {}

PerRotor Mixer::throttles(double thrust_n, const Eigen::Vector3d& moment_frd, double supply_voltage_v) const {
  const Eigen::Vector4d wrench(thrust_n, moment_frd.x(), moment_frd.y(), moment_frd.z());
  RotorThrusts thrusts = thrust_per_wrench_ * wrench;
  const double most = steady_thrust_from_throttle(vehicle_, supply_voltage_v, 1.0);
  const double excess = std::max(thrusts.maxCoeff() - most, 0.0);
  PerRotor throttle{};
  for (int i = 0; i < vehicle_.rotor_count(); ++i) {
    const double rotor_thrust_n = std::max(thrusts[i] - excess, 0.0);
    throttle[static_cast<std::size_t>(i)] =
        throttle_from_steady_thrust(vehicle_, supply_voltage_v, rotor_thrust_n);
  }
  return throttle;
}

}  // namespace swiftlet::plant
