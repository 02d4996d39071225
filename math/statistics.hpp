// Percentiles and correlations. Values that are not finite are ignored.
#pragma once

#include <cstddef>
#include <vector>

namespace swiftlet::math {

// Distribution of a set of numbers. All fields except count are NaN for an empty set.
struct Spread {
  std::size_t count = 0;
  double min = 0.0;
  double p5 = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

// Percentiles are interpolated linearly between the sorted numbers: the q-quantile is at index q (n - 1).
Spread spread(std::vector<double> numbers);

// Pearson's correlation of as many x as y, -1 .. 1. NaN if one of them does not vary or is not finite.
double correlation(const std::vector<double>& x, const std::vector<double>& y);

// Spearman's rank correlation, -1 .. 1. Equal numbers share their mean rank. NaN for fewer than three pairs
// or if all values of x or of y are equal. x and y have the same length.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// Bound on the absolute rank correlation that 95 % of samples of independent numbers stay within, for this
// number of pairs.
double chance_correlation(std::size_t pairs);

}  // namespace swiftlet::math
