// Refines an approximate zero of a scalar function.
#pragma once

#include <cmath>

namespace swiftlet::math {

// Returns the zero of f near x0 by the secant method, at most 20 steps. It stops at a step of 0.1 or more and
// returns the value before that step.
template <class Function>
double refine_zero(const Function& f, double x0) {
  double f0 = f(x0);
  double x1 = x0 + 1e-6;
  for (int i = 0; i < 20; ++i) {
    const double f1 = f(x1);
    if (f1 == f0 || !std::isfinite(f1)) break;
    const double x2 = x1 - f1 * (x1 - x0) / (f1 - f0);
    if (!(std::abs(x2 - x1) < 0.1)) break;
    x0 = x1;
    f0 = f1;
    x1 = x2;
    if (std::abs(x1 - x0) < 1e-14) break;
  }
  return x1;
}

}  // namespace swiftlet::math
