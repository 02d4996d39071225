// Decompositions of dense matrices of any size. They stand here, and not where they are used, because the compiler
// takes seconds for each of Eigen's. For what runs once, at start: they allocate.
#pragma once

#include <Eigen/Core>

namespace swiftlet::math {

// The eigenvalues of a square matrix, complex ones in conjugate pairs, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

// A = V diag(values) V' of a symmetric A, of which the lower triangle is read; values rise.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // a column for each value
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

// Falling.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

// A = U T U^H of a square matrix: U is unitary, T upper triangular.
struct ComplexSchur {
  Eigen::MatrixXcd t;
  Eigen::MatrixXcd u;
};
ComplexSchur complex_schur(const Eigen::MatrixXd& a);

// X with A X = B for a square A, by elimination with row pivoting; not finite where A is singular.
Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXcd solve(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b);

// X with A X = B for a symmetric positive definite A, by Cholesky's factors.
Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
bool is_positive_definite(const Eigen::MatrixXd& a);

// The x, a column for each of B, that makes |A X - B| least, by Householder's QR with column pivoting.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// The square R of the same, A P = Q R, of an A with at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& a);

}  // namespace swiftlet::math
