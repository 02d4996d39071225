#include "swiftlet/identification/flight/flight_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kAveragedS = 0.01;         // s, block of samples that are averaged
constexpr std::size_t kBlocksInWindow = 5;  // rates are integrated over a window from a free initial value

const char* const kAxes[3] = {"roll", "pitch", "yaw"};

// Number of rows in a block.
std::size_t block_of(const FlightSeries& flight) {
  const std::vector<double>& time = flight.log->time_s;
  const double step = (time[flight.estimation_set.last - 1] - time[flight.estimation_set.first]) /
                      static_cast<double>(flight.estimation_set.size());
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kAveragedS / step)));
}

std::size_t blocks_in(const Rows& segment, std::size_t block) { return (segment.size() + block - 1) / block; }

plant::PerRotor speed_errors(const plant::PerRotor& measured, const plant::PerRotor& modelled, double scale,
                             int rotors) {
  plant::PerRotor out{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotors); ++i)
    out[i] = measured[i] - scale * modelled[i];
  return out;
}

}  // namespace

FlightModel::FlightModel(std::vector<FlightSeries> flights, plant::Vehicle base)
    : flights_(std::move(flights)),
      base_(std::move(base)),
      effectiveness_(plant::effectiveness(base_)),
      wrenches_(kCachedPerFlight * flights_.size()) {
  for (const FlightSeries& flight : flights_) block_.push_back(block_of(flight));
  assign_parameter_indices();
}

void FlightModel::assign_parameter_indices() {
  FlightLayout& l = layout_;
  const auto add = [&l](FlightParameter parameter) {
    return identification::add(std::move(parameter), l.parameters);
  };
  l.lag = add({"rotor lag", "s", base_.motor.time_constant_s, 0.01, 2e-3, 1.0});
  if (source() == SpeedSource::kMeasured) {
    l.motor_delay = add({"delay from command to rotor speed", "s", 2e-3, 2e-3, -0.02, 0.05});
    l.speed_scale = add({"measured over modelled rotor speed", "1", 1.0, 0.05, 0.1, 10.0});
  } else {
    l.force_delay = add({"delay from command to specific force", "s", 2e-3, 2e-3, -0.02, 0.05});
    l.rate_delay = add({"delay from command to angular acceleration", "s", 2e-3, 2e-3, -0.02, 0.05});
  }
  l.thrust = add({"thrust relative to the base vehicle", "1", 1.0, 0.1, 0.01, 100.0});
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = kAxes[axis];
    l.gain[axis] =
        add({"gain about " + name + " relative to the base vehicle", "1", 1.0, 0.1, -100.0, 100.0});
    l.trim[axis] = add({"offset of the centre of thrust, " + name, "m", 0.0, 1e-3, -0.1, 0.1});
  }
  l.drag = add({"drag over mass", "1/s", 0.1, 0.1, -10.0, 50.0});
  l.axial_drag = add({"drag over mass along the rotors' axis", "1/s", 0.1, 0.1, -10.0, 50.0});
  for (const FlightSeries& flight : flights_) {
    l.offset.push_back(static_cast<int>(l.parameters.size()));
    for (int axis = 0; axis < 3; ++axis) {
      add({std::string("accelerometer offset ") + "xyz"[axis] +
               (flights_.size() > 1 ? ", " + flight.log->name : ""),
           "m/s^2", 0.0, 0.1, -5.0, 5.0});
    }
  }
}

Vector3d FlightModel::inertia(const VectorXd& x) const {
  const double s = x[layout_.thrust];
  const Vector3d gain(x[layout_.gain[0]], x[layout_.gain[1]], x[layout_.gain[2]]);
  return Vector3d(s, s, 1.0).cwiseProduct(base_.inertia.diagonal()).cwiseQuotient(gain);
}

Vector3d FlightModel::offset(const VectorXd& x, std::size_t flight) const {
  const int first = layout_.offset[flight];
  return {x[first], x[first + 1], x[first + 2]};
}

FlightModel::Wrenches FlightModel::wrenches_of(const std::vector<plant::PerRotor>& speeds) const {
  Wrenches out(speeds.size(), Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    for (Index rotor = 0; rotor < effectiveness_.cols(); ++rotor) {
      const double speed = speeds[i][static_cast<std::size_t>(rotor)];
      out[i] += effectiveness_.col(rotor) * (base_.rotor.thrust * speed * speed);
    }
  }
  return out;
}

FlightModel::Wrenches FlightModel::computed_wrenches(std::size_t flight, const Rows& rows, double lag_s,
                                                     double delay_s) const {
  const FlightSeries& series = flights_[flight];
  if (source() != SpeedSource::kMeasured)
    return wrenches_of(lagged_speeds(*series.log, series.steady_speeds, rows, lag_s, delay_s));
  const auto measured = series.log->rotor_speeds.begin();
  return wrenches_of({measured + static_cast<std::ptrdiff_t>(rows.first),
                      measured + static_cast<std::ptrdiff_t>(rows.last)});
}

std::shared_ptr<const FlightModel::Wrenches> FlightModel::wrenches(const VectorXd& x, std::size_t flight,
                                                                   const Rows& rows, double delay_s) const {
  const double lag_s = source() == SpeedSource::kMeasured ? 0.0 : x[layout_.lag];
  return wrenches_.of({flight, rows.first, rows.last, lag_s, delay_s},
                      [&] { return computed_wrenches(flight, rows, lag_s, delay_s); });
}

FlightModel::Drive FlightModel::drive(const VectorXd& x, std::size_t flight, const Rows& rows) const {
  const auto for_force = wrenches(x, flight, rows, value(x, layout_.force_delay));
  const auto for_rates = wrenches(x, flight, rows, value(x, layout_.rate_delay));
  return drive_by(x, flight, rows, *for_force, *for_rates);
}

FlightModel::Drive FlightModel::drive_by_commands(const VectorXd& x, std::size_t flight,
                                                  const Rows& rows) const {
  if (source() != SpeedSource::kMeasured) return drive(x, flight, rows);
  const FlightSeries& series = flights_[flight];
  std::vector<plant::PerRotor> speeds =
      lagged_speeds(*series.log, series.steady_speeds, rows, x[layout_.lag], x[layout_.motor_delay]);
  for (plant::PerRotor& of_row : speeds) {
    for (double& speed : of_row) speed *= x[layout_.speed_scale];
  }
  const Wrenches by_commands = wrenches_of(speeds);
  return drive_by(x, flight, rows, by_commands, by_commands);
}

FlightModel::Drive FlightModel::drive_by(const VectorXd& x, std::size_t flight, const Rows& rows,
                                         const Wrenches& for_force, const Wrenches& for_rates) const {
  const FlightSeries& series = flights_[flight];
  const double thrust_over_mass = x[layout_.thrust] / base_.mass_kg;
  const Vector3d drag(x[layout_.drag], x[layout_.drag], x[layout_.axial_drag]);
  const Vector3d gain = Vector3d(x[layout_.gain[0]], x[layout_.gain[1]], x[layout_.gain[2]])
                            .cwiseQuotient(base_.inertia.diagonal());
  // A thrust T through (x, y) gives the moment (-y T, x T).
  const Vector3d trim(-x[layout_.trim[0]], x[layout_.trim[1]], x[layout_.trim[2]]);
  Drive out;
  out.specific_force.reserve(rows.size());
  out.acceleration.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Vector3d force(0.0, 0.0, -thrust_over_mass * for_force[i][0]);
    const std::size_t row = rows.first + i;
    force -= drag.cwiseProduct(series.attitude[row].conjugate() * series.velocity_ned[row]);
    out.specific_force.push_back(force);
    const Eigen::Vector4d& moments = for_rates[i];
    out.acceleration.push_back(gain.cwiseProduct(moments.tail<3>() + moments[0] * trim));
  }
  return out;
}

Vector3d FlightModel::rate_derivative(const Vector3d& inertia, const Vector3d& acceleration,
                                      const Vector3d& rates) {
  return acceleration - rates.cross(inertia.cwiseProduct(rates)).cwiseQuotient(inertia);
}

// Channels, in this order: specific force x, y, z; rates p, q, r; with measured rotor speeds, speed of each
// rotor less the mean of all rotors, and that mean over each segment; vertical motion.
SeriesProblem FlightModel::problem(const std::function<void()>& on_iteration) const {
  SeriesProblem out = problem_of(layout_.parameters);
  out.disturbances_last = true;
  std::vector<std::size_t> per_row;  // segment of each block, all flights
  std::vector<std::size_t> per_segment;
  for (std::size_t f = 0; f < flights_.size(); ++f) {
    const FlightSeries& flight = flights_[f];
    for (const Rows& segment : flight.segments) {
      per_row.insert(per_row.end(), blocks_in(segment, block_[f]), out.segment_count);
      per_segment.push_back(out.segment_count);
      ++out.segment_count;
    }
  }
  const auto add_channel = [&](const std::vector<std::size_t>& segments) {
    out.channels.push_back({out.segments.size(), segments.size()});
    out.segments.insert(out.segments.end(), segments.begin(), segments.end());
  };
  for (int i = 0; i < 6; ++i) add_channel(per_row);
  if (source() == SpeedSource::kMeasured) {
    for (int i = 0; i < base_.rotor_count(); ++i) add_channel(per_row);
    add_channel(per_segment);
  }
  add_channel(per_segment);
  out.residuals = [this](const VectorXd& x, VectorXd& residuals_out) { residuals(x, residuals_out); };
  out.on_iteration = on_iteration;
  return out;
}

// The residuals of a segment's rows, averaged over its blocks: specific force, rates, and with measured rotor speeds those of
// each rotor. Returns the error of the mean speed of all rotors, rad/s; 0 without measured speeds.
double FlightModel::segment_residuals(const VectorXd& x, std::size_t f, const Rows& segment,
                                      const Prediction& by_model, Blocks blocks, VectorXd& out) const {
  const FlightLog& log = *flights_[f].log;
  const Index rotors = by_model.speeds.empty() ? 0 : base_.rotor_count();
  Vector3d predicted = Vector3d::Zero();
  Vector3d before = Vector3d::Zero();
  double mean_error = 0.0;
  for (std::size_t row = segment.first; row < segment.last; ++row) {
    const std::size_t i = row - by_model.first_row;
    const std::size_t block = (row - segment.first) / block_[f];
    const std::size_t in_block = std::min(block_[f], segment.size() - block * block_[f]);
    const double share = 1.0 / static_cast<double>(in_block);
    const Index at = blocks.begin + static_cast<Index>(block);
    const Vector3d force = log.specific_force_frd[row] - by_model.drive.specific_force[i] - by_model.bias;
    const Vector3d slope =
        rate_derivative(by_model.inertia, by_model.drive.acceleration[i], log.body_rates_frd[row]);
    if (row > segment.first) predicted += 0.5 * (log.time_s[row] - log.time_s[row - 1]) * (before + slope);
    before = slope;
    const Vector3d rate = log.body_rates_frd[row] - predicted;
    for (Index axis = 0; axis < 3; ++axis) {
      out[axis * blocks.of_all + at] += share * force[axis];
      out[(3 + axis) * blocks.of_all + at] += share * rate[axis];
    }
    if (rotors == 0) continue;
    // The supply voltage sags with every change of thrust, faster than it is sampled. This error is
    // common to all rotors: the residuals of single rotors omit their mean.
    const plant::PerRotor error =
        speed_errors(log.rotor_speeds[row], by_model.speeds[i], x[layout_.speed_scale], base_.rotor_count());
    const double common = std::accumulate(error.begin(), error.end(), 0.0) / base_.rotor_count();
    for (Index rotor = 0; rotor < rotors; ++rotor)
      out[(6 + rotor) * blocks.of_all + at] += share * (error[static_cast<std::size_t>(rotor)] - common);
    mean_error += common / static_cast<double>(segment.size());
  }
  return mean_error;
}

// Vertical part of dv/dt = R (f - b) + g, averaged over each segment.
void FlightModel::vertical_residuals(const VectorXd& x, std::size_t f, Index& next, VectorXd& out) const {
  const FlightSeries& flight = flights_[f];
  const FlightLog& log = *flight.log;
  const Vector3d bias = offset(x, f);
  const auto vertical = [&](std::size_t row) {
    return (flight.attitude[row] * (log.specific_force_frd[row] - bias)).z() + plant::kGravity;
  };
  for (const Rows& segment : flight.segments) {
    double gained = 0.0;
    for (std::size_t row = segment.first + 1; row < segment.last; ++row)
      gained += 0.5 * (log.time_s[row] - log.time_s[row - 1]) * (vertical(row) + vertical(row - 1));
    const double length_s = log.time_s[segment.last - 1] - log.time_s[segment.first];
    const double flown = flight.velocity_ned[segment.last - 1].z() - flight.velocity_ned[segment.first].z();
    out[next++] = (flown - gained) / length_s;
  }
}

void FlightModel::residuals(const VectorXd& x, VectorXd& out) const {
  Blocks blocks;
  for (std::size_t f = 0; f < flights_.size(); ++f) {
    for (const Rows& segment : flights_[f].segments)
      blocks.of_all += static_cast<Index>(blocks_in(segment, block_[f]));
  }
  const bool with_speeds = source() == SpeedSource::kMeasured;
  Index next = (6 + (with_speeds ? base_.rotor_count() : 0)) * blocks.of_all;
  out.head(next).setZero();

  for (std::size_t f = 0; f < flights_.size(); ++f) {
    const FlightSeries& flight = flights_[f];
    if (flight.segments.empty()) continue;
    const Rows all{flight.segments.front().first, flight.segments.back().last};
    Prediction by_model{all.first, drive(x, f, all), inertia(x), offset(x, f), {}};
    if (with_speeds)
      by_model.speeds =
          lagged_speeds(*flight.log, flight.steady_speeds, all, x[layout_.lag], x[layout_.motor_delay]);

    for (const Rows& segment : flight.segments) {
      const auto count = static_cast<Index>(blocks_in(segment, block_[f]));
      const double mean_error = segment_residuals(x, f, segment, by_model, blocks, out);
      if (with_speeds) out[next++] = mean_error;
      const auto window = static_cast<Index>(kBlocksInWindow);
      for (Index from = 0; from < count; from += window) {
        for (Index axis = 0; axis < 3; ++axis) {
          auto rates =
              out.segment((3 + axis) * blocks.of_all + blocks.begin + from, std::min(window, count - from));
          rates.array() -= rates.mean();
        }
      }
      blocks.begin += count;
    }
  }
  for (std::size_t f = 0; f < flights_.size(); ++f) vertical_residuals(x, f, next, out);
}

}  // namespace swiftlet::identification
