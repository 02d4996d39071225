// Position: robust and perfect tracking (RPT), Eq. (41)-(49), one double integrator for each axis of NED.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

struct PositionCommand {
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2, of the vehicle, gravity not included
  bool limited = false;                                        // it was cut to the limits
};

class PositionController {
 public:
  PositionController(const PositionSettings& settings, const Limits& limits, const ControlDesign& design);

  // Eq. (48): a = a_r + k_v (u_r - u) + k_p (x_r - x), and with integral_pole > 0 its integral form. Cut to
  // limits.max_acceleration, the horizontal part in length, the vertical part by itself.
  // The integral runs on by dt_s unless freeze_integral is set, stays within settings.integral_limit on each
  // axis, and does not grow on an axis that the limits cut. Without integral_pole it is zero.
  PositionCommand step(const Eigen::Vector3d& position_ned, const Eigen::Vector3d& velocity_ned,
                       const Reference& reference, double dt_s, bool freeze_integral);

  // Forgets the integral.
  void reset() { integral_.setZero(); }

  // Goes on with the integral of another controller.
  void adopt(const Eigen::Vector3d& integral) { integral_ = integral; }

  // The integral's part of the acceleration, m/s^2.
  const Eigen::Vector3d& integral() const { return integral_; }

 private:
  Eigen::Vector3d k_p_, k_v_, k_i_;
  double integral_limit_;
  double max_acceleration_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
