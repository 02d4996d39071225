// Polynomials by their Bernstein coefficients on one segment. The polynomial lies between the least and the
// greatest coefficient, so bounds hold everywhere, not only at samples (Farouki, "The Bernstein polynomial
// basis: a centennial retrospective", 2012).
#pragma once

#include <array>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

constexpr int kMaxBernsteinDegree = 14;  // the square of a position of degree 7

constexpr double kExtremumPrecision = 1e-6;  // for the checks of extrema, relative to the limit

// Over u = t / duration_s, 0 .. 1.
struct Bernstein {
  int degree = 0;
  std::array<double, kMaxBernsteinDegree + 1> c{};  // degree + 1 coefficients

  double greatest() const;
  double least() const;
};

// The Bernstein form of the derivative of order 0 .. 7 with respect to t in s. duration_s > 0.
Bernstein bernstein(const Polynomial& polynomial, double duration_s, int derivative = 0);
Bernstein constant(double value);

Bernstein operator+(const Bernstein& a, const Bernstein& b);
Bernstein operator-(const Bernstein& a, const Bernstein& b);
Bernstein operator*(double factor, const Bernstein& a);
// The sum of the degrees is at most kMaxBernsteinDegree.
Bernstein operator*(const Bernstein& a, const Bernstein& b);

// The square of the length of a vector.
template <class... Components>
Bernstein squared_length(const Components&... components) {
  return ((components * components) + ...);
}

struct Extremum {
  double value = 0.0;  // of the polynomial
  double at = 0.0;     // u
};

constexpr int kMaxSubdivisions = 256;

// The maximum to within `tolerance` (the true one is not more than that above): branch and bound with at most
// kMaxSubdivisions of de Casteljau's subdivisions. If they do not suffice, `value` is an upper bound that may
// be further above the maximum, and `at` is the best point found.
Extremum maximum(const Bernstein& polynomial, double tolerance);
// The minimum, likewise; the true one is at most `tolerance` below.
Extremum minimum(const Bernstein& polynomial, double tolerance);

}  // namespace swiftlet::control
