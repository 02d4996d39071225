#include "swiftlet/identification/flight/thrust_scale.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kBlock_s = 0.1;
constexpr std::size_t kFewestBlocks = 20;
constexpr double kKnownSlope = 0.2;  // greatest standard deviation over the slope
constexpr double kNominalCharge = 0.6;
constexpr double kThrottleStep = 0.005;  // of throttle, for the slope of the curve

struct Block {
  double throttle = 0.0;
  double force = 0.0;
};

// Means over blocks of the force samples, and of the throttle behind the lag of the motors at their times.
std::vector<Block> blocks_of(const ThrottleRecord& record, double time_constant_s) {
  std::vector<Block> blocks;
  std::size_t next = 0;
  double throttle = 0.0;
  double lagged = 0.0;
  bool begun = false;
  double last_s = 0.0;
  double begin_s = record.from_s;
  Block sum;
  std::size_t count = 0;
  for (std::size_t i = 0; i < record.force_time_s.size(); ++i) {
    const double time_s = record.force_time_s[i];
    while (next < record.throttle_time_s.size() && record.throttle_time_s[next] <= time_s)
      throttle = record.throttle[next++];
    if (next == 0) continue;
    lagged = begun ? lagged + (throttle - lagged) * (1.0 - std::exp(-(time_s - last_s) / time_constant_s))
                   : throttle;
    begun = true;
    last_s = time_s;
    if (time_s < record.from_s || time_s > record.until_s) continue;
    if (time_s - begin_s > kBlock_s) {
      if (count > 0)
        blocks.push_back({sum.throttle / static_cast<double>(count), sum.force / static_cast<double>(count)});
      sum = {};
      count = 0;
      begin_s = time_s;
    }
    sum.throttle += lagged;
    sum.force += record.specific_force_up[i];
    ++count;
  }
  return blocks;
}

double mean_voltage(const ThrottleRecord& record) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < record.voltage_time_s.size(); ++i) {
    if (record.voltage_time_s[i] < record.from_s || record.voltage_time_s[i] > record.until_s) continue;
    sum += record.supply_voltage_v[i];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

ThrustScale fit_thrust_scale(const ThrottleRecord& record, const plant::Vehicle& vehicle) {
  const std::vector<Block> blocks = blocks_of(record, vehicle.motor.time_constant_s);
  if (blocks.size() < kFewestBlocks)
    throw BadData(
        fmt::format("the log has {:.1f} s of flight with throttle and specific force, 2 s are needed",
                    kBlock_s * static_cast<double>(blocks.size())));
  const auto count = static_cast<double>(blocks.size());
  Block mean;
  for (const Block& block : blocks) {
    mean.throttle += block.throttle / count;
    mean.force += block.force / count;
  }
  double variance = 0.0, covariance = 0.0;
  ThrustScale scale;
  scale.least_throttle = scale.greatest_throttle = blocks.front().throttle;
  for (const Block& block : blocks) {
    const double off = block.throttle - mean.throttle;
    variance += off * off;
    covariance += off * (block.force - mean.force);
    scale.least_throttle = std::min(scale.least_throttle, block.throttle);
    scale.greatest_throttle = std::max(scale.greatest_throttle, block.throttle);
  }
  const double slope = variance > 0.0 ? covariance / variance : 0.0;
  double residual = 0.0;
  for (const Block& block : blocks) {
    const double off = block.force - mean.force - slope * (block.throttle - mean.throttle);
    residual += off * off / (count - 2.0);
  }
  const double slope_deviation = variance > 0.0 ? std::sqrt(residual / variance) : 0.0;
  scale.blocks = blocks.size();
  scale.residual_n = vehicle.mass_kg * std::sqrt(residual);
  scale.slope_n = vehicle.mass_kg * slope;
  scale.slope_deviation = vehicle.mass_kg * slope_deviation;
  scale.slope_known = slope > 0.0 && slope_deviation < kKnownSlope * slope;
  // Without a slope, the thrust is taken as proportional to the throttle; the flight is near hover then.
  const double per_throttle = scale.slope_known ? slope : mean.force / mean.throttle;
  scale.hover_throttle = mean.throttle + (plant::kGravity - mean.force) / per_throttle;
  scale.hover_deviation = std::sqrt(residual / count) / per_throttle;
  scale.supply_voltage_v = mean_voltage(record);
  const double voltage_v = scale.supply_voltage_v > 0.0
                               ? scale.supply_voltage_v
                               : plant::open_circuit_voltage(vehicle.battery, kNominalCharge);
  scale.curve_throttle = plant::throttle_from_steady_thrust(
      vehicle, voltage_v, vehicle.mass_kg * plant::kGravity / vehicle.rotor_count());
  const auto thrust_n = [&](double throttle) {
    return vehicle.rotor_count() * plant::steady_thrust_from_throttle(vehicle, voltage_v, throttle);
  };
  scale.curve_slope_n =
      (thrust_n(scale.curve_throttle + kThrottleStep) - thrust_n(scale.curve_throttle - kThrottleStep)) /
      (2.0 * kThrottleStep);
  return scale;
}

}  // namespace swiftlet::identification
