#include "swiftlet/control/design/control_design.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "swiftlet/math/riccati.hpp"

namespace swiftlet::control {
namespace {

void check_lag(double rotor_lag_s) {
  if (!(rotor_lag_s > 0.0) || !std::isfinite(rotor_lag_s)) {
    throw std::invalid_argument("motor.time_constant_s: is " + std::to_string(rotor_lag_s) +
                                ", must be above 0");
  }
}

AttitudeAxisDesign named_axis(const char* axis, AttitudeModel model, const LqrWeights& weights,
                              double rotor_lag_s) {
  try {
    return design_attitude_axis(model, weights, rotor_lag_s);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string("attitude.") + axis + ": " + e.what());
  }
}

PositionAxisDesign position_axis(const char* axis, const RptSettings& settings) {
  const bool valid = std::isfinite(settings.omega_n) && settings.omega_n > 0.0 &&
                     std::isfinite(settings.zeta) && settings.zeta > 0.0 && std::isfinite(settings.epsilon) &&
                     settings.epsilon > 0.0 && std::isfinite(settings.integral_pole) &&
                     settings.integral_pole >= 0.0;
  if (!valid) {
    throw std::invalid_argument(
        std::string("position.") + axis +
        ": omega_n, zeta and epsilon must be above 0, integral_pole must be at least 0");
  }
  PositionAxisDesign axis_design;
  axis_design.settings = settings;
  axis_design.f = rpt_feedback(settings);
  axis_design.gains = rpt_gains(settings);
  return axis_design;
}

void analyse(PositionAxisDesign& axis, const Loop& loop) {
  axis.poles = closed_loop_poles(loop);
  axis.phase_margin_deg = phase_margin_deg(loop);
}

void note_if_unstable(std::vector<plant::Violation>& found, const char* key,
                      const std::vector<std::complex<double>>& poles) {
  if (poles.back().real() < 0.0) return;
  char message[160];
  std::snprintf(message, sizeof message,
                "with the rotor lag the closed loop has a pole at %.3g + %.3gi rad/s, must be left of 0",
                poles.back().real(), std::abs(poles.back().imag()));
  found.push_back({key, message});
}

}  // namespace

StateSpace attitude_axis_model(AttitudeModel model, double rotor_lag_s) {
  if (model == AttitudeModel::kDoubleIntegrator) {
    StateSpace axis{Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)};
    axis.a(0, 1) = 1.0;
    axis.b[1] = 1.0;
    return axis;
  }
  StateSpace axis{Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3)};
  axis.a(0, 1) = 1.0;
  axis.a(1, 2) = 1.0;
  axis.a(2, 2) = -1.0 / rotor_lag_s;
  axis.b[2] = 1.0 / rotor_lag_s;
  return axis;
}

// tau y' = gain ((1 + lead) u - lead observed y) - y.
RotorResponse led(const RotorResponse& rotors, double lead) {
  const double faster = 1.0 + lead * rotors.gain * rotors.observed;
  return {rotors.lag_s / faster, rotors.gain * (1.0 + lead) / faster, rotors.observed};
}

Loop attitude_loop(const Eigen::Vector3d& k, const RotorResponse& moment) {
  const StateSpace axis = attitude_axis_model(AttitudeModel::kMotorLag, moment.lag_s);
  return {axis.a, axis.b * moment.gain, Eigen::RowVector3d(k[0], k[1], k[2] * moment.observed)};
}

// A position axis without integral has one state less, so that no pole stays at 0.
Loop position_loop(const RptGains& gains, const Eigen::MatrixXd& inner_a, const Eigen::VectorXd& inner_b,
                   const Eigen::RowVectorXd& acceleration) {
  const Eigen::Index integral = gains.k_i > 0.0 ? 1 : 0;
  const Eigen::Index inner = inner_a.rows();
  const Eigen::Index n = integral + 2 + inner;
  Loop loop{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::RowVectorXd::Zero(n)};
  if (integral > 0) {
    loop.a(0, 1) = 1.0;
    loop.c[0] = gains.k_i;
  }
  loop.a(integral, integral + 1) = 1.0;
  loop.a.row(integral + 1).tail(inner) = acceleration;
  loop.a.bottomRightCorner(inner, inner) = inner_a;
  loop.b.tail(inner) = inner_b;
  loop.c[integral] = gains.k_p;
  loop.c[integral + 1] = gains.k_v;
  return loop;
}

Loop horizontal_position_loop(const RptGains& gains, const Eigen::Vector3d& attitude_k,
                              const RotorResponse& moment, double tilt_gain) {
  const Loop inner = attitude_loop(attitude_k, moment);
  return position_loop(gains, inner.a - inner.b * inner.c, inner.b * attitude_k[0],
                       Eigen::RowVector3d(tilt_gain, 0.0, 0.0));
}

Loop vertical_position_loop(const RptGains& gains, const RotorResponse& thrust) {
  return position_loop(gains, Eigen::MatrixXd::Constant(1, 1, -1.0 / thrust.lag_s),
                       Eigen::VectorXd::Constant(1, thrust.gain / thrust.lag_s),
                       Eigen::RowVectorXd::Constant(1, 1.0));
}

Eigen::Matrix<double, 5, 1> rpt_feedback(const RptSettings& settings) {
  const double k_p = settings.omega_n * settings.omega_n / (settings.epsilon * settings.epsilon);
  const double k_v = 2.0 * settings.zeta * settings.omega_n / settings.epsilon;
  return (Eigen::Matrix<double, 5, 1>() << k_p, k_v, 1.0, -k_p, -k_v).finished();
}

RptGains rpt_gains(const RptSettings& settings) {
  const double w = settings.omega_n;
  const double e = settings.epsilon;
  const double integral_pole = settings.integral_pole;
  RptGains gains;
  gains.k_v = (2.0 * settings.zeta * w + integral_pole) / e;
  gains.k_p = (w * w + 2.0 * settings.zeta * w * integral_pole) / (e * e);
  gains.k_i = integral_pole * w * w / (e * e * e);
  return gains;
}

AttitudeAxisDesign design_attitude_axis(AttitudeModel model, const LqrWeights& weights, double rotor_lag_s) {
  check_lag(rotor_lag_s);
  if (!weights.q.allFinite() || weights.q.minCoeff() < 0.0 || !(weights.q[0] > 0.0)) {
    throw std::invalid_argument("the weights q must be at least 0, and the first above 0");
  }
  if (!(weights.r > 0.0) || !std::isfinite(weights.r)) {
    throw std::invalid_argument("the weight r must be above 0");
  }
  const StateSpace axis = attitude_axis_model(model, rotor_lag_s);
  const Eigen::Index n = axis.a.rows();
  const Eigen::MatrixXd q = weights.q.head(n).asDiagonal();
  const Eigen::RowVectorXd k = math::lqr(axis.a, axis.b, q, Eigen::MatrixXd::Constant(1, 1, weights.r));
  AttitudeAxisDesign axis_design;
  axis_design.model = model;
  axis_design.weights = weights;
  axis_design.k.head(n) = k.transpose();
  axis_design.poles = closed_loop_poles({axis.a, axis.b, k});
  const Loop loop = attitude_loop(axis_design.k, {rotor_lag_s});
  axis_design.poles_with_lag = closed_loop_poles(loop);
  axis_design.phase_margin_deg = phase_margin_deg(loop);
  return axis_design;
}

ControlDesign design(const plant::Vehicle& vehicle, const ControlSettings& settings) {
  const double lag = vehicle.motor.time_constant_s;
  check_lag(lag);
  const AttitudeSettings& attitude = settings.attitude;
  ControlDesign d;
  d.rotor_lag_s = lag;
  d.roll = named_axis("roll", attitude.model, attitude.roll, lag);
  d.pitch = named_axis("pitch", attitude.model, attitude.pitch, lag);
  d.yaw = named_axis("yaw", attitude.model, attitude.yaw, lag);
  d.x = position_axis("x", settings.position.x);
  d.y = position_axis("y", settings.position.y);
  d.z = position_axis("z", settings.position.z);
  analyse(d.x, horizontal_position_loop(d.x.gains, d.pitch.k, {lag}));
  analyse(d.y, horizontal_position_loop(d.y.gains, d.roll.k, {lag}));
  d.thrust_lead = settings.rough_air.thrust_lead;
  analyse(d.z, vertical_position_loop(d.z.gains, led({lag}, d.thrust_lead)));
  return d;
}

std::vector<plant::Violation> unstable_loops(const ControlDesign& design) {
  std::vector<plant::Violation> found;
  note_if_unstable(found, "attitude.roll", design.roll.poles_with_lag);
  note_if_unstable(found, "attitude.pitch", design.pitch.poles_with_lag);
  note_if_unstable(found, "attitude.yaw", design.yaw.poles_with_lag);
  note_if_unstable(found, "position.x", design.x.poles);
  note_if_unstable(found, "position.y", design.y.poles);
  note_if_unstable(found, "position.z", design.z.poles);
  return found;
}

}  // namespace swiftlet::control
