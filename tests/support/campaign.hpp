// Sample counts of statistical tests: few in the ordinary run, many in `./dev soak identification` and `./dev
// soak flights`. The bounds follow from the count.
#pragma once

#include <cmath>
#include <cstdlib>

namespace swiftlet::tests {

inline bool is_soak() { return std::getenv("SWIFTLET_SOAK") != nullptr; }

inline int draws(int few, int many) { return is_soak() ? many : few; }

// Bound of the mean of `count` independent errors, where one error has the bound `bound`.
inline double bound_of_mean(double bound, int count) { return bound / std::sqrt(count); }

// Standard error of the share of `count` 95 % intervals that cover the truth.
inline double coverage_error(int count) { return std::sqrt(0.95 * 0.05 / count); }

// Minimum number of `count` 95 % intervals that must cover the truth: by the binomial distribution, 1 soak in
// 100 has fewer. Outside a soak, with few fixed seeds, all must.
inline int least_covered(int count) {
  if (!is_soak()) return count;
  int least = 0;
  double fewer = 0.0;
  double exactly = std::pow(0.05, count);  // probability of `least`
  while (fewer + exactly < 0.01) {
    fewer += exactly;
    exactly *= 0.95 / 0.05 * (count - least) / (least + 1);
    ++least;
  }
  return least;
}

}  // namespace swiftlet::tests
