#include "swiftlet/services/px4/thrust_scale.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::px4 {
namespace {

constexpr double kNominalCharge = 0.6;   // state of charge of the nominal voltage
constexpr double kVoltageMargin = 0.15;  // of the range of the battery, for its sag
constexpr double kLeastFactor = 0.3;
constexpr double kGreatestFactor = 3.0;
constexpr double kLeastThrust = 0.6;  // of the weight, to learn
constexpr double kGreatestThrust = 1.5;
constexpr double kSettling_s = 0.5;  // in free flight near hover, before anything is learnt
constexpr double kLearning_s = 1.0;  // time constant
constexpr double kLongestStep_s = 0.1;
constexpr std::int64_t kTouchdownNs = 1'500'000'000;

bool is_near(double thrust_n, double weight_n) {
  return thrust_n > kLeastThrust * weight_n && thrust_n < kGreatestThrust * weight_n;
}

}  // namespace

ThrustScale::ThrustScale(const plant::Vehicle& vehicle, std::optional<double> hover_throttle)
    : vehicle_(vehicle),
      weight_n_(vehicle.mass_kg * plant::kGravity),
      voltage_v_(plant::open_circuit_voltage(vehicle.battery, kNominalCharge)) {
  if (!hover_throttle) return;
  const double of_curve = curve(weight_n_);
  if (of_curve > 0.0) factor_ = std::clamp(*hover_throttle / of_curve, kLeastFactor, kGreatestFactor);
}

double ThrustScale::curve(double thrust_n) const {
  return plant::throttle_from_steady_thrust(vehicle_, voltage_v_, thrust_n / vehicle_.rotor_count());
}

double ThrustScale::throttle(double thrust_n) const {
  if (!(thrust_n > 0.0)) return 0.0;
  return std::clamp(factor_ * curve(thrust_n), 0.0, 1.0);
}

void ThrustScale::set_voltage(double supply_voltage_v) {
  const double least = vehicle_.battery.open_circuit_voltage_v.front() * (1.0 - kVoltageMargin);
  const double greatest = vehicle_.battery.open_circuit_voltage_v.back() * (1.0 + kVoltageMargin);
  if (supply_voltage_v > least && supply_voltage_v < greatest) voltage_v_ = supply_voltage_v;
}

void ThrustScale::note_flight(bool flying, std::int64_t stamp_ns) {
  if (!flying) {
    if (marked_ns_ >= 0) factor_ = earlier_factor_;
    marked_ns_ = -1;
  } else if (marked_ns_ < 0) {
    recent_factor_ = earlier_factor_ = factor_;
    marked_ns_ = stamp_ns;
  } else if (stamp_ns - marked_ns_ > kTouchdownNs) {
    earlier_factor_ = recent_factor_;
    recent_factor_ = factor_;
    marked_ns_ = stamp_ns;
  }
}

void ThrustScale::learn(double thrust_n, double specific_force_up, bool flying, std::int64_t stamp_ns) {
  const double dt_s = static_cast<double>(stamp_ns - last_stamp_ns_) * 1e-9;
  last_stamp_ns_ = stamp_ns;
  note_flight(flying, stamp_ns);
  const double measured_n = vehicle_.mass_kg * specific_force_up;
  if (!(dt_s > 0.0) || dt_s > kLongestStep_s || !flying || !std::isfinite(measured_n)) {
    steady_s_ = 0.0;
    lagged_n_ = thrust_n;
    return;
  }
  lagged_n_ += (thrust_n - lagged_n_) * std::min(dt_s / (vehicle_.motor.time_constant_s + dt_s), 1.0);
  if (!is_near(thrust_n, weight_n_) || !is_near(lagged_n_, weight_n_)) {
    steady_s_ = 0.0;
    return;
  }
  steady_s_ += dt_s;
  if (steady_s_ < kSettling_s) return;
  // A measured thrust far below the commanded one asks for more throttle at a bounded rate.
  const double ratio = std::clamp(lagged_n_ / std::max(measured_n, 0.2 * weight_n_), 0.5, 2.0);
  factor_ = std::clamp(factor_ * (1.0 + (ratio - 1.0) * dt_s / kLearning_s), kLeastFactor, kGreatestFactor);
}

}  // namespace swiftlet::px4
