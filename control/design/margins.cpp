#include "swiftlet/control/design/margins.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/math/refine_zero.hpp"

namespace swiftlet::control {
namespace {

constexpr double kNearAxis = 1e-3;      // real over imaginary part up to which a zero may lie on the axis
constexpr double kRealResponse = 1e-9;  // imaginary over real part up to which a response counts as real
constexpr double kLowest = 1e-4;        // rad/s: zeros below count as 0
constexpr double kShift = 1.1;          // over the mean pole: the pencil is not singular there

// The geometric mean of the magnitudes of the poles that are not at 0, rad/s. It is of the order of the
// zeros to be found, so that slow ones keep their precision.
double mean_pole(const Loop& loop) {
  double log_sum = 0.0;
  int count = 0;
  for (const std::complex<double>& pole : math::eigenvalues(loop.a)) {
    if (std::abs(pole) < kLowest) continue;
    log_sum += std::log(std::abs(pole));
    ++count;
  }
  return count > 0 ? std::exp(log_sum / count) : 1.0;
}

// Secant steps on the phase of -L over log omega, from a good initial value.
double refine_phase_crossover(const Loop& loop, double omega) {
  const auto phase = [&](double log_omega) {
    const std::complex<double> response = frequency_response(loop, std::exp(log_omega));
    return std::atan(response.imag() / response.real());
  };
  return std::exp(math::refine_zero(phase, std::log(omega)));
}

}  // namespace

// The imaginary ones of the 2n + 1 zeros of L(s) - L(-s) = c (sI - A)^-1 b + c (sI + A)^-1 b. The zeros are
// the s at which the pencil S - s E is singular. E is singular too, so they come from the eigenvalues 1 / (s
// - shift) of (S - shift E)^-1 E. Each is then refined.
std::vector<double> phase_crossovers(const Loop& loop) {
  const Eigen::Index n = loop.a.rows();
  const Eigen::Index size = 2 * n + 1;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  system.topLeftCorner(n, n) = loop.a;
  system.block(n, n, n, n) = -loop.a;
  system.block(0, 2 * n, n, 1) = loop.b;
  system.block(n, 2 * n, n, 1) = loop.b;
  system.block(2 * n, 0, 1, n) = loop.c;
  system.block(2 * n, n, 1, n) = loop.c;
  Eigen::MatrixXd e = Eigen::MatrixXd::Identity(size, size);
  e(2 * n, 2 * n) = 0.0;

  const double shift = kShift * mean_pole(loop);
  std::vector<double> found;
  for (const std::complex<double>& mu : math::eigenvalues(math::solve(system - shift * e, e))) {
    const std::complex<double> zero = shift + 1.0 / mu;
    if (!(zero.imag() > kLowest) || std::abs(zero.real()) > kNearAxis * zero.imag()) continue;
    const double omega = refine_phase_crossover(loop, zero.imag());
    const std::complex<double> response = frequency_response(loop, omega);
    if (std::abs(response.imag()) < kRealResponse * std::abs(response.real())) found.push_back(omega);
  }
  std::sort(found.begin(), found.end());
  return found;
}

LoopMargins margins(const Loop& loop) {
  LoopMargins out;
  const double phase = phase_margin_deg(loop);
  if (!(closed_loop_poles(loop).back().real() < 0.0)) {
    out.phase_deg = std::min(phase, 0.0);
    return out;
  }
  out.phase_deg = phase;
  out.delay_s = std::numeric_limits<double>::infinity();
  for (const double omega : crossovers(loop)) {
    double left = std::arg(-frequency_response(loop, omega));  // phase margin against a delay
    if (left < 0.0) left += 2.0 * M_PI;
    out.delay_s = std::min(out.delay_s, left / omega);
  }
  out.gain_increase = std::numeric_limits<double>::infinity();
  out.gain_decrease = 0.0;
  for (const double omega : phase_crossovers(loop)) {
    const double response = frequency_response(loop, omega).real();
    if (response >= 0.0) continue;
    const double factor = -1.0 / response;
    if (factor > 1.0) out.gain_increase = std::min(out.gain_increase, factor);
    if (factor < 1.0) out.gain_decrease = std::max(out.gain_decrease, factor);
  }
  return out;
}

}  // namespace swiftlet::control
