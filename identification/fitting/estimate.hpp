// Results of an experiment.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/least_squares.hpp"

namespace swiftlet::identification {

// An estimated parameter. Its 95 % interval is value -+ half_width.
struct ParameterEstimate {
  std::string parameter;  // its key if the vehicle file has one: "motor.k2", "inertia.xx"
  std::string symbol;     // as in the paper: "K2"
  std::string unit;
  double value = 0.0;
  double standard_error = 0.0;
  double half_width = 0.0;
  bool identifiable = true;  // false: the data do not determine it, and its numbers say nothing

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

// Result of one experiment. Rows are counted from 0 in the order of the data.
struct Experiment {
  std::vector<ParameterEstimate> estimates;
  Eigen::MatrixXd covariance;  // of the estimates, in their order
  double r_squared = 0.0;      // of the measured quantity, without outliers
  double residual_sd = 0.0;    // standard deviation of its residuals, without outliers, in residual_unit
  std::string residual_unit;
  std::vector<double> predicted;      // the quantity by the model, one value per row
  std::vector<double> measured;       // the quantity as measured, one value per row
  std::vector<std::size_t> outliers;  // rows, ascending
  std::vector<std::string> findings;  // further results, as sentences
  std::vector<std::string> warnings;  // what is not identifiable or contradicts the model, as sentences

  bool is_outlier(std::size_t row) const;
  // Throws std::out_of_range if the parameter was not estimated.
  const ParameterEstimate& estimate(const std::string& parameter) const;
};

// Error for data from which nothing can be identified. what() is a sentence with value and limit: "speed: is
// 1500 rad/s in all 40 rows, must vary".
class BadData : public std::runtime_error {
 public:
  explicit BadData(const std::string& message, std::optional<std::size_t> row = std::nullopt)
      : std::runtime_error(message), row_(row) {}
  std::optional<std::size_t> row() const { return row_; }  // the faulty row, if it is a single one

 private:
  std::optional<std::size_t> row_;
};

// Names of one parameter of a fit.
struct ParameterName {
  const char* parameter;
  const char* symbol;
  const char* unit;
};

// Builds the experiment from a fit: estimates, outliers, R^2 and the warnings that apply to any fit. names:
// in the order of the fit's parameters. measured, predicted, residual_unit: as in Experiment.
Experiment conclude(const Fit& fit, const std::vector<ParameterName>& names, std::vector<double> measured,
                    std::vector<double> predicted, const std::string& residual_unit);

// Formats a number for a message, with four significant digits.
std::string format_number(double number);

}  // namespace swiftlet::identification
