#include "swiftlet/control/design/flown_loops.hpp"

#include <cmath>

#include "swiftlet/control/design/control_gains.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Rotors behind the delay, with their observer: x' = A x + b u.
struct Rotors {
  MatrixXd a;
  VectorXd b;
  static constexpr Index kResponse = 0;  // state: moment / inertia, or thrust / mass
  static constexpr Index kObserved = 1;  // state: the same, as observed
};

// Pade approximation of third order of exp(-s T), with z = s T:
//   -1 + (24 z^2 + 240) / (z^3 + 12 z^2 + 60 z + 120).
void add_delay(Rotors& rotors, double lag_s, double delay_s) {
  const Index first = rotors.a.rows();
  const Index n = first + 3;
  rotors.a.conservativeResizeLike(MatrixXd::Zero(n, n));
  rotors.b.conservativeResizeLike(VectorXd::Zero(n));
  rotors.a.block<3, 3>(first, first) << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -120.0, -60.0, -12.0;
  rotors.a.block<3, 3>(first, first) /= delay_s;
  rotors.b[first + 2] = 1.0 / delay_s;
  rotors.a.block<1, 3>(Rotors::kResponse, first) << 240.0 / lag_s, 0.0, 24.0 / lag_s;
  rotors.b[Rotors::kResponse] = -1.0 / lag_s;
}

Rotors behind_delay(const ObservedRotors& of, double delay_s) {
  Rotors rotors{MatrixXd::Zero(2, 2), VectorXd::Constant(2, 1.0 / of.lag_s)};
  rotors.a << -1.0 / of.lag_s, 0.0, of.correction, -1.0 / of.lag_s - of.correction;
  if (delay_s > 0.0) add_delay(rotors, of.lag_s, delay_s);
  return rotors;
}

// The command compensates the part of the response that is not observed, behind the low pass of the disturbance observer: of
// first order, or of second order in incremental inversion. bandwidth: rad/s; 0: none.
void compensate(Rotors& rotors, double bandwidth, bool incremental) {
  if (!(bandwidth > 0.0)) return;
  const Index estimate = rotors.a.rows();
  const Index n = estimate + (incremental ? 2 : 1);
  const Index last = n - 1;
  const double gain = incremental ? bandwidth * bandwidth : bandwidth;
  rotors.a.conservativeResizeLike(MatrixXd::Zero(n, n));
  rotors.b.conservativeResizeLike(VectorXd::Zero(n));
  rotors.a(last, Rotors::kResponse) = gain;
  rotors.a(last, Rotors::kObserved) = -gain;
  rotors.a(last, estimate) = -gain;
  if (incremental) {
    rotors.a(estimate, last) = 1.0;
    rotors.a(last, last) = -std::sqrt(2.0) * bandwidth;
  }
  rotors.a.col(estimate) -= rotors.b;
}

// States: angle, rate, then those of the rotors.
FlownLoop attitude(const Eigen::Vector3d& k, const Rotors& rotors) {
  const Index n = 2 + rotors.a.rows();
  Loop loop{MatrixXd::Zero(n, n), VectorXd::Zero(n), RowVectorXd::Zero(n)};
  loop.a(0, 1) = 1.0;
  loop.a(1, 2 + Rotors::kResponse) = 1.0;
  loop.a.bottomRightCorner(n - 2, n - 2) = rotors.a;
  loop.b.tail(n - 2) = rotors.b;
  loop.c[0] = k[0];
  loop.c[1] = k[1];
  loop.c[2 + Rotors::kObserved] = k[2];
  return {loop, k[0] * loop.b, RowVectorXd::Unit(n, 0)};
}

FlownLoop horizontal(const RptGains& gains, const FlownLoop& inner) {
  return flown_position_loop(gains, inner.loop.a - inner.loop.b * inner.loop.c, inner.reference,
                             inner.output);
}

// exp(A) by scaling, a Taylor series, and squaring.
MatrixXd exponential(const MatrixXd& a) {
  constexpr int kTerms = 16;
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.25 ? static_cast<int>(std::ceil(std::log2(norm / 0.25))) : 0;
  const MatrixXd scaled = a / std::exp2(squarings);
  MatrixXd sum = MatrixXd::Identity(a.rows(), a.rows());
  MatrixXd term = sum;
  for (int i = 1; i <= kTerms; ++i) {
    term = (term * scaled / i).eval();
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = (sum * sum).eval();
  return sum;
}

}  // namespace

FlownLoop flown_position_loop(const RptGains& gains, const MatrixXd& inner_a, const VectorXd& inner_b,
                              const RowVectorXd& acceleration) {
  const Loop loop = position_loop(gains, inner_a, inner_b, acceleration);
  const Index place = gains.k_i > 0.0 ? 1 : 0;
  FlownLoop out{loop, gains.k_p * loop.b, RowVectorXd::Unit(loop.a.rows(), place)};
  if (gains.k_i > 0.0) out.reference[0] = -1.0;
  return out;
}

FlownLoop flown_vertical_loop(const RptGains& gains, const ObservedRotors& observed,
                              double disturbance_bandwidth, double delay_s) {
  Rotors rotors = behind_delay(observed, delay_s);
  rotors.a.col(Rotors::kObserved) -= observed.thrust_lead * rotors.b;
  rotors.b *= 1.0 + observed.thrust_lead;
  compensate(rotors, disturbance_bandwidth, observed.incremental);
  return flown_position_loop(gains, rotors.a, rotors.b,
                             RowVectorXd::Unit(rotors.a.rows(), Rotors::kResponse));
}

std::array<FlownLoop, 6> flown_loops(const ControlGains& gains, const ObservedRotors& observed,
                                     double delay_s) {
  Rotors rotors = behind_delay(observed, delay_s);
  const auto attitude_k = [&](Index axis) {
    return Eigen::Vector3d(gains.attitude_angle[axis], gains.attitude_rate[axis],
                           gains.attitude_acceleration[axis]);
  };
  const auto position_k = [&](Index axis) {
    return RptGains{gains.position_p[axis], gains.position_v[axis], gains.position_i[axis]};
  };
  if (observed.incremental) compensate(rotors, gains.disturbance_bandwidth, true);
  const FlownLoop roll = attitude(attitude_k(0), rotors);
  const FlownLoop pitch = attitude(attitude_k(1), rotors);
  return {roll,
          pitch,
          attitude(attitude_k(2), rotors),
          horizontal(position_k(0), pitch),
          horizontal(position_k(1), roll),
          flown_vertical_loop(position_k(2), observed, gains.disturbance_bandwidth, delay_s)};
}

std::array<FlownLoop, 6> flown_loops(const ControlDesign& design, const ControlSettings& settings,
                                     double delay_s) {
  return flown_loops(control_gains(design, settings), observed_rotors(design.rotor_lag_s, settings), delay_s);
}

ObservedRotors observed_rotors(double rotor_lag_s, const ControlSettings& settings) {
  return {rotor_lag_s, settings.estimator.rotor_speed_bandwidth, settings.rough_air.thrust_lead,
          settings.rough_air.law == DisturbanceLaw::kIncremental};
}

// The reference is one more state, which is constant.
std::vector<double> step_response(const FlownLoop& loop, double step_s, std::size_t count) {
  const Index n = loop.loop.a.rows();
  MatrixXd a = MatrixXd::Zero(n + 1, n + 1);
  a.topLeftCorner(n, n) = loop.loop.a - loop.loop.b * loop.loop.c;
  a.topRightCorner(n, 1) = loop.reference;
  const MatrixXd transition = exponential(a * step_s);
  VectorXd state = VectorXd::Unit(n + 1, n);
  std::vector<double> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(loop.output.dot(state.head(n)));
    state = (transition * state).eval();
  }
  return out;
}

}  // namespace swiftlet::control
