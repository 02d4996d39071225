// What an experiment gives.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/least_squares.hpp"

namespace swiftlet::identification {

// A parameter as found. The 95 % interval is value -+ half_width.
struct ParameterEstimate {
  std::string parameter;  // as in the vehicle file where it stands there: "motor.k2", "inertia.xx"
  std::string symbol;     // as in the paper: "K2"
  std::string unit;
  double value = 0.0;
  double standard_error = 0.0;
  double half_width = 0.0;

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

// One experiment, identified. Rows are counted from 0, as given.
struct Experiment {
  std::vector<ParameterEstimate> estimates;
  Eigen::MatrixXd covariance;  // of the estimates, in their order
  double r_squared = 0.0;      // of the reading that the model explains, outliers left out
  double residual_sd = 0.0;    // of that reading, in residual_unit
  std::string residual_unit;
  std::vector<double> predicted;  // that reading by the model, a value for each row
  std::vector<double> measured;
  std::vector<std::size_t> outliers;
  std::vector<std::string> findings;  // what else the data say; sentences
  std::vector<std::string> warnings;  // what the data cannot tell or do not agree with; sentences

  bool is_outlier(std::size_t row) const;
  // Throws std::out_of_range if it was not estimated.
  const ParameterEstimate& estimate(const std::string& parameter) const;
};

// Data from which nothing can be identified. what() is a sentence with value and limit, "speed: is 1500 rad/s
// in all 40 rows, must vary".
class BadData : public std::runtime_error {
 public:
  explicit BadData(const std::string& message, std::optional<std::size_t> row = std::nullopt)
      : std::runtime_error(message), row_(row) {}
  std::optional<std::size_t> row() const { return row_; }  // the row at fault, if it is one

 private:
  std::optional<std::size_t> row_;
};

// Names of a fit's parameters, in its order.
struct ParameterName {
  const char* parameter;
  const char* symbol;
  const char* unit;
};

// The experiment that a fit makes: estimates, outliers, R^2 and the warnings that hold for any fit. measured
// and predicted are those of Experiment.
Experiment conclude(const Fit& fit, const std::vector<ParameterName>& names, std::vector<double> measured,
                    std::vector<double> predicted, const std::string& residual_unit);

// A number for a sentence: four significant digits.
std::string format_number(double number);

}  // namespace swiftlet::identification
