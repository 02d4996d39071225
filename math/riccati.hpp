// Linear-quadratic design for small dense systems. Runs once, at start: it may allocate and throw.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

// The stabilising solution X of A'X + XA - XBR^-1B'X + Q = 0: symmetric, positive semidefinite, A - BR^-1B'X
// stable. A is n x n, B n x m, Q n x n symmetric positive semidefinite, R m x m symmetric positive definite.
//
// The first digits come from the ordered Schur form of the Hamiltonian (Laub 1979), the last from Newton's
// method on the equation itself (Kleinman 1968). Meant for n up to about 12.
//
// Throws std::invalid_argument with a sentence if a shape or a definiteness is wrong, if a mode of A that is
// not stable cannot be reached from B, or if Q leaves a mode on the imaginary axis unweighted, so that no
// stabilising solution exists.
Eigen::MatrixXd solve_care(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                           const Eigen::MatrixXd& r);

// |A'X + XA - XBR^-1B'X + Q| over 2 |A||X| + |X|^2 |BR^-1B'| + |Q|, in Frobenius norms.
double care_residual(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                     const Eigen::MatrixXd& r, const Eigen::MatrixXd& x);

// K = R^-1 B'X, m x n, for u = -K x. Throws as solve_care does.
Eigen::MatrixXd lqr(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                    const Eigen::MatrixXd& r);

// X with A'X + XA + Q = 0 for a stable A and a symmetric Q.
Eigen::MatrixXd solve_lyapunov(const Eigen::MatrixXd& a, const Eigen::MatrixXd& q);

}  // namespace swiftlet::control
