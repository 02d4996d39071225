#include "swiftlet/identification/flight/motor_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kBlockS = 0.02;
constexpr double kDelays_s[] = {0.0, 0.01, 0.02, 0.03};  // from command to rate, beside the lag
constexpr std::size_t kLeastBlocks = 100;
// Ratio of the unexplained variances of two orders, all axes multiplied, above which one is clearly better. A wrong order of
// two motors explains next to nothing about one axis at least; feedback explains up to a few per cent by itself.
constexpr double kClearlyBetter = 1.5;

// Second moments of the changes of lagged commands and rates over blocks.
struct Moments {
  MatrixXd commands;        // N x N
  MatrixXd commands_rates;  // N x 3
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  std::size_t blocks = 0;
};

// The mean lagged command over a block gives the change of the rate over it. Means over the flight are left out.
Moments moments_of(const FlightLog& log, const Rows& flight, double lag_s, double delay_s) {
  const auto rotors = static_cast<Index>(log.rotor_count);
  std::vector<Eigen::VectorXd> commands;
  std::vector<Eigen::Vector3d> changes;
  Eigen::VectorXd lagged = Eigen::VectorXd::Zero(rotors);
  for (Index i = 0; i < rotors; ++i) lagged[i] = log.command[flight.first][static_cast<std::size_t>(i)];
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rotors);
  std::size_t begin = flight.first;
  std::size_t delayed = flight.first;
  for (std::size_t row = flight.first + 1; row < flight.last; ++row) {
    const double h = log.time_s[row] - log.time_s[row - 1];
    while (delayed + 1 < row && log.time_s[delayed + 1] <= log.time_s[row - 1] - delay_s) ++delayed;
    const double share = -std::expm1(-h / lag_s);
    for (Index i = 0; i < rotors; ++i)
      lagged[i] += share * (log.command[delayed][static_cast<std::size_t>(i)] - lagged[i]);
    sum += h * lagged;
    const double length_s = log.time_s[row] - log.time_s[begin];
    if (length_s < kBlockS) continue;
    commands.emplace_back(sum / length_s);
    changes.emplace_back((log.body_rates_frd[row] - log.body_rates_frd[begin]) / length_s);
    sum.setZero();
    begin = row;
  }
  Moments out;
  out.blocks = commands.size();
  out.commands = MatrixXd::Zero(rotors, rotors);
  out.commands_rates = MatrixXd::Zero(rotors, 3);
  if (commands.empty()) return out;
  Eigen::VectorXd mean_command = Eigen::VectorXd::Zero(rotors);
  Eigen::Vector3d mean_change = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < commands.size(); ++k) {
    mean_command += commands[k] / static_cast<double>(commands.size());
    mean_change += changes[k] / static_cast<double>(commands.size());
  }
  for (std::size_t k = 0; k < commands.size(); ++k) {
    const Eigen::VectorXd command = commands[k] - mean_command;
    const Eigen::Vector3d change = changes[k] - mean_change;
    out.commands += command * command.transpose();
    out.commands_rates += command * change.transpose();
    out.rates += change.cwiseAbs2();
  }
  return out;
}

// order[i]: the rotor that motor i of the log turns. The log of the ratio of unexplained to whole variance, all axes.
double unexplained(const Moments& moments, const plant::Effectiveness& effectiveness,
                   const std::vector<Index>& order) {
  double sum = 0.0;
  Eigen::VectorXd moment(moments.commands.rows());
  for (Index axis = 0; axis < 3; ++axis) {
    for (Index i = 0; i < moment.size(); ++i)
      moment[i] = effectiveness(1 + axis, order[static_cast<std::size_t>(i)]);
    const double variance = moment.dot(moments.commands * moment) * moments.rates[axis];
    const double covariance = moment.dot(moments.commands_rates.col(axis));
    if (covariance > 0.0 && variance > 0.0)
      sum += std::log1p(-std::min(covariance * covariance / variance, 1.0 - 1e-9));
  }
  return sum;
}

// Least over the delays.
double unexplained(const std::vector<Moments>& moments, const plant::Effectiveness& effectiveness,
                   const std::vector<Index>& order) {
  double least = std::numeric_limits<double>::infinity();
  for (const Moments& one : moments) least = std::min(least, unexplained(one, effectiveness, order));
  return least;
}

// "front right"
std::string place_of(const plant::RotorMount& rotor) {
  const double x = rotor.position_frd.x();
  const double y = rotor.position_frd.y();
  const std::string along = x > 0.3 * std::abs(y) ? "front" : x < -0.3 * std::abs(y) ? "rear" : "";
  const std::string across = y > 0.3 * std::abs(x) ? "right" : y < -0.3 * std::abs(x) ? "left" : "";
  return along + (along.empty() || across.empty() ? "" : " ") + across;
}

}  // namespace

void require_motor_order(const FlightLog& log, const Rows& flight, const plant::Vehicle& base) {
  std::vector<Moments> moments;
  for (const double delay_s : kDelays_s)
    moments.push_back(moments_of(log, flight, base.motor.time_constant_s, delay_s));
  if (moments.front().blocks < kLeastBlocks) return;
  const plant::Effectiveness effectiveness = plant::effectiveness(base);
  std::vector<Index> order(base.rotors.size());
  std::iota(order.begin(), order.end(), 0);
  const double as_given = unexplained(moments, effectiveness, order);
  std::vector<Index> best = order;
  double least = as_given;
  while (std::next_permutation(order.begin(), order.end())) {
    const double now = unexplained(moments, effectiveness, order);
    if (now >= least) continue;
    least = now;
    best = order;
  }
  if (as_given - least < std::log(kClearlyBetter)) return;
  std::string moved;
  for (std::size_t motor = 0; motor < best.size(); ++motor) {
    const auto rotor = static_cast<std::size_t>(best[motor]);
    if (rotor == motor) continue;
    moved += (moved.empty() ? "motor " : ", motor ") + std::to_string(motor + 1) + " acts like rotor " +
             std::to_string(rotor + 1) + " (" + place_of(base.rotors[rotor]) + ")";
  }
  throw BadData("commands: the vehicle turns as if these motors were exchanged, by sign and axis: " + moved +
                "; the rotors are those of " + base.name + ", are the motors in its order?");
}

}  // namespace swiftlet::identification
