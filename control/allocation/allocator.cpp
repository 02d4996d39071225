#include "swiftlet/control/allocation/allocator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::control {
namespace {

using plant::PerRotor;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFitTolerance = 1e-12;         // of the highest thrust: rounding at a limit
constexpr double kCoefficientTolerance = 1e-9;  // of the largest of its kind: smaller ones count as 0
constexpr double kLeastAuthority = 1e-6;        // of plant::least_authority: below it the rank counts as 3
constexpr double kLargestMoment = 1e100;        // N m, so that no quotient of moments overflows
constexpr int kScaleSteps = 64;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double largest(const PerRotor& values) {
  double found = 0.0;
  for (const double value : values) found = std::max(found, std::abs(value));
  return found;
}

}  // namespace

Allocator::Allocator(const plant::Vehicle& vehicle)
    : esc_(vehicle.esc),
      motor_(vehicle.motor),
      rotor_(vehicle.rotor),
      count_(vehicle.rotor_count()),
      weight_n_(vehicle.mass_kg * plant::kGravity),
      square_per_thrust_(1.0 / vehicle.rotor.thrust) {
  if (count_ < plant::kMinRotors || count_ > plant::kMaxRotors) {
    throw std::invalid_argument("rotors: there are " + std::to_string(count_) + ", must be 4 .. 8");
  }
  effectiveness_ = plant::effectiveness(vehicle);

  if (!effectiveness_.allFinite() || plant::least_authority(effectiveness_) < kLeastAuthority) {
    throw std::invalid_argument(
        "rotors: their positions and spin directions cannot give thrust and all three moments");
  }
  const plant::Allocation inverse = plant::pseudo_inverse(effectiveness_);
  for (int i = 0; i < count_; ++i) {
    for_thrust_[index(i)] = inverse(i, 0);
    for_roll_[index(i)] = inverse(i, 1);
    for_pitch_[index(i)] = inverse(i, 2);
    for_yaw_[index(i)] = inverse(i, 3);
  }
  for (int i = 0; i < count_; ++i) {
    const std::size_t k = index(i);
    if (std::abs(for_yaw_[k]) <= kCoefficientTolerance * largest(for_yaw_)) continue;
    per_yaw_[k] = 1.0 / for_yaw_[k];
    thrust_per_yaw_[k] = for_thrust_[k] / for_yaw_[k];
  }

  const std::vector<double>& voltages = vehicle.battery.open_circuit_voltage_v;
  if (voltages.empty() || !(voltages.front() > 0.0)) {
    throw std::invalid_argument("battery.open_circuit_voltage: must be a table of voltages above 0");
  }
  plausible_ = {0.5 * voltages.front(), 1.5 * voltages.back(), 0.5 * (voltages.front() + voltages.back())};
  idle_thrust_n_ = thrust_at(plausible_.assumed, 0.0);
  const double most = thrust_at(plausible_.max, 1.0);
  bound_.thrust_n = most * count_;
  bound_.moment_frd = most * effectiveness_.bottomRows<3>().cwiseAbs().rowwise().sum();
}

double Allocator::thrust_at(double supply_voltage_v, double throttle) const {
  const double v_a = plant::motor_voltage(esc_, supply_voltage_v, throttle);
  return plant::thrust_from_speed(rotor_, plant::steady_speed_from_voltage(motor_, v_a));
}

Allocator::Supply Allocator::supply_at(double supply_voltage_v) const {
  Supply supply;
  supply.plausible = supply_voltage_v >= plausible_.min && supply_voltage_v <= plausible_.max;
  const double voltage_v = supply.plausible ? supply_voltage_v : plausible_.assumed;
  supply.highest_thrust_n = thrust_at(voltage_v, 1.0);
  supply.throttle_per_square = 1.0 / (esc_.gain * voltage_v * voltage_v);
  return supply;
}

Wrench Allocator::wrench(const PerRotor& thrust_n) const {
  Wrench sum;
  for (int i = 0; i < count_; ++i) {
    sum.thrust_n += thrust_n[index(i)];
    sum.moment_frd += effectiveness_.col(i).tail<3>() * thrust_n[index(i)];
  }
  return sum;
}

// True for a finite wrench that sanitised() would not change.
bool Allocator::within_bound(const Wrench& wanted) const {
  return std::abs(wanted.thrust_n) <= bound_.thrust_n &&
         std::abs(wanted.moment_frd.x()) <= bound_.moment_frd.x() &&
         std::abs(wanted.moment_frd.y()) <= bound_.moment_frd.y() &&
         std::abs(wanted.moment_frd.z()) <= bound_.moment_frd.z();
}

Wrench Allocator::sanitised(const Wrench& wanted, bool& invalid) const {
  Wrench out = wanted;
  if (!std::isfinite(out.thrust_n)) {
    out.thrust_n = weight_n_;
    invalid = true;
  }
  for (double& moment : out.moment_frd) {
    invalid |= !std::isfinite(moment);
    moment = std::isfinite(moment) ? std::clamp(moment, -kLargestMoment, kLargestMoment) : 0.0;
  }
  // No wrench beyond the bound fits, so clipping there first changes no result and keeps the arithmetic
  // finite.
  out.thrust_n = std::clamp(out.thrust_n, -bound_.thrust_n, bound_.thrust_n);
  const Eigen::Array2d size = out.moment_frd.head<2>().array().abs();
  const Eigen::Array2d bound = bound_.moment_frd.head<2>().array();
  if ((size > bound).any()) out.moment_frd.head<2>() /= (size / bound).maxCoeff();
  out.moment_frd.z() = std::clamp(out.moment_frd.z(), -bound_.moment_frd.z(), bound_.moment_frd.z());
  return out;
}

Allocation Allocator::allocate(const Wrench& wanted, const Supply& supply) const {
  return count_ == plant::kMinRotors ? allocate_to<plant::kMinRotors>(wanted, supply)
                                     : allocate_to<plant::kMaxRotors>(wanted, supply);
}

// kCount: number of values computed side by side; those beyond count_ belong to no rotor.
template <int kCount>
Allocation Allocator::allocate_to(const Wrench& wanted, const Supply& supply) const {
  using Values = Eigen::Array<double, kCount, 1>;
  const auto values = [](const PerRotor& of) { return Eigen::Map<const Values>(of.data()); };
  Allocation out;
  out.invalid_input = !supply.plausible;
  const Wrench wrench = within_bound(wanted) ? wanted : sanitised(wanted, out.invalid_input);
  const Interval limits{idle_thrust_n_, supply.highest_thrust_n};

  const double slack = kFitTolerance * limits.high;
  const Values tilt = values(for_roll_) * wrench.moment_frd.x() + values(for_pitch_) * wrench.moment_frd.y();
  Values thrust_n = tilt + values(for_thrust_) * wrench.thrust_n + values(for_yaw_) * wrench.moment_frd.z();
  constexpr int kExisting = kCount == plant::kMinRotors ? kCount : Eigen::Dynamic;
  const auto exists = thrust_n.template head<kExisting>(count_);
  out.saturated = exists.minCoeff() < limits.low - slack || exists.maxCoeff() > limits.high + slack;
  if (out.saturated) {
    PerRotor tilts{};
    Eigen::Map<Values>(tilts.data()) = tilt;
    thrust_n = values(fitted(wrench, tilts, limits));
  }
  thrust_n = thrust_n.max(limits.low).min(limits.high);
  const Values speed_squared = thrust_n * square_per_thrust_;                       // Eq. (25)
  const Values v_a = motor_.k2 * speed_squared.sqrt() + motor_.k3 * speed_squared;  // Eq. (22)
  Values throttle = (v_a.square() - esc_.offset_v2) * supply.throttle_per_square;   // Eq. (9)
  throttle = throttle.max(0.0).min(1.0);
  if constexpr (kCount > plant::kMinRotors) {
    thrust_n.tail(kCount - count_).setZero();
    throttle.tail(kCount - count_).setZero();
  }
  Eigen::Map<Values>(out.thrust_n.data()) = thrust_n;
  Eigen::Map<Values>(out.throttle.data()) = throttle;
  return out;
}

// With roll and pitch scaled by s, rotor i has t_i = s tilt_i + for_thrust_i T + for_yaw_i Y, and low <= t_i
// <= high for all i is a convex region of (s, T, Y). Elimination (Fourier-Motzkin) projects it on (s, T),
// then on s; s, T, Y are chosen one after the other.
PerRotor Allocator::fitted(const Wrench& wanted, const PerRotor& tilt, const Interval& limits) const {
  const double scale = largest_scale(tilt, limits);
  const Interval thrust_range = thrust_interval(scale, tilt, limits).at;
  const double thrust = nearest(wanted.thrust_n, thrust_range);
  const double yaw = nearest(wanted.moment_frd.z(), yaw_interval(scale, thrust, tilt, limits));
  PerRotor thrusts{};
  for (int i = 0; i < count_; ++i) {
    const std::size_t k = index(i);
    thrusts[k] = scale * tilt[k] + for_thrust_[k] * thrust + for_yaw_[k] * yaw;
  }
  return thrusts;
}

double Allocator::nearest(double wanted, const Interval& interval) {
  if (interval.low > interval.high) return 0.5 * (interval.low + interval.high);  // apart by rounding
  return std::clamp(wanted, interval.low, interval.high);
}

// Visits every bound a T <= c + d s that remains when yaw is eliminated: for each pair of rotors, the least
// yaw of one is at most the greatest yaw of the other; a rotor that yaw does not change has two bounds of
// its own. Coefficients a that are 0 up to rounding are passed as 0.
template <typename Visit>
void Allocator::visit_thrust_bounds(const PerRotor& tilt, const Interval& limits, Visit&& visit) const {
  PerRotor least{};
  PerRotor greatest{};
  PerRotor tilt_per_yaw{};
  double size = 0.0;
  for (int i = 0; i < count_; ++i) {
    const std::size_t k = index(i);
    const double at_low = limits.low * per_yaw_[k];
    const double at_high = limits.high * per_yaw_[k];
    least[k] = std::min(at_low, at_high);
    greatest[k] = std::max(at_low, at_high);
    tilt_per_yaw[k] = tilt[k] * per_yaw_[k];
    size = std::max(size, std::abs(thrust_per_yaw_[k]));
  }
  for (int i = 0; i < count_; ++i) {
    const std::size_t k = index(i);
    if (per_yaw_[k] == 0.0) {
      visit(for_thrust_[k], limits.high, -tilt[k]);
      visit(-for_thrust_[k], -limits.low, tilt[k]);
      continue;
    }
    for (int j = 0; j < count_; ++j) {
      const std::size_t l = index(j);
      if (l == k || per_yaw_[l] == 0.0) continue;
      const double a = thrust_per_yaw_[l] - thrust_per_yaw_[k];
      visit(std::abs(a) > kCoefficientTolerance * size ? a : 0.0, greatest[l] - least[k],
            tilt_per_yaw[k] - tilt_per_yaw[l]);
    }
  }
}

Allocator::ThrustInterval Allocator::thrust_interval(double scale, const PerRotor& tilt,
                                                     const Interval& limits) const {
  ThrustInterval out{{-kInfinity, kInfinity}, {0.0, 0.0}};
  visit_thrust_bounds(tilt, limits, [&](double a, double c, double d) {
    if (a == 0.0) return;
    const double end = (c + d * scale) / a;
    if (a > 0.0 && end < out.at.high) {
      out.at.high = end;
      out.slope.high = d / a;
    } else if (a < 0.0 && end > out.at.low) {
      out.at.low = end;
      out.slope.low = d / a;
    }
  });
  return out;
}

// The width of the thrust interval is concave and piecewise linear in the scale, so Newton's method from
// above converges to its root from above in a few steps.
double Allocator::largest_scale(const PerRotor& tilt, const Interval& limits) const {
  double scale = 1.0;
  visit_thrust_bounds(tilt, limits, [&](double a, double c, double d) {
    if (a == 0.0 && d < 0.0) scale = std::min(scale, c / -d);
  });
  for (int i = 0; i < kScaleSteps && scale > 0.0; ++i) {
    const ThrustInterval thrust = thrust_interval(scale, tilt, limits);
    const double width = thrust.at.high - thrust.at.low;
    const double slope = thrust.slope.high - thrust.slope.low;
    if (width >= -kFitTolerance * limits.high) break;
    scale = slope < 0.0 ? scale - width / slope : 0.0;
  }
  return std::max(scale, 0.0);
}

Allocator::Interval Allocator::yaw_interval(double scale, double thrust, const PerRotor& tilt,
                                            const Interval& limits) const {
  Interval out{-kInfinity, kInfinity};
  for (int i = 0; i < count_; ++i) {
    const std::size_t k = index(i);
    if (per_yaw_[k] == 0.0) continue;
    const double without_yaw = scale * tilt[k] + for_thrust_[k] * thrust;
    const double at_low = (limits.low - without_yaw) * per_yaw_[k];
    const double at_high = (limits.high - without_yaw) * per_yaw_[k];
    out.low = std::max(out.low, std::min(at_low, at_high));
    out.high = std::min(out.high, std::max(at_low, at_high));
  }
  return out;
}

}  // namespace swiftlet::control
