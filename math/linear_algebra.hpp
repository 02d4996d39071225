// Decompositions of dense matrices of any size. They are compiled once in this library because each of
// Eigen's decompositions takes seconds to compile. They allocate memory: use them at start-up only.
#pragma once

#include <Eigen/Core>

namespace swiftlet::math {

// Eigenvalues of a square matrix, unordered; complex eigenvalues are in conjugate pairs.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

// A = V diag(values) V' of a symmetric A. Only the lower triangle of A is read. The values are in ascending
// order.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // one column per value
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

// Singular values in descending order.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

// A = U T U^H of a square matrix: U is unitary, T upper triangular.
struct ComplexSchur {
  Eigen::MatrixXcd t;
  Eigen::MatrixXcd u;
};
ComplexSchur complex_schur(const Eigen::MatrixXd& a);

// Solves A X = B for a square A by LU decomposition with partial pivoting. The result is not finite if A is
// singular.
Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXcd solve(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);

// Solves A X = B for a symmetric positive definite A by Cholesky decomposition.
Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
bool is_positive_definite(const Eigen::MatrixXd& a);

// The X that minimises |A X - B|, by Householder QR with column pivoting.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// The square factor R of the same decomposition, A P = Q R. A has at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& a);

}  // namespace swiftlet::math
