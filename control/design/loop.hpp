// A single loop, cut at one place: x' = A x + b u, y = c x, closed by u = -y.
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace swiftlet::control {

struct Loop {
  Eigen::MatrixXd a;     // n x n
  Eigen::VectorXd b;     // n
  Eigen::RowVectorXd c;  // n
};

// L(j omega) = c (j omega I - A)^-1 b, omega in rad/s, not a pole of the open loop.
std::complex<double> frequency_response(const Loop& loop, double omega);

// All omega > 0, rad/s, ascending, at which |L(j omega)| = 1. From the imaginary eigenvalues of the
// Hamiltonian [A, bb'; -c'c, -A'] (Boyd, Balakrishnan, Kabamba 1989), so none is missed between grid points.
std::vector<double> crossovers(const Loop& loop);

// Phase margin in degrees: the one of least magnitude over all crossovers. Negative if the phase there is
// beyond -180 degrees; infinite without a crossover.
double phase_margin_deg(const Loop& loop);

// Eigenvalues of A - b c, sorted by real, then imaginary part.
std::vector<std::complex<double>> closed_loop_poles(const Loop& loop);

}  // namespace swiftlet::control
