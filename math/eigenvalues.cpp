#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::math {

// The eigenvalues are those of the diagonal blocks of the real Schur form: 1 x 1, or 2 x 2 with a conjugate
// pair.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a) {
  const Eigen::RealSchur<Eigen::MatrixXd> schur(a, false);
  const Eigen::MatrixXd& t = schur.matrixT();
  const Eigen::Index n = t.rows();
  Eigen::VectorXcd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 == n || t(i + 1, i) == 0.0) {
      values[i] = t(i, i);
      continue;
    }
    const double half_difference = 0.5 * (t(i, i) - t(i + 1, i + 1));
    const double square = half_difference * half_difference + t(i + 1, i) * t(i, i + 1);
    const std::complex<double> pair(t(i + 1, i + 1) + half_difference, std::sqrt(std::abs(square)));
    values[i] = pair;
    values[++i] = std::conj(pair);
  }
  return values;
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// The eigenvalues of [0 A; A' 0] are the singular values of A, their negatives, and zeros. The cost grows
// with the cube of rows plus columns. A matrix with more rows than columns is therefore replaced by its
// triangular factor R, which has the same singular values.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a) {
  const Eigen::Index m = a.rows();
  const Eigen::Index n = a.cols();
  if (m > n) return singular_values(triangular_factor(a));
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(m + n, m + n);
  both.bottomLeftCorner(n, m) = a.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(both, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().tail(std::min(m, n)).reverse().cwiseMax(0.0);
}

ComplexSchur complex_schur(const Eigen::MatrixXd& a) {
  const Eigen::ComplexSchur<Eigen::MatrixXd> schur(a);
  return {schur.matrixT(), schur.matrixU()};
}

}  // namespace swiftlet::math
