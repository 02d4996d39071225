// The zero of a function beside a start that is nearly right.
#pragma once

#include <cmath>

namespace swiftlet::control {

// By secant steps; x0 itself where they lead away from it.
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

}  // namespace swiftlet::control
