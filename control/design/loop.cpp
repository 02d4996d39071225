#include "swiftlet/control/design/loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/math/refine_zero.hpp"

namespace swiftlet::control {
namespace {

// An eigenvalue of the Hamiltonian counts as imaginary if the gain there is one to within this. Rounding
// moves the eigenvalue by far less. A root search then brings the gain to one.
constexpr double kGainTolerance = 1e-4;

double log_gain(const Loop& loop, double omega) {
  return std::log(std::abs(frequency_response(loop, omega)));
}

}  // namespace

std::complex<double> frequency_response(const Loop& loop, double omega) {
  const Eigen::Index n = loop.a.rows();
  Eigen::MatrixXcd resolvent = -loop.a.cast<std::complex<double>>();
  resolvent.diagonal().array() += std::complex<double>(0.0, omega);
  const Eigen::MatrixXcd x = math::solve(resolvent, Eigen::MatrixXcd(loop.b.cast<std::complex<double>>()));
  std::complex<double> y = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) y += loop.c[i] * x(i, 0);
  return y;
}

std::vector<double> crossovers(const Loop& loop) {
  const Eigen::Index n = loop.a.rows();
  Eigen::MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << loop.a, loop.b * loop.b.transpose(), -loop.c.transpose() * loop.c, -loop.a.transpose();
  const Eigen::VectorXcd eigenvalues = math::eigenvalues(hamiltonian);
  std::vector<double> found;
  for (const std::complex<double>& lambda : eigenvalues) {
    const double omega = lambda.imag();
    if (!(omega > 0.0) || std::abs(lambda.real()) > 1e-3 * omega) continue;
    if (std::abs(log_gain(loop, omega)) < kGainTolerance) {
      found.push_back(std::exp(
          math::refine_zero([&](double x) { return log_gain(loop, std::exp(x)); }, std::log(omega))));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

double phase_margin_deg(const Loop& loop) {
  double margin = std::numeric_limits<double>::infinity();
  for (const double omega : crossovers(loop)) {
    const double here = std::arg(-frequency_response(loop, omega)) * 180.0 / M_PI;
    if (std::abs(here) < std::abs(margin)) margin = here;
  }
  return margin;
}

std::vector<std::complex<double>> closed_loop_poles(const Loop& loop) {
  const Eigen::VectorXcd eigenvalues = math::eigenvalues(loop.a - loop.b * loop.c);
  std::vector<std::complex<double>> poles(eigenvalues.begin(), eigenvalues.end());
  std::sort(poles.begin(), poles.end(), [](const std::complex<double>& l, const std::complex<double>& r) {
    return l.real() != r.real() ? l.real() < r.real() : l.imag() < r.imag();
  });
  return poles;
}

}  // namespace swiftlet::control
