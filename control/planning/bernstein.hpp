// Polynomials by their Bernstein coefficients on one segment. A polynomial lies between the least and the
// greatest of them, so bounds hold everywhere and not at samples alone (Farouki, "The Bernstein polynomial
// basis: a centennial retrospective", 2012).
#pragma once

#include <array>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

constexpr int kMaxBernsteinDegree = 14;  // the square of a position of degree 7

// Over u = t / duration_s, 0 .. 1.
struct Bernstein {
  int degree = 0;
  std::array<double, kMaxBernsteinDegree + 1> c{};  // degree + 1 of them

  double greatest() const;
  double least() const;
};

// The derivative of this order, 0 .. 7, with respect to t in s. duration_s > 0.
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
  double value = 0.0;  // what the polynomial has there
  double at = 0.0;     // u
};

// The true maximum is at most `tolerance` above the value: branch and bound with de Casteljau's subdivision.
Extremum maximum(const Bernstein& polynomial, double tolerance);
// Likewise; at most `tolerance` below.
Extremum minimum(const Bernstein& polynomial, double tolerance);

}  // namespace swiftlet::control
