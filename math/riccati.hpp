// Linear-quadratic design for small dense systems. The functions allocate and throw: use them at start-up
// only.
#pragma once

#include <Eigen/Core>

namespace swiftlet::math {

// The stabilising solution X of A'X + XA - XBR^-1B'X + Q = 0: symmetric, positive semidefinite, A - BR^-1B'X
// stable. A is n x n, B n x m, Q n x n symmetric positive semidefinite, R m x m symmetric positive definite.
//
// The ordered Schur form of the Hamiltonian gives a first solution (Laub 1979). Newton's method on the
// equation refines it (Kleinman 1968). Intended for n up to about 12.
//
// Throws std::invalid_argument with a sentence if a shape or a definiteness is wrong, if (A, B) is not
// stabilisable, or if Q leaves a mode of A on the imaginary axis unweighted, so that no stabilising solution
// exists.
Eigen::MatrixXd solve_care(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                           const Eigen::MatrixXd& r);

// Relative residual of the equation: |A'X + XA - XBR^-1B'X + Q| over 2 |A||X| + |X|^2 |BR^-1B'| + |Q|, in
// Frobenius norms.
double care_residual(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                     const Eigen::MatrixXd& r, const Eigen::MatrixXd& x);

// LQR gain K = R^-1 B'X, m x n, for u = -K x. Throws like solve_care.
Eigen::MatrixXd lqr(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& q,
                    const Eigen::MatrixXd& r);

// Solves the Lyapunov equation A'X + XA + Q = 0 for a stable A and a symmetric Q.
Eigen::MatrixXd solve_lyapunov(const Eigen::MatrixXd& a, const Eigen::MatrixXd& q);

}  // namespace swiftlet::math
