// How much a test draws: a little beside all other tests, much in `./dev soak identification` and `./dev soak flights`.
// One piece of code serves both, with bounds that follow from how much was drawn.
#pragma once

#include <cmath>
#include <cstdlib>

namespace swiftlet::tests {

inline bool is_soak() { return std::getenv("SWIFTLET_SOAK") != nullptr; }

inline int draws(int few, int many) { return is_soak() ? many : few; }

// By how much the mean of `count` independent errors may be off, where that of one may by `bound`.
inline double bound_of_mean(double bound, int count) { return bound / std::sqrt(count); }

// The standard error of the share of `count` 95 % intervals that hold the truth.
inline double coverage_error(int count) { return std::sqrt(0.95 * 0.05 / count); }

// How many of `count` 95 % intervals must hold the truth. Fewer do in one campaign of a hundred, by the binomial
// distribution. In the tests, whose seeds are few and always the same, all must.
inline int least_covered(int count) {
  if (!is_soak()) return count;
  int least = 0;
  double fewer = 0.0;
  double exactly = std::pow(0.05, count);  // as many as `least`
  while (fewer + exactly < 0.01) {
    fewer += exactly;
    exactly *= 0.95 / 0.05 * (count - least) / (least + 1);
    ++least;
  }
  return least;
}

}  // namespace swiftlet::tests
