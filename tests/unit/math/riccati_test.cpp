#include "swiftlet/math/riccati.hpp"

#include <cmath>
#include <complex>
#include <random>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::math::riccati_test {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  MatrixXd matrix(int rows, int columns) {
    return MatrixXd::NullaryExpr(rows, columns, [this] { return normal_(generator_); });
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  double scale() { return std::pow(10.0, std::uniform_real_distribution<double>(-2.0, 2.0)(generator_)); }

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

double largest_real_part(const MatrixXd& a) { return math::eigenvalues(a).real().maxCoeff(); }

double least_eigenvalue(const MatrixXd& x) { return math::symmetric_eigen(x).values[0]; }

struct Problem {
  MatrixXd a, b, q, r;
};

// |A'X + XA - XBR^-1B'X + Q| relative to the size of its terms.
double residual(const Problem& p, const MatrixXd& x) {
  const MatrixXd g = p.b * math::solve_positive_definite(p.r, p.b.transpose());
  const MatrixXd left = p.a.transpose() * x + x * p.a - x * g * x + p.q;
  return left.norm() / (2.0 * p.a.norm() * x.norm() + x.norm() * x.norm() * g.norm() + p.q.norm());
}

// X = V2 V1^-1, where [V1; V2] are the eigenvectors of the Hamiltonian [A, -BR^-1B'; -Q, -A'] left of the
// imaginary axis (MacFarlane 1963, Potter 1966), here by inverse iteration: an independent method, less exact than the
// code's.
MatrixXd by_eigenvectors(const Problem& p) {
  const Eigen::Index n = p.a.rows();
  MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << p.a, -p.b * math::solve_positive_definite(p.r, p.b.transpose()), -p.q, -p.a.transpose();
  MatrixXcd stable(2 * n, n);
  Eigen::Index found = 0;
  for (const std::complex<double>& value : math::eigenvalues(hamiltonian)) {
    if (value.real() >= 0.0 || found == n) continue;
    MatrixXcd shifted = hamiltonian;
    shifted.diagonal().array() -= value * (1.0 + 1e-12);
    MatrixXcd vector = MatrixXcd::Ones(2 * n, 1);
    for (int iteration = 0; iteration < 3; ++iteration) vector = math::solve(shifted, vector).normalized();
    stable.col(found++) = vector;
  }
  const MatrixXcd upper = stable.topRows(n).transpose();
  const MatrixXcd lower = stable.bottomRows(n).transpose();
  return math::solve(upper, lower).transpose().real();
}

Eigen::Matrix2d two_by_two(double a, double b, double c, double d) {
  return (Eigen::Matrix2d() << a, b, c, d).finished();
}

// Random systems, stable or not, with weights of any size; Q positive definite.
Problem random_problem(Random& random) {
  const int n = random.integer(1, 8);
  const int m = random.integer(1, n);
  const MatrixXd half_q = random.matrix(n, n);
  const MatrixXd half_r = random.matrix(m, m);
  return {random.scale() * random.matrix(n, n), random.matrix(n, m),
          random.scale() * (half_q * half_q.transpose() + 0.01 * MatrixXd::Identity(n, n)),
          random.scale() * (half_r * half_r.transpose() + 0.01 * MatrixXd::Identity(m, m))};
}

std::string refusal(const Problem& p) {
  try {
    solve_care(p.a, p.b, p.q, p.r);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Riccati, SolvesRandomSystems) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Problem p = random_problem(random);
    const MatrixXd x = solve_care(p.a, p.b, p.q, p.r);
    EXPECT_LT(residual(p, x), 1e-13) << "trial " << trial << ", n = " << p.a.rows();
    EXPECT_LT(care_residual(p.a, p.b, p.q, p.r, x), 1e-14) << "trial " << trial;
    EXPECT_EQ(x, x.transpose());
    EXPECT_GT(least_eigenvalue(x), 0.0) << "trial " << trial;
    EXPECT_LT(largest_real_part(p.a - p.b * lqr(p.a, p.b, p.q, p.r)), 0.0) << "trial " << trial;
  }
}

TEST(Riccati, AgreesWithTheHamiltonianEigenvectors) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Problem p = random_problem(random);
    const MatrixXd expected = by_eigenvectors(p);
    EXPECT_LT((solve_care(p.a, p.b, p.q, p.r) - expected).norm(), 1e-6 * expected.norm())
        << "trial " << trial;
  }
}

// X is arbitrary, so that the residual is not 0.
TEST(Riccati, ResidualMatchesTheEquation) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Problem p = random_problem(random);
    const int n = static_cast<int>(p.a.rows());
    const MatrixXd half = random.matrix(n, n);
    const MatrixXd x = half * half.transpose();
    const double expected = residual(p, x);
    EXPECT_NEAR(care_residual(p.a, p.b, p.q, p.r, x), expected, 1e-9 * expected) << "trial " << trial;
  }
}

// Benner, Laub, Mehrmann, "A collection of benchmark examples for the numerical solution of algebraic Riccati
// equations I: continuous-time case" (1995), the examples with a closed form.
TEST(Riccati, MatchesPublishedClosedForms) {
  const MatrixXd one = MatrixXd::Identity(1, 1);
  const auto expect = [](const Problem& p, const Eigen::Matrix2d& x) {
    EXPECT_LT((solve_care(p.a, p.b, p.q, p.r) - x).norm(), 1e-9 * x.norm());
  };
  expect({two_by_two(0, 1, 0, 0), Eigen::Vector2d(0, 1), two_by_two(1, 0, 0, 2), one},
         two_by_two(2, 1, 1, 2));
  const double s = 1.0 + std::sqrt(2.0);
  expect({two_by_two(4, 3, -4.5, -3.5), Eigen::Vector2d(1, -1), two_by_two(9, 6, 6, 4), one},
         s * two_by_two(9, 6, 6, 4));
  for (const double e : {1.0, 1e-2, 1e-4}) {
    const double root = std::sqrt(1.0 + e * e);
    const double x12 = 1.0 / (2.0 + root);
    expect({two_by_two(1, 0, 0, -2), Eigen::Vector2d(e, 0), two_by_two(1, 1, 1, 1), one},
           two_by_two((1.0 + root) / (e * e), x12, x12, 0.25 * (1.0 - e * e * x12 * x12)));
    const double x22 = std::sqrt(1.0 + 2.0 * e);
    expect({two_by_two(0, e, 0, 0), Eigen::Vector2d(0, 1), two_by_two(1, 0, 0, 1), one},
           two_by_two(x22 / e, 1.0, 1.0, x22));
  }
}

// X = integral e^A't Q e^At dt.
TEST(Riccati, LyapunovSolutionIsTheCostIntegral) {
  const MatrixXd a = two_by_two(-1.0, 2.0, 0.0, -3.0);
  const MatrixXd q = two_by_two(4.0, 1.0, 1.0, 2.0);
  // e^At = [e^-t, e^-t - e^-3t; 0, e^-3t].
  const double x11 = 4.0 / 2.0;
  const double x12 = 4.0 / 2.0 + (1.0 - 4.0) / 4.0;
  const double x22 = 4.0 / 2.0 + 2.0 * (1.0 - 4.0) / 4.0 + (4.0 - 2.0 + 2.0) / 6.0;
  EXPECT_LT((solve_lyapunov(a, q) - two_by_two(x11, x12, x12, x22)).norm(), 1e-13);
}

TEST(Riccati, GainMinimisesTheCost) {
  // The cost from x0 is x0' P x0 with (A-BK)' P + P (A-BK) + Q + K'RK = 0: any other gain costs more.
  Random random(2);
  int compared = 0;
  while (compared < 40) {
    const Problem p = random_problem(random);
    const MatrixXd x = solve_care(p.a, p.b, p.q, p.r);
    const MatrixXd best = lqr(p.a, p.b, p.q, p.r);
    const MatrixXd other =
        best +
        0.05 * best.norm() * random.matrix(static_cast<int>(best.rows()), static_cast<int>(best.cols()));
    const MatrixXd closed = p.a - p.b * other;
    if (largest_real_part(closed) >= 0.0) continue;
    const MatrixXd cost = solve_lyapunov(closed, p.q + other.transpose() * p.r * other);
    EXPECT_GT(least_eigenvalue(cost - x), -1e-9 * cost.norm());
    EXPECT_GT((cost - x).trace(), 0.0);
    ++compared;
  }
}

TEST(Riccati, MatchesTheClosedFormOfADoubleIntegrator) {
  MatrixXd a(2, 2);
  a << 0.0, 1.0, 0.0, 0.0;
  const MatrixXd b = Eigen::Vector2d(0.0, 1.0);
  for (const double q1 : {1e-2, 1.0, 625.0, 1e4, 1e6}) {
    for (const double q2 : {0.0, 1.0, 300.0}) {
      for (const double r : {1e-3, 1.0, 50.0}) {
        const MatrixXd k = lqr(a, b, Eigen::Vector2d(q1, q2).asDiagonal(), MatrixXd::Constant(1, 1, r));
        const double k1 = std::sqrt(q1 / r);
        const double k2 = std::sqrt(q2 / r + 2.0 * k1);
        EXPECT_NEAR(k(0, 0), k1, 1e-11 * k1);
        EXPECT_NEAR(k(0, 1), k2, 1e-11 * k2);
      }
    }
  }
}

TEST(Riccati, MatchesTheClosedFormOfAScalar) {
  for (const double a : {-3.0, 0.0, 2.0}) {
    const auto one = [](double v) { return MatrixXd::Constant(1, 1, v); };
    const MatrixXd x = solve_care(one(a), one(2.0), one(5.0), one(0.5));
    const double g = 2.0 * 2.0 / 0.5;
    EXPECT_NEAR(x(0, 0), (a + std::sqrt(a * a + g * 5.0)) / g, 1e-14);
  }
}

TEST(Riccati, AcceptsSemidefiniteWeightsAndUncontrollableStableModes) {
  MatrixXd a(3, 3);
  a << 0.0, 1.0, 0.3, 0.0, 0.0, 0.2, 0.0, 0.0, -2.0;
  const MatrixXd b = Eigen::Vector3d(0.0, 1.0, 0.0);
  const MatrixXd q = Eigen::Vector3d(1.0, 0.0, 0.0).asDiagonal();
  const MatrixXd r = MatrixXd::Identity(1, 1);
  const MatrixXd x = solve_care(a, b, q, r);
  EXPECT_LT(residual({a, b, q, r}, x), 1e-12);
  EXPECT_GT(least_eigenvalue(x), -1e-12);
  EXPECT_LT(largest_real_part(a - b * lqr(a, b, q, r)), 0.0);
}

TEST(Riccati, SolvesLyapunovEquations) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const int n = random.integer(1, 8);
    MatrixXd a = random.matrix(n, n);
    a -= (largest_real_part(a) + 0.1) * MatrixXd::Identity(n, n);
    const MatrixXd half = random.matrix(n, n);
    const MatrixXd q = half * half.transpose();
    const MatrixXd x = solve_lyapunov(a, q);
    EXPECT_LT((a.transpose() * x + x * a + q).norm(), 1e-10 * (x.norm() * a.norm() + q.norm()));
  }
}

TEST(Riccati, RefusesProblemsWithoutASolution) {
  const MatrixXd i1 = MatrixXd::Identity(1, 1);
  const MatrixXd i2 = MatrixXd::Identity(2, 2);
  MatrixXd integrators(2, 2);
  integrators << 0.0, 1.0, 0.0, 0.0;
  const MatrixXd force = Eigen::Vector2d(0.0, 1.0);

  MatrixXd unreached(2, 2);
  unreached << 1.0, 0.0, 0.0, -1.0;
  EXPECT_NE(refusal({unreached, force, i2, i1}).find("not stabilisable"), std::string::npos);
  EXPECT_NE(refusal({integrators, Eigen::Vector2d(1.0, 0.0), i2, i1}).find("not stabilisable"),
            std::string::npos);

  const MatrixXd only_rate = Eigen::Vector2d(0.0, 1.0).asDiagonal();
  EXPECT_NE(refusal({integrators, force, only_rate, i1}).find("imaginary axis"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, MatrixXd::Zero(2, 2), i1}).find("imaginary axis"),
            std::string::npos);

  EXPECT_NE(refusal({integrators, force, -i2, i1}).find("positive semidefinite"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, i2, -i1}).find("positive definite"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, i2, 0.0 * i1}).find("positive definite"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, integrators, i1}).find("symmetric"), std::string::npos);
  EXPECT_NE(refusal({MatrixXd::Zero(2, 3), force, i2, i1}).find("square"), std::string::npos);
  EXPECT_NE(refusal({integrators, i1, i2, i1}).find("B is 1 x 1"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, i1, i1}).find("Q is 1 x 1"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, i2, i2}).find("R is 2 x 2"), std::string::npos);
  EXPECT_NE(refusal({integrators, force, i2 * std::nan(""), i1}).find("finite"), std::string::npos);
}

}  // namespace swiftlet::math::riccati_test
