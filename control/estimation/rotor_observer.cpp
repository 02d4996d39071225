#include "swiftlet/control/estimation/rotor_observer.hpp"

#include <cmath>

#include "swiftlet/plant/model/esc.hpp"

namespace swiftlet::control {
namespace {

constexpr double kCorrection = 0.2;  // share of the difference that a measured speed takes away

}  // namespace

RotorObserver::RotorObserver(const plant::Vehicle& vehicle)
    : esc_(vehicle.esc), motor_(vehicle.motor), count_(vehicle.rotor_count()) {
  wrench_per_square_.setZero();
  wrench_per_square_.leftCols(count_) = vehicle.rotor.thrust * plant::effectiveness(vehicle);  // Eq. (25)
}

void RotorObserver::step(double dt_s, const plant::ActuatorCommand& command, double supply_voltage_v) {
  if (dt_s != kept_for_s_) {
    kept_for_s_ = dt_s;
    kept_ = std::exp(-dt_s / motor_.time_constant_s);
  }
  if (command.rotor_state != plant::RotorState::kRunning) {
    for (double& speed : speeds_) speed *= kept_;
    update_wrench<plant::kMaxRotors>();
  } else if (count_ == plant::kMinRotors) {
    run_on<plant::kMinRotors>(command, supply_voltage_v);
  } else {
    run_on<plant::kMaxRotors>(command, supply_voltage_v);
  }
}

// kCount: of the values that are worked out side by side; those beyond count_ are of no rotor.
template <int kCount>
void RotorObserver::run_on(const plant::ActuatorCommand& command, double supply_voltage_v) {
  using Values = Eigen::Array<double, kCount, 1>;
  const Values v_a = plant::motor_voltages(esc_, supply_voltage_v, Values(command.throttle.data()));
  const Values steady = plant::steady_speeds_from_voltages(motor_, v_a);
  Eigen::Map<Values> speeds(speeds_.data());
  speeds = steady + kept_ * (speeds - steady);
  if constexpr (kCount > plant::kMinRotors) speeds.tail(kCount - count_).setZero();
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
  update_wrench<plant::kMaxRotors>();
}

template <int kCount>
void RotorObserver::update_wrench() {
  const Eigen::Map<const Eigen::Array<double, kCount, 1>> speeds(speeds_.data());
  wrench_.noalias() = wrench_per_square_.leftCols<kCount>() * speeds.square().matrix();
}

}  // namespace swiftlet::control
