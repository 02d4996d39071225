// All gains of the controller, from the vehicle and the settings. FlightController flies them, `swiftlet
// gains` prints them.
#pragma once

#include <array>
#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/design/loop.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// One attitude axis: u = -k (angle, rate, moment / inertia), u the commanded moment / inertia.
struct AttitudeAxisDesign {
  AttitudeModel model = AttitudeModel::kMotorLag;
  LqrWeights weights;
  Eigen::Vector3d k =
      Eigen::Vector3d::Zero();              // rad/s^2 per rad, per rad/s, per rad/s^2; [2] is 0 on (38)-(40)
  std::vector<std::complex<double>> poles;  // rad/s, of the closed loop on the model it is designed on
  std::vector<std::complex<double>> poles_with_lag;  // rad/s, of the closed loop with the rotor lag
  double phase_margin_deg = 0.0;                     // at the rotor command, rotor lag included
};

// a = a_r + k_v (u_r - u) + k_p (x_r - x) + k_i integral(x_r - x), Eq. (48) and its integral form.
struct RptGains {
  double k_p = 0.0;  // 1/s^2
  double k_v = 0.0;  // 1/s
  double k_i = 0.0;  // 1/s^3
};

// One position axis.
struct PositionAxisDesign {
  RptSettings settings;
  Eigen::Matrix<double, 5, 1> f =
      Eigen::Matrix<double, 5, 1>::Zero();  // Eq. (49) for the state (45); without integral
  RptGains gains;                           // gains flown; with the integral if integral_pole > 0
  std::vector<std::complex<double>> poles;  // rad/s, of the closed loop with the inner loop and the rotor lag
  double phase_margin_deg = 0.0;            // at the acceleration command, inner loop and rotor lag included
};

struct ControlDesign {
  double rotor_lag_s = 0.0;  // tau_m of Eq. (18)
  double thrust_lead = 0.0;  // as RoughAirSettings
  AttitudeAxisDesign roll, pitch, yaw;
  PositionAxisDesign x, y, z;  // poles and margins: x over pitch, y over roll (yaw 0), z over the rotors
};

// (A, B) of one attitude axis: Eq. (38)-(40), or with moment / inertia as third state, tau d(m)/dt = u - m.
struct StateSpace {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};
StateSpace attitude_axis_model(AttitudeModel model, double rotor_lag_s);

// Response of the rotors on one axis: gain times the command, behind the lag. The controller observes
// `observed` times the response. Both factors are 1 on the vehicle that the loops are designed for.
struct RotorResponse {
  double lag_s = 0.0;
  double gain = 1.0;
  double observed = 1.0;
};

// The response of rotors whose command u leads what is observed of them: u + lead (u - observed response).
RotorResponse led(const RotorResponse& rotors, double lead);

// The gains k (2 or 3 entries are used) closed around the axis with rotor lag, cut at the rotor command.
Loop attitude_loop(const Eigen::Vector3d& k, const RotorResponse& moment);

// A position axis over an inner loop x' = A x + b u that gives acceleration = `acceleration` x, cut at u, the
// acceleration command. States: the integral of the position if k_i > 0, position, velocity, those of the
// inner loop.
Loop position_loop(const RptGains& gains, const Eigen::MatrixXd& inner_a, const Eigen::VectorXd& inner_b,
                   const Eigen::RowVectorXd& acceleration);

// A horizontal position axis over a closed attitude axis, cut at the acceleration command (small angles:
// acceleration = tilt_gain * g * angle; the acceleration command is the angle command without delay).
Loop horizontal_position_loop(const RptGains& gains, const Eigen::Vector3d& attitude_k,
                              const RotorResponse& moment, double tilt_gain = 1.0);

// The vertical position axis over the rotor lag, cut at the acceleration command.
Loop vertical_position_loop(const RptGains& gains, const RotorResponse& thrust);

// Eq. (49) in the state order of Eq. (45): (x_r, u_r, a_r, x, u).
Eigen::Matrix<double, 5, 1> rpt_feedback(const RptSettings& settings);

// Eq. (48), or the integral form if integral_pole > 0.
RptGains rpt_gains(const RptSettings& settings);

// LQR of one attitude axis. Throws std::invalid_argument with a sentence if the weights break a rule.
AttitudeAxisDesign design_attitude_axis(AttitudeModel model, const LqrWeights& weights, double rotor_lag_s);

// Designs all gains. Throws std::invalid_argument with a sentence if the vehicle or the settings break a
// rule.
ControlDesign design(const plant::Vehicle& vehicle, const ControlSettings& settings);

// The loops that are unstable with the rotor lag, keys as in the control settings file; empty if the design
// can be flown. design() returns unstable designs too, for inspection.
std::vector<plant::Violation> unstable_loops(const ControlDesign& design);

}  // namespace swiftlet::control
