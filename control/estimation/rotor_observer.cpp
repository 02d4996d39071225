#include "control/estimation/rotor_observer.hpp"

#include <cmath>

#include "plant/model/esc.hpp"
#include "plant/model/rotor.hpp"

namespace swiftlet::control {
namespace {

constexpr double kCorrection = 0.2;  // share of the difference that a measured speed takes away

}  // namespace

RotorObserver::RotorObserver(const plant::Vehicle& vehicle)
    : esc_(vehicle.esc),
      motor_(vehicle.motor),
      rotor_(vehicle.rotor),
      effectiveness_(plant::effectiveness(vehicle)),
      count_(vehicle.rotor_count()) {}

void RotorObserver::step(double dt_s, const plant::ActuatorCommand& command, double supply_voltage_v) {
  if (dt_s != kept_for_s_) {
    kept_for_s_ = dt_s;
    kept_ = std::exp(-dt_s / motor_.time_constant_s);
  }
  if (command.rotor_state != plant::RotorState::kRunning) {
    for (double& speed : speeds_) speed *= kept_;
    update_wrench<0>();
  } else if (count_ == 4) {
    run_on<4>(command, supply_voltage_v);
  } else {
    run_on<0>(command, supply_voltage_v);
  }
}

// kCount: of the rotors, known to the compiler; 0: count_.
template <int kCount>
void RotorObserver::run_on(const plant::ActuatorCommand& command, double supply_voltage_v) {
  const int count = kCount > 0 ? kCount : count_;
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double v_a = plant::motor_voltage(esc_, supply_voltage_v, command.throttle[n]);
    const double steady = plant::steady_speed_from_voltage(motor_, v_a);
    speeds_[n] = steady + kept_ * (speeds_[n] - steady);
  }
  update_wrench<kCount>();
}

void RotorObserver::correct(const plant::RotorSpeedSample& sample) {
  if (sample.rotor_count != count_) return;
  for (int i = 0; i < count_; ++i) {
    const double speed = sample.speeds[static_cast<std::size_t>(i)];
    if (!std::isfinite(speed) || speed < 0.0) return;
  }
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i);
    speeds_[n] += kCorrection * (sample.speeds[n] - speeds_[n]);
  }
  update_wrench<0>();
}

template <int kCount>
void RotorObserver::update_wrench() {
  const int count = kCount > 0 ? kCount : count_;
  wrench_.setZero();
  for (int i = 0; i < count; ++i) {
    wrench_ += plant::thrust_from_speed(rotor_, speeds_[static_cast<std::size_t>(i)]) * effectiveness_.col(i);
  }
}

}  // namespace swiftlet::control
