// Airframe: what the rotors do to the body, Eq. (27) and (28), for any 4 .. 8 upright rotors.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "swiftlet/plant/model/rotor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// 4 x N, on the stack. Rows: total thrust (N, along -z of FRD), roll, pitch and yaw moment (N m); columns:
// rotors.
using Effectiveness = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::ColMajor, 4, kMaxRotors>;

// One thrust per rotor, N.
using RotorThrusts = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRotors, 1>;

// (thrust, roll, pitch, yaw) = effectiveness * thrusts. Eq. (27): thrust is sum T, the force is (0, 0,
// -thrust). Eq. (28): a rotor at (x, y, z) gives the moment (x, y, z) x (0, 0, -T) = (-y T, x T, 0), and its
// torque Q = (k_Q / k_T) T about z, positive if it turns counter-clockwise seen from above.
Effectiveness effectiveness(const Vehicle& vehicle);

// N x 4, on the stack: the pseudo-inverse of an effectiveness of rank 4. Of all thrusts that give a wrench, those
// with the least sum of squares. Its rows are scaled first, so that it is accurate for any size of vehicle.
using Allocation = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::ColMajor, kMaxRotors, 4>;
Allocation pseudo_inverse(const Effectiveness& effectiveness);

// The least singular value of an effectiveness whose rows are scaled to length 1; 0 where a row is. At rank 4 thrust
// and moments can be commanded one by one.
double least_authority(const Effectiveness& effectiveness);

// The mean lever, m, by which the rotors' thrusts turn the body about an axis, 0 roll .. 2 yaw; about yaw torque
// over thrust.
inline double mean_lever(const Vehicle& vehicle, int axis) {
  return effectiveness(vehicle).row(1 + axis).cwiseAbs().mean();
}

// From the centre of mass to a hub, m.
inline double hub_distance(const Vehicle& vehicle) { return vehicle.rotors.front().position_frd.norm(); }

// Thrust of each rotor, N, and its speed, rad/s, when all share the weight evenly.
inline double hover_thrust(const Vehicle& vehicle) {
  return vehicle.mass_kg * kGravity / vehicle.rotor_count();
}
inline double hover_speed(const Vehicle& vehicle) {
  return speed_from_thrust(vehicle.rotor, hover_thrust(vehicle));
}

// The least thrusts, in the sense of their sum of squares, that carry the weight without a moment; sized 4
// .. 8. The effectiveness must have rank 4.
RotorThrusts trim_thrusts(const Vehicle& vehicle);

}  // namespace swiftlet::plant
