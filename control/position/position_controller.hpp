// Position control: robust and perfect tracking (RPT), Eq. (41)-(49), a double integrator per NED axis.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

struct PositionCommand {
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2, of the vehicle, without gravity
  bool limited = false;                                        // clipped to the limits
};

class PositionController {
 public:
  PositionController(const PositionSettings& settings, const Limits& limits, const ControlDesign& design);

  // Eq. (48): a = a_r + k_v (u_r - u) + k_p (x_r - x), with integral_pole > 0 its integral form. The
  // horizontal part's length and the vertical part are each clipped to limits.max_acceleration. The integral
  // advances by dt_s unless freeze_integral is set. It stays within settings.integral_limit on each axis and
  // does not grow on a clipped axis. Without integral_pole it is zero.
  PositionCommand step(const Eigen::Vector3d& position_ned, const Eigen::Vector3d& velocity_ned,
                       const Reference& reference, double dt_s, bool freeze_integral);

  // Changes the gains and the limit of the integral. The integral is an acceleration: a change of k_i does
  // not step the command.
  void set_gains(const ControlGains& gains);

  // Sets the integral to zero.
  void reset() { integral_.setZero(); }

  // Takes over the integral of another controller.
  void adopt(const Eigen::Vector3d& integral) { integral_ = integral; }

  // The integral term of the acceleration, m/s^2.
  const Eigen::Vector3d& integral() const { return integral_; }

 private:
  Eigen::Vector3d k_p_, k_v_, k_i_;
  double integral_limit_;
  double max_acceleration_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
