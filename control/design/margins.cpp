#include "control/design/margins.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <Eigen/Eigenvalues>

namespace swiftlet::control {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kImaginary = 1e-6;  // real over imaginary part, up to which a zero lies on the axis
constexpr double kLowest = 1e-4;     // rad/s: zeros below are those at 0, rounded
constexpr double kHighest = 1e7;     // rad/s: zeros beyond are those at infinity, rounded

}  // namespace

// L(s) - L(-s) = c (sI - A)^-1 b + c (sI + A)^-1 b, whose zeros are the generalized eigenvalues of its system
// matrix.
std::vector<double> phase_crossovers(const Loop& loop) {
  const Eigen::Index n = loop.a.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(2 * n + 1, 2 * n + 1);
  system.topLeftCorner(n, n) = loop.a;
  system.block(n, n, n, n) = -loop.a;
  system.block(0, 2 * n, n, 1) = loop.b;
  system.block(n, 2 * n, n, 1) = loop.b;
  system.block(2 * n, 0, 1, n) = loop.c;
  system.block(2 * n, n, 1, n) = loop.c;
  Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2 * n + 1, 2 * n + 1);
  identity(2 * n, 2 * n) = 0.0;
  const Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> zeros(system, identity, false);
  std::vector<double> found;
  for (Eigen::Index i = 0; i < 2 * n + 1; ++i) {
    const std::complex<double> alpha = zeros.alphas()[i];
    const double beta = zeros.betas()[i];
    if (!(std::abs(alpha) < kHighest * std::abs(beta))) continue;
    const std::complex<double> zero = alpha / beta;
    if (zero.imag() > kLowest && std::abs(zero.real()) < kImaginary * (1.0 + zero.imag()))
      found.push_back(zero.imag());
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
    double left = std::arg(-frequency_response(loop, omega));  // by which a delay may turn it
    if (left < 0.0) left += 2.0 * kPi;
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
