// How numbers are spread, and how they go together. What is not finite is left out.
#pragma once

#include <cstddef>
#include <vector>

namespace swiftlet::ground {

// NaN where there are no numbers.
struct Spread {
  std::size_t count = 0;
  double min = 0.0;
  double p5 = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

// Percentiles are linear between the sorted numbers: the q-quantile stands at place q (n - 1).
Spread spread(std::vector<double> numbers);

// Spearman's rank correlation, -1 .. 1: that of the ranks, equal numbers sharing their mean rank. NaN with
// fewer than three pairs, or if either side has but one value. x and y are of one length.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

// Of independent numbers, 95 % of rank correlations of so many pairs lie within plus and minus this.
double chance_correlation(std::size_t pairs);

}  // namespace swiftlet::ground
