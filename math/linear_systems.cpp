#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::math {

Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

// Solves (Re A + i Im A)(Re X + i Im X) = Re B + i Im B as a real system of twice the size.
Eigen::MatrixXcd solve(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd real_a(2 * n, 2 * n);
  real_a << a.real(), -a.imag(), a.imag(), a.real();
  Eigen::MatrixXd real_b(2 * n, b.cols());
  real_b << b.real(), b.imag();
  const Eigen::MatrixXd x = solve(real_a, real_b);
  Eigen::MatrixXcd out(n, b.cols());
  out.real() = x.topRows(n);
  out.imag() = x.bottomRows(n);
  return out;
}

Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.llt().solve(b);
}

bool is_positive_definite(const Eigen::MatrixXd& a) {
  return Eigen::LLT<Eigen::MatrixXd>(a).info() == Eigen::Success;
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& a) {
  return a.colPivHouseholderQr().matrixR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

}  // namespace swiftlet::math
