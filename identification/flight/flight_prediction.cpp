#include "swiftlet/identification/flight/flight_prediction.hpp"

#include <cmath>

namespace swiftlet::identification {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// Accumulates root mean squares along three axes.
struct VectorSquares {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;

  void add(const Vector3d& error) {
    sum += error.cwiseAbs2();
    count += 1.0;
  }
  double rms(int axis) const { return count > 0.0 ? std::sqrt(sum[axis] / count) : 0.0; }
};

// Predicts the body rates from the measured ones of a row, by the commands of the following rows.
class RatePredictor {
 public:
  RatePredictor(const FlightModel& model, const VectorXd& parameters, std::size_t flight, Part part)
      : log_(*model.flights()[flight].log),
        rows_(part == Part::kValidationSet ? model.flights()[flight].validation_set
                                           : model.flights()[flight].estimation_set),
        drive_(model.drive_by_commands(parameters, flight, rows_)),
        inertia_(model.inertia(parameters)) {}

  const Rows& rows() const { return rows_; }
  const FlightModel::Drive& drive() const { return drive_; }

  // Rates at the row after `row`, by the trapezoidal rule.
  Vector3d next(std::size_t row, const Vector3d& rates) const {
    const double h = log_.time_s[row + 1] - log_.time_s[row];
    const Vector3d slope = derivative(row, rates);
    return rates + 0.5 * h * (slope + derivative(row + 1, rates + h * slope));
  }

 private:
  Vector3d derivative(std::size_t row, const Vector3d& rates) const {
    return FlightModel::rate_derivative(inertia_, drive_.acceleration[row - rows_.first], rates);
  }

  const FlightLog& log_;
  Rows rows_;
  FlightModel::Drive drive_;
  Vector3d inertia_;
};

}  // namespace

std::vector<PredictionError> prediction_errors(const FlightModel& model, const VectorXd& parameters,
                                               Part part) {
  VectorSquares one_step;
  VectorSquares persistence_one_step;
  VectorSquares ahead;
  VectorSquares persistence_ahead;
  VectorSquares force;
  VectorSquares persistence_force;
  for (std::size_t f = 0; f < model.flights().size(); ++f) {
    const FlightLog& log = *model.flights()[f].log;
    const RatePredictor predictor(model, parameters, f, part);
    const Rows rows = predictor.rows();
    Vector3d mean = Vector3d::Zero();
    for (std::size_t row = rows.first; row < rows.last; ++row)
      mean += log.specific_force_frd[row] / static_cast<double>(rows.size());
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      force.add(log.specific_force_frd[row] - predictor.drive().specific_force[row - rows.first] -
                model.offset(parameters, f));
      persistence_force.add(log.specific_force_frd[row] - mean);
      if (row + 1 == rows.last) break;
      one_step.add(log.body_rates_frd[row + 1] - predictor.next(row, log.body_rates_frd[row]));
      persistence_one_step.add(log.body_rates_frd[row + 1] - log.body_rates_frd[row]);
    }
    // Predictions start every tenth of the horizon.
    double next_start_s = log.time_s[rows.first];
    for (std::size_t start = rows.first; start < rows.last; ++start) {
      if (log.time_s[start] < next_start_s) continue;
      next_start_s = log.time_s[start] + 0.1 * kAheadS;
      Vector3d rates = log.body_rates_frd[start];
      for (std::size_t row = start; row + 1 < rows.last; ++row) {
        rates = predictor.next(row, rates);
        if (log.time_s[row + 1] - log.time_s[start] < kAheadS) continue;
        ahead.add(log.body_rates_frd[row + 1] - rates);
        persistence_ahead.add(log.body_rates_frd[row + 1] - log.body_rates_frd[start]);
        break;
      }
    }
  }
  std::vector<PredictionError> out;
  const char* const rates[] = {"p", "q", "r"};
  out.reserve(4);
  for (int axis = 0; axis < 3; ++axis) {
    out.push_back({rates[axis], "rad/s", one_step.rms(axis), persistence_one_step.rms(axis), ahead.rms(axis),
                   persistence_ahead.rms(axis)});
  }
  out.push_back(
      {"f_z", "m/s^2", force.rms(2), persistence_force.rms(2), force.rms(2), persistence_force.rms(2)});
  return out;
}

PredictionTrace prediction_trace(const FlightModel& model, const VectorXd& parameters) {
  const FlightLog& log = *model.flights().front().log;
  const RatePredictor predictor(model, parameters, 0, Part::kValidationSet);
  const Rows rows = predictor.rows();
  PredictionTrace out;
  Vector3d rates = log.body_rates_frd[rows.first];
  std::size_t start = rows.first;
  for (std::size_t row = rows.first; row + 1 < rows.last; ++row) {
    if (log.time_s[row] - log.time_s[start] >= kAheadS) {
      start = row;
      rates = log.body_rates_frd[row];
    }
    out.time_s.push_back(log.time_s[row] - log.time_s[rows.first]);
    const std::size_t i = row - rows.first;
    for (int axis = 0; axis < 3; ++axis) {
      out.measured[axis].push_back(log.body_rates_frd[row][axis]);
      out.predicted[axis].push_back(rates[axis]);
    }
    out.measured[3].push_back(log.specific_force_frd[row].z());
    out.predicted[3].push_back(predictor.drive().specific_force[i].z() + model.offset(parameters, 0).z());
    rates = predictor.next(row, rates);
  }
  return out;
}

}  // namespace swiftlet::identification
