#include "swiftlet/control/design/level_loops.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using plant::ControlLevel;

// x' = A x + b u with the input behind a delay: Pade approximation of third order of exp(-s T), with z = s T
//   -1 + (24 z^2 + 240) / (z^3 + 12 z^2 + 60 z + 120).
StateSpace behind_delay(const StateSpace& system, double delay_s) {
  if (delay_s <= 0.0) return system;
  const Index first = system.a.rows();
  StateSpace out{MatrixXd::Zero(first + 3, first + 3), VectorXd::Zero(first + 3)};
  out.a.topLeftCorner(first, first) = system.a;
  out.a.block(0, first, first, 3) = system.b * Eigen::RowVector3d(240.0, 0.0, 24.0);
  out.a.bottomRightCorner<3, 3>() << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -120.0, -60.0, -12.0;
  out.a.bottomRightCorner<3, 3>() /= delay_s;
  out.b.head(first) = -system.b;
  out.b[first + 2] = 1.0 / delay_s;
  return out;
}

constexpr Index kAngle = 0;  // state

// From the commanded rate to the angle, with the vehicle's rate loop closed:
//   angle' = rate, rate' = m, lag m' = u - m,
//   u = p (command - rate) + integral - d cutoff (rate - filtered), filtered' = cutoff (rate - filtered).
StateSpace rate_loop(const VehicleLoops& vehicle, Index axis, double lag_s) {
  constexpr Index kRate = 1;
  constexpr Index kMoment = 2;
  constexpr Index kFiltered = 3;
  constexpr Index kIntegral = 4;
  const double p = vehicle.rate_p[axis];
  const double i = vehicle.rate_i[axis];
  const double derivative = vehicle.rate_d[axis] * vehicle.derivative_cutoff;
  StateSpace out{MatrixXd::Zero(5, 5), VectorXd::Zero(5)};
  out.a(kAngle, kRate) = 1.0;
  out.a(kRate, kMoment) = 1.0;
  out.a(kMoment, kRate) = -(p + derivative) / lag_s;
  out.a(kMoment, kMoment) = -1.0 / lag_s;
  out.a(kMoment, kFiltered) = derivative / lag_s;
  out.a(kMoment, kIntegral) = 1.0 / lag_s;
  out.a(kFiltered, kRate) = vehicle.derivative_cutoff;
  out.a(kFiltered, kFiltered) = -vehicle.derivative_cutoff;
  out.a(kIntegral, kRate) = -i;
  out.b[kMoment] = p / lag_s;
  out.b[kIntegral] = i;
  return out;
}

RowVectorXd angle_of(const StateSpace& system) { return RowVectorXd::Unit(system.a.rows(), kAngle); }

// The attitude loop over it, cut at the rate command.
FlownLoop attitude_loop_over(const StateSpace& rates, double rate_per_angle) {
  const RowVectorXd angle = angle_of(rates);
  return {{rates.a, rates.b, rate_per_angle * angle}, rate_per_angle * rates.b, angle};
}

StateSpace closed(const FlownLoop& flown) {
  return {flown.loop.a - flown.loop.b * flown.loop.c, flown.reference};
}

// The attitude is the horizontal acceleration over g, and g times the commanded attitude its command.
FlownLoop position_loop_over(const RptGains& gains, const StateSpace& attitude) {
  return flown_position_loop(gains, attitude.a, attitude.b, angle_of(attitude));
}

RptGains position_gains(const ControlGains& gains, Index axis) {
  return {gains.position_p[axis], gains.position_v[axis], gains.position_i[axis]};
}

// P of the position over PI of the velocity.
RptGains position_gains(const VehicleLoops& vehicle) {
  return {vehicle.velocity_p * vehicle.position_p + vehicle.velocity_i, vehicle.velocity_p,
          vehicle.velocity_i * vehicle.position_p};
}

FlownLoop vertical_loop_of_vehicle(const VehicleLoops& vehicle, double lag_s) {
  return flown_position_loop(position_gains(vehicle), MatrixXd::Constant(1, 1, -1.0 / lag_s),
                             VectorXd::Constant(1, 1.0 / lag_s), RowVectorXd::Ones(1));
}

}  // namespace

Eigen::Vector3d rate_per_angle(const ControlGains& gains) {
  return gains.attitude_angle.cwiseQuotient(gains.attitude_rate);
}

bool closed_by_control(ControlLevel level, std::size_t i) {
  if (level == ControlLevel::kTrajectory) return false;
  return level != ControlLevel::kAttitude || i >= 3;
}

std::array<FlownLoop, 6> level_loops(ControlLevel level, const ControlGains& gains,
                                     const ObservedRotors& rotors, const VehicleLoops& vehicle,
                                     double delay_s) {
  const bool control_attitude = level == ControlLevel::kRates;
  const Eigen::Vector3d p = control_attitude ? rate_per_angle(gains) : vehicle.attitude_p;
  const auto attitude = [&](Index axis) {
    const StateSpace rates = rate_loop(vehicle, axis, rotors.lag_s);
    return attitude_loop_over(control_attitude ? behind_delay(rates, delay_s) : rates, p[axis]);
  };
  const FlownLoop roll = attitude(0);
  const FlownLoop pitch = attitude(1);
  const FlownLoop yaw = attitude(2);
  if (level == ControlLevel::kTrajectory) {
    const RptGains own = position_gains(vehicle);
    return {roll,
            pitch,
            yaw,
            position_loop_over(own, closed(pitch)),
            position_loop_over(own, closed(roll)),
            vertical_loop_of_vehicle(vehicle, rotors.lag_s)};
  }
  const auto commanded = [&](const FlownLoop& inner) {
    return control_attitude ? closed(inner) : behind_delay(closed(inner), delay_s);
  };
  return {roll,
          pitch,
          yaw,
          position_loop_over(position_gains(gains, 0), commanded(pitch)),
          position_loop_over(position_gains(gains, 1), commanded(roll)),
          flown_vertical_loop(position_gains(gains, 2), {rotors.lag_s, rotors.correction},
                              gains.disturbance_bandwidth, delay_s)};
}

}  // namespace swiftlet::control
