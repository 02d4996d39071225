#include "swiftlet/identification/flight/command_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/identification/flight/flight_model.hpp"
#include "swiftlet/identification/flight/supply_sag.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kSettlingS = 0.3;     // s, of the noise filters, whose initial state is unknown
constexpr double kLeastThrust = 1e-3;  // m/s^2, lower limit of one rotor's thrust over mass
constexpr double kMostReflection = 0.9995;
// Noise slower than about half a second is left to the thrust curve and its drift.
constexpr double kMostForceReflection = 0.99;

const char* const kNames[kResponses] = {"specific force", "roll", "pitch", "yaw"};

std::size_t index_of(Response response) { return static_cast<std::size_t>(response); }
int axis_of(Response response) { return static_cast<int>(response) - 1; }

// Rows of estimation set and validation set.
Rows rows_of(const FlightSeries& series) { return {series.estimation_set.first, series.validation_set.last}; }

std::size_t rows_in_block(const FlightSeries& series) {
  const std::vector<double>& time = series.log->time_s;
  const double step = (time[series.estimation_set.last - 1] - time[series.estimation_set.first]) /
                      static_cast<double>(series.estimation_set.size());
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kSampleS / step)));
}

// Means of value(row) over each block. Row 0 is the first row of the first block.
template <typename Value>
std::vector<double> block_means(const BlockedFlight& blocks, const Value& value) {
  std::vector<double> out(blocks.size(), 0.0);
  const double share = 1.0 / static_cast<double>(blocks.rows_in_block);
  for (std::size_t block = 0; block < out.size(); ++block) {
    for (std::size_t row = 0; row < blocks.rows_in_block; ++row)
      out[block] += share * value(block * blocks.rows_in_block + row);
  }
  return out;
}

void to_differences(std::vector<double>& means) {
  for (std::size_t block = means.size(); block-- > 1;) means[block] -= means[block - 1];
  if (!means.empty()) means[0] = 0.0;
}

// Integrates value(row) by the trapezoidal rule. Returns the change of the integral's mean from block to
// block.
template <typename Value>
std::vector<double> block_gains(const BlockedFlight& blocks, const double* time_s, const Value& value) {
  std::vector<double> integral(blocks.size() * blocks.rows_in_block, 0.0);
  for (std::size_t row = 1; row < integral.size(); ++row)
    integral[row] = integral[row - 1] + 0.5 * (time_s[row] - time_s[row - 1]) * (value(row) + value(row - 1));
  std::vector<double> out = block_means(blocks, [&](std::size_t row) { return integral[row]; });
  to_differences(out);
  return out;
}

double mean_command(const std::vector<FlightSeries>& flights) {
  double sum = 0.0;
  double count = 0.0;
  for (const FlightSeries& flight : flights) {
    for (std::size_t row = flight.estimation_set.first; row < flight.estimation_set.last; ++row) {
      for (int i = 0; i < flight.log->rotor_count; ++i)
        sum += flight.log->command[row][static_cast<std::size_t>(i)];
      count += flight.log->rotor_count;
    }
  }
  return sum / count;
}

}  // namespace

const char* response_name(Response response) { return kNames[index_of(response)]; }

CommandModel::CommandModel(std::vector<FlightSeries> flights, plant::Vehicle base,
                           std::vector<Response> responses, std::optional<KnownThrust> known)
    : flights_(std::move(flights)),
      base_(std::move(base)),
      responses_(std::move(responses)),
      known_(std::move(known)),
      middle_command_(known_ ? known_->curve.middle : mean_command(flights_)),
      shared_over_single_(identification::shared_over_single(base_)),
      steady_speeds_(kCachedPerFlight * flights_.size()),
      thrust_(kCachedPerFlight * flights_.size()),
      moments_(kCachedPerFlight * flights_.size()) {
  const plant::Effectiveness effectiveness = plant::effectiveness(base_);
  signs_.resize(3, effectiveness.cols());
  for (int axis = 0; axis < 3; ++axis) {
    const auto row = effectiveness.row(1 + axis);
    lever_[static_cast<std::size_t>(axis)] = row.cwiseAbs().mean();
    signs_.row(axis) = row / row.cwiseAbs().mean();
  }
  for (const FlightSeries& flight : flights_) blocks_.push_back(blocked(flight));
  assign_parameter_indices();
}

bool CommandModel::has(Response response) const {
  return std::find(responses_.begin(), responses_.end(), response) != responses_.end();
}

void CommandModel::add_noise(Response response) {
  const char* const parts[] = {"numerator 1", "numerator 2", "denominator 1", "denominator 2"};
  const double starts[] = {0.0, 0.0, -0.5, 0.0};
  const double most = response == Response::kForce ? kMostForceReflection : kMostReflection;
  for (std::size_t i = 0; i < kNoiseParameters; ++i) {
    const int at = add({std::string("noise of ") + response_name(response) + ", " + parts[i], "1", starts[i],
                        0.1, -most, most},
                       layout_.parameters);
    if (i == 0) layout_.noise[index_of(response)] = at;
  }
}

void CommandModel::assign_parameter_indices() {
  CommandLayout& l = layout_;
  const auto add = [&l](FlightParameter parameter) {
    return identification::add(std::move(parameter), l.parameters);
  };
  l.lag = add({"rotor lag", "s", base_.motor.time_constant_s, 0.01, 2e-3, 1.0});
  if (has(Response::kForce)) {
    l.force_delay = add({"delay from command to specific force", "s", 0.01, 2e-3, -0.02, 0.1});
    l.curve = add({"thrust over mass", "m/s^2", plant::kGravity, 1.0, 0.1, 100.0});
    add({"slope of thrust over mass", "m/s^2", plant::kGravity / middle_command_, 3.0, 0.0, 1000.0});
    add({"curvature of thrust over mass", "m/s^2", 0.0, 3.0, -1000.0, 1000.0});
    for (const FlightSeries& flight : flights_)
      l.drift.push_back(add({"drift of the thrust, " + flight.log->name, "1/s", 0.0, 1e-3, -0.1, 0.1}));
  }
  if (std::any_of(responses_.begin(), responses_.end(), [](Response r) { return r != Response::kForce; }))
    l.rate_delay = add({"delay from command to angular acceleration", "s", 0.01, 2e-3, -0.02, 0.1});
  for (const Response response : responses_) {
    if (response == Response::kForce) continue;
    const int axis = axis_of(response);
    const std::string name = response_name(response);
    const double by_base = base_.mass_kg * lever(axis) / base_.inertia(axis, axis);
    l.gain[axis] =
        add({"gain about " + name, "1/m", by_base, 0.1 * by_base, -100.0 * by_base, 100.0 * by_base});
    l.trim[axis] =
        add({"offset of the centre of thrust, " + name, "1/m", 0.0, 0.02 * by_base, -by_base, by_base});
    if (response == Response::kYaw)
      l.spin_up =
          add({"spin-up about yaw", "(s^2/m)^(1/2)/s", 0.0, 0.03 * by_base, -10.0 * by_base, 10.0 * by_base});
  }
  for (const Response response : responses_) add_noise(response);
}

BlockedFlight CommandModel::blocked(const FlightSeries& series) const {
  const FlightLog& log = *series.log;
  const Rows rows = rows_of(series);
  BlockedFlight out;
  out.rows_in_block = rows_in_block(series);
  out.estimation_set = series.estimation_set.size() / out.rows_in_block;
  out.time_s.resize(rows.size() / out.rows_in_block);
  out.time_s = block_means(out, [&](std::size_t row) { return log.time_s[rows.first + row]; });
  out.means[0] =
      block_means(out, [&](std::size_t row) { return -log.specific_force_frd[rows.first + row].z(); });
  const Vector3d inertia = base_.inertia.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    out.means[i + 1] =
        block_means(out, [&](std::size_t row) { return log.body_rates_frd[rows.first + row][axis]; });
    out.coupling[i] = block_gains(out, log.time_s.data() + rows.first, [&](std::size_t row) {
      return FlightModel::rate_derivative(inertia, Vector3d::Zero(),
                                          log.body_rates_frd[rows.first + row])[axis];
    });
  }
  return out;
}

std::vector<FlightParameter> CommandModel::physical_parameters() const {
  const auto noise = static_cast<std::ptrdiff_t>(kNoiseParameters * responses_.size());
  return {layout_.parameters.begin(), layout_.parameters.end() - noise};
}

double CommandModel::sample_s() const {
  const std::vector<double>& time = blocks_.front().time_s;
  return (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

ThrustCurve CommandModel::curve(const VectorXd& x) const {
  if (layout_.curve == kAbsent) return known_->curve;
  return {middle_command_, x[layout_.curve], x[layout_.curve + 1], x[layout_.curve + 2]};
}

ThrustDrift CommandModel::drift(const VectorXd& x, std::size_t flight) const {
  if (layout_.drift.empty()) return known_->drift[flight];
  const Rows rows = rows_of(flights_[flight]);
  return {x[layout_.drift[flight]], flights_[flight].log->time_s[rows.first + rows.size() / 2]};
}

ArmaNoise CommandModel::noise(const VectorXd& x, Response response) const {
  return arma_noise(x.data() + layout_.noise[index_of(response)]);
}

CommandModel::SteadyKey CommandModel::steady_key(const VectorXd& x, std::size_t flight) const {
  const ThrustCurve c = curve(x);
  const ThrustDrift d = drift(x, flight);
  return {static_cast<double>(flight), c.value, c.slope, c.curvature, d.per_s, d.middle_s};
}

CommandModel::RotorsKey CommandModel::rotors_key(const VectorXd& x, std::size_t flight,
                                                 double delay_s) const {
  const auto [index, value, slope, curvature, per_s, middle_s] = steady_key(x, flight);
  return {index, value, slope, curvature, per_s, middle_s, x[layout_.lag], delay_s};
}

std::shared_ptr<const CommandModel::Speeds> CommandModel::steady_speeds(const VectorXd& x,
                                                                        std::size_t flight) const {
  return steady_speeds_.of(steady_key(x, flight), [&] {
    const FlightLog& log = *flights_[flight].log;
    const Rows rows = rows_of(flights_[flight]);
    const ThrustCurve thrust_curve = curve(x);
    const ThrustDrift thrust_drift = drift(x, flight);
    const auto count = static_cast<std::size_t>(log.rotor_count);
    const double share = 1.0 / static_cast<double>(count);
    Speeds steady(rows.last, plant::PerRotor{});
    for (std::size_t row = 0; row < rows.last; ++row) {
      const double drifted = 1.0 + thrust_drift.per_s * (log.time_s[row] - thrust_drift.middle_s);
      double mean = 0.0;
      for (std::size_t i = 0; i < count; ++i) mean += share * log.command[row][i];
      const double shared = thrust_curve.at(mean);
      for (std::size_t i = 0; i < count; ++i) {
        const double own = (thrust_curve.at(log.command[row][i]) - shared) / shared_over_single_;
        steady[row][i] = std::sqrt(std::max(share * drifted * (shared + own), kLeastThrust));
      }
    }
    return steady;
  });
}

CommandModel::Speeds CommandModel::speeds(const VectorXd& x, std::size_t flight, double delay_s) const {
  const FlightSeries& series = flights_[flight];
  return lagged_speeds(*series.log, *steady_speeds(x, flight), rows_of(series), x[layout_.lag], delay_s);
}

CommandModel::Thrust CommandModel::thrust_of(std::size_t flight, const Speeds& speeds) const {
  return {block_means(blocks_[flight], [&](std::size_t row) {
    double sum = 0.0;
    for (const double speed : speeds[row]) sum += speed * speed;
    return sum;
  })};
}

CommandModel::Moments CommandModel::moments_of(std::size_t flight, const Speeds& speeds) const {
  const BlockedFlight& blocks = blocks_[flight];
  std::vector<Eigen::Vector4d> sums(speeds.size(), Eigen::Vector4d::Zero());  // sum s^2, L s^2
  std::vector<double> signed_speed(speeds.size(), 0.0);
  for (std::size_t row = 0; row < sums.size(); ++row) {
    for (Index i = 0; i < signs_.cols(); ++i) {
      const double speed = speeds[row][static_cast<std::size_t>(i)];
      const auto signs = signs_.col(i);
      sums[row][0] += speed * speed;
      sums[row].tail<3>() += speed * speed * signs;
      signed_speed[row] += signs[2] * speed;
    }
  }
  const FlightSeries& series = flights_[flight];
  const double* const time = series.log->time_s.data() + rows_of(series).first;
  Moments out;
  out.gained = block_gains(blocks, time, [&](std::size_t row) { return sums[row][0]; });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.turn[axis] =
        block_gains(blocks, time, [&](std::size_t row) { return sums[row][static_cast<Index>(axis) + 1]; });
  }
  out.spin_up = block_means(blocks, [&](std::size_t row) { return signed_speed[row]; });
  to_differences(out.spin_up);
  return out;
}

std::shared_ptr<const CommandModel::Thrust> CommandModel::thrust(const VectorXd& x,
                                                                 std::size_t flight) const {
  const double delay_s = x[layout_.force_delay];
  return thrust_.of(rotors_key(x, flight, delay_s),
                    [&] { return thrust_of(flight, speeds(x, flight, delay_s)); });
}

std::shared_ptr<const CommandModel::Moments> CommandModel::moments(const VectorXd& x,
                                                                   std::size_t flight) const {
  const double delay_s = x[layout_.rate_delay];
  return moments_.of(rotors_key(x, flight, delay_s),
                     [&] { return moments_of(flight, speeds(x, flight, delay_s)); });
}

std::vector<double> CommandModel::modelled(const VectorXd& x, std::size_t flight, Response response) const {
  if (response == Response::kForce) return thrust(x, flight)->mean;
  const auto by_rotors = moments(x, flight);
  const int axis = axis_of(response);
  const auto i = static_cast<std::size_t>(axis);
  const double spin_up = response == Response::kYaw ? x[layout_.spin_up] : 0.0;
  std::vector<double> out = blocks_[flight].coupling[i];
  for (std::size_t block = 0; block < out.size(); ++block) {
    out[block] += x[layout_.gain[axis]] * by_rotors->turn[i][block] +
                  x[layout_.trim[axis]] * by_rotors->gained[block] + spin_up * by_rotors->spin_up[block];
  }
  return out;
}

std::vector<double> CommandModel::unexplained(const VectorXd& x, std::size_t flight,
                                              Response response) const {
  std::vector<double> out = blocks_[flight].means[index_of(response)];
  if (response != Response::kForce) to_differences(out);
  const std::vector<double> by_model = modelled(x, flight, response);
  for (std::size_t block = 0; block < out.size(); ++block) out[block] -= by_model[block];
  return out;
}

// One channel for each response: the blocks of the estimation sets of all flights.
SeriesProblem CommandModel::problem(const std::function<void()>& on_iteration) const {
  SeriesProblem out = problem_of(layout_.parameters);
  std::vector<std::size_t> segments;  // segment of each block
  for (const BlockedFlight& flight : blocks_) {
    std::size_t last = 0;
    for (std::size_t block = 0; block < flight.estimation_set; ++block) {
      const auto segment = static_cast<std::size_t>((flight.time_s[block] - flight.time_s[0]) / kSegmentS);
      last = segment;
      segments.push_back(out.segment_count + segment);
    }
    out.segment_count += last + 1;
  }
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    out.channels.push_back({out.segments.size(), segments.size()});
    out.segments.insert(out.segments.end(), segments.begin(), segments.end());
  }
  out.residuals = [this](const VectorXd& x, VectorXd& residuals_out) { residuals(x, residuals_out); };
  out.on_iteration = on_iteration;
  return out;
}

void CommandModel::residuals(const VectorXd& x, VectorXd& out) const {
  const auto settling = static_cast<std::size_t>(std::lround(kSettlingS / sample_s()));
  Index next = 0;
  for (const Response response : responses_) {
    const ArmaNoise colour = noise(x, response);
    for (std::size_t flight = 0; flight < flights_.size(); ++flight) {
      const std::vector<double> innovation = innovations(colour, unexplained(x, flight, response));
      for (std::size_t block = 0; block < blocks_[flight].estimation_set; ++block)
        out[next++] = block < settling ? 0.0 : innovation[block];
    }
  }
}

VectorXd started_from(const CommandModel& from, const VectorXd& values, const CommandModel& to,
                      VectorXd start) {
  const std::vector<FlightParameter>& theirs = from.layout().parameters;
  const std::vector<FlightParameter>& ours = to.layout().parameters;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const auto same = std::find_if(theirs.begin(), theirs.end(), [&](const FlightParameter& parameter) {
      return parameter.name == ours[i].name;
    });
    if (same != theirs.end()) start[static_cast<Index>(i)] = values[same - theirs.begin()];
  }
  return start;
}

}  // namespace swiftlet::identification
