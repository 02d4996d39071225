#include "control/design/loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace swiftlet::control {
namespace {

constexpr double kPi = 3.14159265358979323846;
// An eigenvalue of the Hamiltonian counts as imaginary if the gain there is one to within this; rounding
// moves the eigenvalue by far less, and a Newton-like step then brings the gain to one.
constexpr double kGainTolerance = 1e-4;

double log_gain(const Loop& loop, double omega) {
  return std::log(std::abs(frequency_response(loop, omega)));
}

// Secant steps on log |L| over log omega from a start that is nearly right.
double refine_crossover(const Loop& loop, double omega) {
  double x0 = std::log(omega);
  double f0 = log_gain(loop, omega);
  double x1 = x0 + 1e-6;
  for (int i = 0; i < 20; ++i) {
    const double f1 = log_gain(loop, std::exp(x1));
    if (f1 == f0 || !std::isfinite(f1)) break;
    const double x2 = x1 - f1 * (x1 - x0) / (f1 - f0);
    if (!(std::abs(x2 - x1) < 0.1)) break;
    x0 = x1;
    f0 = f1;
    x1 = x2;
    if (std::abs(x1 - x0) < 1e-14) break;
  }
  return std::exp(x1);
}

}  // namespace

std::complex<double> frequency_response(const Loop& loop, double omega) {
  const Eigen::Index n = loop.a.rows();
  Eigen::MatrixXcd resolvent = -loop.a.cast<std::complex<double>>();
  resolvent.diagonal().array() += std::complex<double>(0.0, omega);
  const Eigen::VectorXcd x = resolvent.partialPivLu().solve(loop.b.cast<std::complex<double>>());
  std::complex<double> y = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) y += loop.c[i] * x[i];
  return y;
}

std::vector<double> crossovers(const Loop& loop) {
  const Eigen::Index n = loop.a.rows();
  Eigen::MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << loop.a, loop.b * loop.b.transpose(), -loop.c.transpose() * loop.c, -loop.a.transpose();
  const Eigen::VectorXcd eigenvalues = hamiltonian.eigenvalues();
  std::vector<double> found;
  for (const std::complex<double>& lambda : eigenvalues) {
    const double omega = lambda.imag();
    if (!(omega > 0.0) || std::abs(lambda.real()) > 1e-3 * omega) continue;
    if (std::abs(log_gain(loop, omega)) < kGainTolerance) found.push_back(refine_crossover(loop, omega));
  }
  std::sort(found.begin(), found.end());
  return found;
}

double phase_margin_deg(const Loop& loop) {
  double margin = std::numeric_limits<double>::infinity();
  for (const double omega : crossovers(loop)) {
    const double here = std::arg(-frequency_response(loop, omega)) * 180.0 / kPi;
    if (std::abs(here) < std::abs(margin)) margin = here;
  }
  return margin;
}

std::vector<std::complex<double>> closed_loop_poles(const Loop& loop) {
  const Eigen::VectorXcd eigenvalues = (loop.a - loop.b * loop.c).eigenvalues();
  std::vector<std::complex<double>> poles(eigenvalues.begin(), eigenvalues.end());
  std::sort(poles.begin(), poles.end(), [](const std::complex<double>& l, const std::complex<double>& r) {
    return l.real() != r.real() ? l.real() < r.real() : l.imag() < r.imag();
  });
  return poles;
}

}  // namespace swiftlet::control
