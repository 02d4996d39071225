// The pilot's command: the deflections of two sticks, and the velocity that they mean.
#pragma once

#include "swiftlet/ground/client/vehicle_setpoints.hpp"

namespace swiftlet::ground {

// Deflections, -1 .. 1.
struct Sticks {
  double forward = 0.0;
  double right = 0.0;
  double up = 0.0;
  double turn = 0.0;  // to the right, clockwise seen from above

  bool centred() const { return forward == 0.0 && right == 0.0 && up == 0.0 && turn == 0.0; }
};

// The velocities at full deflection.
struct TeleopLimits {
  double horizontal_m_s = 0.5;  // in any direction
  double vertical_m_s = 0.3;
  double yaw_rate_rad_s = 0.8;
};

// The setpoint of a vehicle whose nose points to yaw_rad, from north towards east.
VelocitySetpoint velocity_of(const Sticks& sticks, const TeleopLimits& limits, double yaw_rad);

}  // namespace swiftlet::ground
