#include "swiftlet/math/riccati.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>

#include <Eigen/Jacobi>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::math {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

constexpr int kNewtonIterations = 30;
constexpr double kSymmetryTolerance = 1e-12;
constexpr double kRankTolerance = 1e-10;
constexpr double kResidualLimit = 1e-10;

MatrixXd symmetric_part(const MatrixXd& m) { return 0.5 * (m + m.transpose()); }

double largest_entry(const MatrixXd& m) { return m.size() > 0 ? m.cwiseAbs().maxCoeff() : 0.0; }

bool is_symmetric(const MatrixXd& m) {
  return largest_entry(m - m.transpose()) <= kSymmetryTolerance * largest_entry(m);
}

std::string shape(const MatrixXd& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

[[noreturn]] void refuse(const std::string& sentence) { throw std::invalid_argument(sentence); }

void check_problem(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q, const MatrixXd& r) {
  const Eigen::Index n = a.rows();
  if (n == 0 || a.cols() != n) refuse("A is " + shape(a) + ", must be square and not empty");
  if (b.rows() != n || b.cols() == 0) {
    refuse("B is " + shape(b) + ", must have " + std::to_string(n) +
           " rows, as A has, and at least one column");
  }
  if (q.rows() != n || q.cols() != n) refuse("Q is " + shape(q) + ", must be " + shape(a) + ", as A is");
  if (r.rows() != b.cols() || r.cols() != b.cols()) {
    refuse("R is " + shape(r) + ", must be square with a row for each column of B");
  }
  if (!a.allFinite() || !b.allFinite() || !q.allFinite() || !r.allFinite()) {
    refuse("A, B, Q and R must be finite");
  }
  if (!is_symmetric(q)) refuse("Q must be symmetric");
  if (!is_symmetric(r)) refuse("R must be symmetric");
  const double least_q = math::symmetric_eigen(q).values[0];
  if (least_q < -kSymmetryTolerance * largest_entry(q)) {
    refuse("Q has the eigenvalue " + std::to_string(least_q) + ", must be positive semidefinite");
  }
  if (!math::is_positive_definite(r)) refuse("R must be positive definite");
}

// Popov-Belevitch-Hautus test: every mode lambda of A that is not stable must be controllable, rank [A -
// lambda I, B] = n.
void check_stabilisable(const MatrixXd& a, const MatrixXd& b) {
  const Eigen::Index n = a.rows();
  const VectorXcd modes = math::eigenvalues(a);
  for (const std::complex<double>& mode : modes) {
    if (mode.real() < 0.0) continue;
    // [A - lambda I, B] as a real matrix of twice the rank.
    const MatrixXd real = a - mode.real() * MatrixXd::Identity(n, n);
    const MatrixXd imaginary = mode.imag() * MatrixXd::Identity(n, n);
    const MatrixXd none = MatrixXd::Zero(n, b.cols());
    MatrixXd pencil(2 * n, 2 * (n + b.cols()));
    pencil << real, imaginary, b, none, -imaginary, real, none, b;
    const Eigen::VectorXd s = math::singular_values(pencil);
    if (s[2 * n - 1] <= kRankTolerance * s[0]) {
      refuse("(A, B) is not stabilisable: the mode at " + std::to_string(mode.real()) + " + " +
             std::to_string(std::abs(mode.imag())) + "i cannot be reached by the input");
    }
  }
}

// Exchanges the eigenvalues k and k + 1 of the complex Schur form T, keeping U T U^H
// (Golub and Van Loan 7.6.2).
void swap_eigenvalues(MatrixXcd& t, MatrixXcd& u, Eigen::Index k) {
  Eigen::JacobiRotation<std::complex<double>> rotation;
  rotation.makeGivens(t(k, k + 1), t(k + 1, k + 1) - t(k, k));
  t.applyOnTheLeft(k, k + 1, rotation.adjoint());
  t.applyOnTheRight(k, k + 1, rotation);
  u.applyOnTheRight(k, k + 1, rotation);
  t(k + 1, k) = 0.0;
}

// X from the stable invariant subspace of the Hamiltonian [A, -G; -Q, -A'], by its ordered Schur form (Laub
// 1979). The result is NaN if the Hamiltonian does not have n stable eigenvalues.
MatrixXd solution_by_schur(const MatrixXd& a, const MatrixXd& g, const MatrixXd& q) {
  const Eigen::Index n = a.rows();
  // X = size * X'. This scaling gives both off-diagonal blocks the same norm.
  const double size = q.norm() > 0.0 && g.norm() > 0.0 ? std::sqrt(q.norm() / g.norm()) : 1.0;
  MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << a, -size * g, -q / size, -a.transpose();
  auto [t, u] = math::complex_schur(hamiltonian);
  Eigen::Index stable = 0;
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    if (t(i, i).real() >= 0.0) continue;
    for (Eigen::Index k = i; k > stable; --k) swap_eigenvalues(t, u, k - 1);
    ++stable;
  }
  if (stable != n) return MatrixXd::Constant(n, n, std::nan(""));
  // X = U21 U11^-1.
  const MatrixXcd x = math::solve(MatrixXcd(u.topLeftCorner(n, n).transpose()),
                                  MatrixXcd(u.bottomLeftCorner(n, n).transpose()));
  return size * symmetric_part(x.real());
}

bool is_stable(const MatrixXd& a) { return a.allFinite() && math::eigenvalues(a).real().maxCoeff() < 0.0; }

}  // namespace

MatrixXd solve_lyapunov(const MatrixXd& a, const MatrixXd& q) {
  // (I (x) A' + A' (x) I) vec X = -vec Q.
  const Eigen::Index n = a.rows();
  MatrixXd kronecker = MatrixXd::Zero(n * n, n * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    kronecker.block(i * n, i * n, n, n) += a.transpose();
    for (Eigen::Index j = 0; j < n; ++j) {
      kronecker.block(i * n, j * n, n, n).diagonal().array() += a(j, i);
    }
  }
  const MatrixXd x = math::solve(kronecker, -q.reshaped());
  return symmetric_part(x.reshaped(n, n));
}

double care_residual(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q, const MatrixXd& r,
                     const MatrixXd& x) {
  const MatrixXd ax = a.transpose() * x;
  const MatrixXd g = b * math::solve_positive_definite(r, b.transpose());
  const double scale = 2.0 * a.norm() * x.norm() + x.norm() * g.norm() * x.norm() + q.norm();
  return scale > 0.0 ? (ax + ax.transpose() - x * g * x + q).norm() / scale : 0.0;
}

MatrixXd solve_care(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q, const MatrixXd& r) {
  check_problem(a, b, q, r);
  check_stabilisable(a, b);
  const MatrixXd g = b * math::solve_positive_definite(r, b.transpose());
  MatrixXd x = solution_by_schur(a, g, q);
  // Kleinman's iteration, (A - G X)' X+ + X+ (A - G X) + Q + X G X = 0, while the residual decreases.
  double residual = x.allFinite() ? care_residual(a, b, q, r, x) : 0.0;
  for (int i = 0; i < kNewtonIterations && is_stable(a - g * x); ++i) {
    const MatrixXd next = solve_lyapunov(a - g * x, q + x * g * x);
    const double next_residual = next.allFinite() ? care_residual(a, b, q, r, next) : residual;
    if (!(next_residual < residual)) break;
    x = next;
    residual = next_residual;
  }
  if (!is_stable(a - g * x) || residual > kResidualLimit) {
    refuse(
        "no stabilising solution of the Riccati equation: Q must weight every mode of A on the imaginary "
        "axis");
  }
  return x;
}

MatrixXd lqr(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q, const MatrixXd& r) {
  return math::solve_positive_definite(r, b.transpose() * solve_care(a, b, q, r));
}

}  // namespace swiftlet::math
