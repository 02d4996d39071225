#include "swiftlet/io/missions/sample_times.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {
namespace {

constexpr double kLeastStep_s = 1e-4;
constexpr double kLongestStep_s = 3600.0;
constexpr double kGap = 3.0;      // usual steps
constexpr double kJitter = 0.05;  // of the usual step
constexpr int kMaxListed = 3;

void require_rising(const Table& table, std::size_t column, double factor) {
  for (std::size_t row = 1; row < table.row_count(); ++row) {
    const double before = table.number(row - 1, column);
    const double now = table.number(row, column);
    if (now == before)
      table.fail(row, table.column(column),
                 "is " + io::exact(now) + " again, stamps must rise from row to row");
    table.number(row, column, io::between(before + kLeastStep_s / factor, before + kLongestStep_s / factor),
                 factor == 1.0 ? "s" : "");
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Greatest distance of a stamp from even ones between the first and the last.
double unevenness(const std::vector<double>& time_s) {
  const double step_s = time_s.back() / static_cast<double>(time_s.size() - 1);
  double greatest = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    greatest = std::max(greatest, std::abs(time_s[i] - step_s * static_cast<double>(i)));
  return greatest;
}

void make_even(std::vector<double>& time_s) {
  const double step_s = time_s.back() / static_cast<double>(time_s.size() - 1);
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = step_s * static_cast<double>(i);
}

void remark_on_steps(const Table& table, const std::vector<double>& steps_s, SampleTimes& times) {
  int gaps = 0;
  std::size_t shortest = 0;
  std::size_t longest = 0;  // that is no gap
  for (std::size_t i = 0; i < steps_s.size(); ++i) {
    if (steps_s[i] > kGap * times.step_s) {
      if (++gaps <= kMaxListed)
        times.remarks.push_back(
            fmt::format("line {}: no samples for {:.4g} s before it, the usual step is {:.4g} s; the path is "
                        "the smoothest between them",
                        table.line(i + 1), steps_s[i], times.step_s));
      continue;
    }
    if (steps_s[i] < steps_s[shortest]) shortest = i;
    if (steps_s[i] > steps_s[longest] || steps_s[longest] > kGap * times.step_s) longest = i;
  }
  if (gaps > kMaxListed) times.remarks.push_back(fmt::format("and {} more such gaps", gaps - kMaxListed));
  const double least = times.step_s * (1.0 - kJitter);
  const double most = times.step_s * (1.0 + kJitter);
  if (steps_s[shortest] < least || (steps_s[longest] > most && steps_s[longest] <= kGap * times.step_s)) {
    times.remarks.push_back(
        fmt::format("stamps are uneven: steps of {:.4g} s (line {}) to {:.4g} s (line {}), usually {:.4g} s",
                    steps_s[shortest], table.line(shortest + 1), steps_s[longest], table.line(longest + 1),
                    times.step_s));
  }
}

}  // namespace

std::string SampleTimes::rate() const {
  const double rate_hz = 1.0 / step_s;
  return fmt::format("{:.4g} Hz", rate_hz);
}

SampleTimes sample_times(const Table& table, std::size_t column, double factor) {
  require_rising(table, column, factor);
  SampleTimes times;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    times.time_s.push_back(factor * (table.number(row, column) - table.number(0, column)));
    times.rounding_s = std::max(times.rounding_s, 0.5 * factor * table.last_digit(row, column));
  }
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < times.time_s.size(); ++i)
    steps_s.push_back(times.time_s[i] - times.time_s[i - 1]);
  times.step_s = median(steps_s);
  const double uneven_s = unevenness(times.time_s);
  constexpr double kExact_s = 1e-9;
  const bool rounded = uneven_s <= 2.0 * times.rounding_s && times.rounding_s < 0.5 * times.step_s;
  if (uneven_s > kExact_s && !rounded) {
    remark_on_steps(table, steps_s, times);
    return times;
  }
  make_even(times.time_s);
  times.step_s = times.time_s[1];
  times.rounding_s = 0.0;
  if (uneven_s > kExact_s)
    times.remarks.push_back(
        fmt::format("stamps are rounded by up to {:.2g} s: even steps are used", uneven_s));
  return times;
}

}  // namespace swiftlet::io
