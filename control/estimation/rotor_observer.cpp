#include "swiftlet/control/estimation/rotor_observer.hpp"

#include <cmath>

#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::control {

RotorObserver::RotorObserver(const plant::Vehicle& vehicle, double bandwidth)
    : esc_(vehicle.esc),
      motor_(vehicle.motor),
      rotor_(vehicle.rotor),
      bandwidth_(bandwidth),
      count_(vehicle.rotor_count()) {
  wrench_per_square_.setZero();
  wrench_per_square_.leftCols(count_) = vehicle.rotor.thrust * plant::effectiveness(vehicle);  // Eq. (25)
}

// exp(-dt / tau_m), which hardly ever changes.
double RotorObserver::kept_over(double dt_s) {
  if (dt_s != kept_dt_s_) {
    kept_dt_s_ = dt_s;
    kept_ = std::exp(-dt_s / motor_.time_constant_s);
  }
  return kept_;
}

// Eq. (18) solved over dt_s for a constant steady speed: Omega_ss + exp(-dt / tau_m) (Omega - Omega_ss).
void RotorObserver::step(double dt_s, const plant::ActuatorCommand& command, double supply_voltage_v) {
  const double kept = kept_over(dt_s);
  const bool running = command.rotor_state == plant::RotorState::kRunning;
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double v_a = running ? plant::motor_voltage(esc_, supply_voltage_v, command.throttle[n]) : 0.0;
    const double steady = plant::steady_speed_from_voltage(motor_, v_a);
    speeds_[n] = steady + kept * (speeds_[n] - steady);
  }
  update_wrench();
}

void RotorObserver::step(double dt_s, double thrust_n) {
  const double kept = kept_over(dt_s);
  const double steady = plant::speed_from_thrust(rotor_, thrust_n / count_);
  for (int i = 0; i < count_; ++i) {
    double& speed = speeds_[static_cast<std::size_t>(i)];
    speed = steady + kept * (speed - steady);
  }
  update_wrench();
}

void RotorObserver::correct(const plant::RotorSpeedSample& sample) {
  if (sample.rotor_count != count_ || sample.stamp_ns <= measured_ns_) return;
  for (int i = 0; i < count_; ++i) {
    const double speed = sample.speeds[static_cast<std::size_t>(i)];
    if (!std::isfinite(speed) || speed < 0.0) return;
  }
  const double dt_s = 1e-9 * static_cast<double>(sample.stamp_ns - measured_ns_);
  const double kept = measured_ns_ == 0 ? 0.0 : std::exp(-bandwidth_ * dt_s);
  measured_ns_ = sample.stamp_ns;
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i);
    speeds_[n] = sample.speeds[n] + kept * (speeds_[n] - sample.speeds[n]);
  }
  update_wrench();
}

// Eq. (25)-(28)
void RotorObserver::update_wrench() {
  wrench_.noalias() = wrench_per_square_ * Speeds::Map(speeds_.data()).square().matrix();
}

}  // namespace swiftlet::control
