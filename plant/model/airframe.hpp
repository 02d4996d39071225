// Airframe: force and moments of the rotors on the body, Eq. (27) and (28), for 4 to 8 rotors with upright
// axes.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "swiftlet/plant/model/rotor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Effectiveness matrix, 4 x N, on the stack. Rows: total thrust (N, along -z of FRD), then roll, pitch and
// yaw moment (N m). One column per rotor.
using Effectiveness = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::ColMajor, 4, kMaxRotors>;

// One thrust per rotor, N.
using RotorThrusts = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRotors, 1>;

// (thrust, roll, pitch, yaw) = effectiveness * thrusts. Eq. (27): thrust is sum T, the force is (0, 0,
// -thrust). Eq. (28): a rotor at (x, y, z) gives the moment (x, y, z) x (0, 0, -T) = (-y T, x T, 0) and the
// torque Q = (k_Q / k_T) T about z, which is positive for a rotor that turns counter-clockwise seen from
// above.
Effectiveness effectiveness(const Vehicle& vehicle);

// Pseudo-inverse of an effectiveness matrix of rank 4, N x 4, on the stack. It maps a wrench to the thrusts
// with the smallest sum of squares. The rows of the effectiveness are scaled to length 1 before the
// inversion, so that the result is accurate for vehicles of any size.
using Allocation = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::ColMajor, kMaxRotors, 4>;
Allocation pseudo_inverse(const Effectiveness& effectiveness);

// Smallest singular value of the effectiveness with its rows scaled to length 1; 0 if a row is 0. Above 0 the
// rank is 4: thrust and moments can be commanded independently.
double least_authority(const Effectiveness& effectiveness);

// Mean lever arm, m, of the rotor thrusts about an axis (0 roll, 1 pitch, 2 yaw). About yaw it is torque over
// thrust.
inline double mean_lever(const Vehicle& vehicle, int axis) {
  return effectiveness(vehicle).row(1 + axis).cwiseAbs().mean();
}

// Distance from the centre of mass to the hub of the first rotor, m.
inline double hub_distance(const Vehicle& vehicle) { return vehicle.rotors.front().position_frd.norm(); }

// Greatest horizontal extent, m: between the two hubs that are furthest apart, plus two propellers that are as
// large as the hubs that are nearest to each other allow.
double width(const Vehicle& vehicle);

// Thrust, N, and speed, rad/s, of each rotor in hover if all rotors carry the same share of the weight.
inline double hover_thrust(const Vehicle& vehicle) {
  return vehicle.mass_kg * kGravity / vehicle.rotor_count();
}
inline double hover_speed(const Vehicle& vehicle) {
  return speed_from_thrust(vehicle.rotor, hover_thrust(vehicle));
}

// Rotor thrusts, N, that carry the weight without a moment, with the smallest sum of squares. One entry per
// rotor. The effectiveness must have rank 4.
RotorThrusts trim_thrusts(const Vehicle& vehicle);

}  // namespace swiftlet::plant
