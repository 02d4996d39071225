#include "swiftlet/identification/flight/command_prediction.hpp"

#include <array>
#include <cmath>

#include "swiftlet/identification/flight/flight_prediction.hpp"
#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::VectorXd;

constexpr double kBetweenStartsS = 0.05;
constexpr double kTraceRestartS = 0.1;
constexpr std::array<double, 5> kHorizonsS = {0.02, 0.05, 0.1, 0.2, kAheadS};
constexpr std::array<Response, kResponses> kQuantityOrder = {Response::kRoll, Response::kPitch,
                                                             Response::kYaw, Response::kForce};
const char* const kQuantities[kResponses] = {"p", "q", "r", "f_z"};

// Forecasts one response of one flight.
class Forecast {
 public:
  Forecast(const CommandModel& model, const VectorXd& x, std::size_t flight, Response response)
      : measured_(model.blocks()[flight].means[static_cast<std::size_t>(response)]),
        modelled_(model.modelled(x, flight, response)),
        noise_(model.noise(x, response)),
        unexplained_(model.unexplained(x, flight, response)),
        innovations_(innovations(noise_, unexplained_)),
        is_rate_(response != Response::kForce) {}

  const std::vector<double>& measured() const { return measured_; }
  // Error of the prediction of a block from all blocks before it.
  double one_step_error(std::size_t block) const { return innovations_[block]; }

  // Predicts the `ahead` blocks after `block` from its measured value, the commands and the expected noise.
  std::vector<double> after(std::size_t block, std::size_t ahead) const {
    std::vector<double> out = expected_noise(noise_, unexplained_, innovations_, block + 1, ahead);
    double sum = measured_[block];
    for (std::size_t i = 0; i < ahead; ++i) {
      out[i] += modelled_[block + 1 + i];
      if (is_rate_) out[i] = sum += out[i];
    }
    return out;
  }

 private:
  const std::vector<double>& measured_;
  std::vector<double> modelled_;
  ArmaNoise noise_;
  std::vector<double> unexplained_;
  std::vector<double> innovations_;
  bool is_rate_;
};

// Accumulates a root mean square.
struct Squares {
  double sum = 0.0;
  double count = 0.0;

  void add(double error) {
    sum += error * error;
    count += 1.0;
  }
  double rms() const { return count > 0.0 ? std::sqrt(sum / count) : 0.0; }
};

// One prediction over a horizon.
struct Start {
  double now = 0.0;          // measured at the start
  double by_commands = 0.0;  // predicted at the horizon
  double then = 0.0;         // measured at the horizon
};

// Predictions from every `between`-th block of first up to last, `ahead` blocks ahead.
std::vector<Start> starts(const Forecast& forecast, std::size_t first, std::size_t last, std::size_t ahead,
                          std::size_t between) {
  std::vector<Start> out;
  for (std::size_t block = first; block + ahead < last; block += between) {
    out.push_back({forecast.measured()[block], forecast.after(block, ahead).back(),
                   forecast.measured()[block + ahead]});
  }
  return out;
}

std::size_t blocks_of(double time_s, double sample_s) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(time_s / sample_s)));
}

// Least-squares weights c of then = c0 + c1 (by_commands - now) + c2 now.
Eigen::Vector3d best_weights(const std::vector<Start>& starts) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> rows(static_cast<Eigen::Index>(starts.size()), 3);
  VectorXd then(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Start& start = starts[static_cast<std::size_t>(i)];
    rows.row(i) << 1.0, start.by_commands - start.now, start.now;
    then[i] = start.then;
  }
  return math::least_squares(rows, then);
}

double combined(const Eigen::Vector3d& weights, const Start& start) {
  return weights[0] + weights[1] * (start.by_commands - start.now) + weights[2] * start.now;
}

// The errors of predictions from one block to the next.
struct OneStepErrors {
  Squares fitted;       // on the estimation set
  Squares by_commands;  // on the validation set
  Squares persistence;
};

OneStepErrors one_step_errors(const CommandModel& model, const std::vector<Forecast>& forecasts) {
  OneStepErrors out;
  const std::size_t between = blocks_of(kBetweenStartsS, model.sample_s());
  for (std::size_t flight = 0; flight < forecasts.size(); ++flight) {
    const std::vector<double>& measured = forecasts[flight].measured();
    for (std::size_t block = between; block < model.blocks()[flight].estimation_set; ++block)
      out.fitted.add(forecasts[flight].one_step_error(block));
    for (std::size_t block = model.blocks()[flight].estimation_set; block < measured.size(); ++block) {
      out.by_commands.add(forecasts[flight].one_step_error(block));
      out.persistence.add(measured[block] - measured[block - 1]);
    }
  }
  return out;
}

// Predictions over one horizon, of all flights.
struct HorizonStarts {
  std::vector<Start> estimation_set;
  std::vector<Start> validation_set;
};

HorizonStarts horizon_starts(const CommandModel& model, const std::vector<Forecast>& forecasts,
                             double horizon_s) {
  const std::size_t ahead = blocks_of(horizon_s, model.sample_s());
  const std::size_t between = blocks_of(kBetweenStartsS, model.sample_s());
  HorizonStarts out;
  for (std::size_t flight = 0; flight < forecasts.size(); ++flight) {
    const BlockedFlight& blocks = model.blocks()[flight];
    const std::vector<Start> before =
        starts(forecasts[flight], between, blocks.estimation_set, ahead, between);
    const std::vector<Start> after =
        starts(forecasts[flight], blocks.estimation_set, blocks.size(), ahead, between);
    out.estimation_set.insert(out.estimation_set.end(), before.begin(), before.end());
    out.validation_set.insert(out.validation_set.end(), after.begin(), after.end());
  }
  return out;
}

void predict(const CommandModel& model, const VectorXd& x, std::size_t quantity, CommandPredictions& out) {
  const Response response = kQuantityOrder[quantity];
  std::vector<Forecast> forecasts;
  for (std::size_t flight = 0; flight < model.flights().size(); ++flight)
    forecasts.emplace_back(model, x, flight, response);

  PredictionError error;
  error.quantity = kQuantities[quantity];
  error.unit = response == Response::kForce ? "m/s^2" : "rad/s";
  const OneStepErrors one_step = one_step_errors(model, forecasts);
  error.one_step = one_step.by_commands.rms();
  error.persistence_one_step = one_step.persistence.rms();

  for (const double horizon_s : kHorizonsS) {
    const HorizonStarts starts = horizon_starts(model, forecasts, horizon_s);
    if (horizon_s == kAheadS && response != Response::kForce) {
      Squares change;
      for (const Start& start : starts.estimation_set) change.add(start.then - start.now);
      out.excitations[quantity] = {error.quantity, change.rms(), one_step.fitted.rms()};
    }
    const Eigen::Vector3d weights = best_weights(starts.estimation_set);
    Squares by_commands;
    Squares persistence;
    Squares best;
    for (const Start& start : starts.validation_set) {
      by_commands.add(start.then - start.by_commands);
      persistence.add(start.then - start.now);
      best.add(start.then - combined(weights, start));
    }
    out.horizons.push_back({error.quantity, error.unit, horizon_s, by_commands.rms(), persistence.rms()});
    if (horizon_s != kAheadS) continue;
    error.half_second = best.rms();
    error.persistence_half_second = persistence.rms();
    out.weight_of_commands.push_back(weights[1]);
    out.weight_of_start.push_back(weights[2]);
  }
  out.errors.push_back(error);
}

void trace(const CommandModel& model, const VectorXd& x, std::size_t quantity, PredictionTrace& out) {
  const Response response = kQuantityOrder[quantity];
  const double sign = response == Response::kForce ? -1.0 : 1.0;  // f_z is opposite to the thrust
  const Forecast forecast(model, x, 0, response);
  const BlockedFlight& blocks = model.blocks().front();
  const std::size_t restart = blocks_of(kTraceRestartS, model.sample_s());
  for (std::size_t start = blocks.estimation_set; start + restart < blocks.size(); start += restart) {
    const std::vector<double> after = forecast.after(start - 1, restart);
    for (std::size_t i = 0; i < restart; ++i) {
      if (quantity == 0)
        out.time_s.push_back(blocks.time_s[start + i] - blocks.time_s[blocks.estimation_set]);
      out.measured[quantity].push_back(sign * forecast.measured()[start + i]);
      out.predicted[quantity].push_back(sign * after[i]);
    }
  }
}

}  // namespace

CommandPredictions command_predictions(const CommandModel& model, const VectorXd& parameters) {
  CommandPredictions out;
  out.trace.restart_s = kTraceRestartS;
  for (std::size_t quantity = 0; quantity < kResponses; ++quantity) {
    predict(model, parameters, quantity, out);
    trace(model, parameters, quantity, out.trace);
  }
  return out;
}

}  // namespace swiftlet::identification
