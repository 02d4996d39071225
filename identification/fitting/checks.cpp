#include "swiftlet/identification/fitting/checks.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/fitting/limits.hpp"

namespace swiftlet::identification {

namespace {

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::string with_unit(double value, const Column& column) {
  return *column.unit == '\0' ? format_number(value) : format_number(value) + " " + column.unit;
}

std::string out_of(const Column& column, const char* what, double value, double min, double max,
                   const std::string& because) {
  return std::string(column.name) + ": " + what + with_unit(value, column) + ", must be " +
         format_number(min) + " to " + format_number(max) + ": " + because + "; is the unit right?";
}

}  // namespace

void require_rows(const std::vector<Column>& columns, std::size_t least) {
  const std::size_t rows = columns.front().values.size();
  if (rows < least) {
    throw BadData("has " + std::to_string(rows) + (rows == 1 ? " row" : " rows") + ", must have at least " +
                  std::to_string(least));
  }
  for (const Column& column : columns) {
    if (column.values.size() != rows) {
      throw BadData(std::string(column.name) + ": has " + std::to_string(column.values.size()) +
                    " values, must have " + std::to_string(rows));
    }
    for (std::size_t i = 0; i < rows; ++i) {
      if (!std::isfinite(column.values[i]))
        throw BadData(std::string(column.name) + ": is not a finite number, must be", i);
    }
  }
}

void require_variety(const Column& column, std::size_t least) {
  std::vector<double> sorted = column.values;
  std::sort(sorted.begin(), sorted.end());
  const double apart = 1e-3 * (quantile(sorted, 0.95) - quantile(sorted, 0.05));
  std::size_t distinct = 1;
  double last = sorted.front();
  for (const double value : sorted) {
    if (apart > 0.0 && value - last > apart) {
      ++distinct;
      last = value;
    }
  }
  if (distinct >= least) return;
  const std::string rows = std::to_string(sorted.size());
  if (distinct == 1) {
    throw BadData(std::string(column.name) + ": is " + with_unit(sorted.front(), column) + " in all " + rows +
                  " rows, must vary");
  }
  throw BadData(std::string(column.name) + ": takes " + std::to_string(distinct) +
                " different values, must take at least " + std::to_string(least));
}

void require_each_between(const Column& column, double min, double max, const std::string& because) {
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    const double value = column.values[i];
    if (!(value >= min && value <= max)) throw BadData(out_of(column, "is ", value, min, max, because), i);
  }
}

void require_median_between(const Column& column, double min, double max, const std::string& because) {
  const double middle = median(column.values);
  if (!(middle >= min && middle <= max))
    throw BadData(out_of(column, "has the median ", middle, min, max, because));
}

void require_drive(const Column& supply, const Column& throttle) {
  require_each_between(throttle, 0.0, 1.0, "it is the throttle delta of Eq. (8)");
  require_median_between(supply, kLeastSupplyVoltage, kMostSupplyVoltage, "no vehicle flies on less or more");
}

void require_gyration(const char* column, const ParameterEstimate& inertia, double mass_kg,
                      double hub_distance_m) {
  const double gyration = std::sqrt(std::max(inertia.value, 0.0) / mass_kg) / hub_distance_m;
  if (gyration >= kLeastGyration && gyration <= kMostGyration) return;
  throw BadData(std::string(column) + ": leads to " + inertia.symbol + " = " + format_number(inertia.value) +
                " kg*m^2, a radius of gyration of " + format_number(gyration) +
                " times the hubs' distance from the centre, must be " + format_number(kLeastGyration) +
                " to " + format_number(kMostGyration) + "; are the units right?");
}

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::sort(values.begin(), values.end());
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Comparison compared(const std::vector<double>& first, const std::vector<double>& second) {
  const auto count = static_cast<Eigen::Index>(first.size());
  Eigen::ArrayXd a = Eigen::Map<const Eigen::ArrayXd>(first.data(), count);
  Eigen::ArrayXd b = Eigen::Map<const Eigen::ArrayXd>(second.data(), count);
  a -= a.mean();
  b -= b.mean();
  constexpr double kNone = 1e-300;
  const double product = (a * b).sum();
  const double square_a = a.square().sum();
  const double square_b = b.square().sum();
  return {product / std::max(std::sqrt(square_a * square_b), kNone), product / std::max(square_b, kNone),
          std::sqrt(std::max(square_a, square_b) / static_cast<double>(count))};
}

double full_scale(const std::vector<double>& values) {
  std::vector<double> magnitudes = values;
  for (double& value : magnitudes) value = std::abs(value);
  const double most = quantile(magnitudes, 0.9);
  return most > 0.0 ? most : 1.0;
}

}  // namespace swiftlet::identification
