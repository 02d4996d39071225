#include "swiftlet/math/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace swiftlet::math {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double quantile(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (place - static_cast<double>(below));
}

std::vector<double> ranks(const std::vector<double>& numbers) {
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  std::vector<double> out(numbers.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && numbers[order[end]] == numbers[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) out[order[i]] = 0.5 * static_cast<double>(first + end - 1);
    first = end;
  }
  return out;
}

}  // namespace

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double count = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : kNaN;
}

Spread spread(std::vector<double> numbers) {
  numbers.erase(
      std::remove_if(numbers.begin(), numbers.end(), [](double number) { return !std::isfinite(number); }),
      numbers.end());
  if (numbers.empty()) return {0, kNaN, kNaN, kNaN, kNaN, kNaN};
  std::sort(numbers.begin(), numbers.end());
  return {numbers.size(),         numbers.front(),         quantile(numbers, 0.05),
          quantile(numbers, 0.5), quantile(numbers, 0.95), numbers.back()};
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> finite_x;
  std::vector<double> finite_y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    finite_x.push_back(x[i]);
    finite_y.push_back(y[i]);
  }
  return finite_x.size() < 3 ? kNaN : correlation(ranks(finite_x), ranks(finite_y));
}

double chance_correlation(std::size_t pairs) {
  return pairs < 3 ? 1.0 : std::min(1.0, 1.96 / std::sqrt(static_cast<double>(pairs - 1)));
}

}  // namespace swiftlet::math
