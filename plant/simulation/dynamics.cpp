#include "plant/simulation/dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "plant/model/battery.hpp"
#include "plant/model/esc.hpp"

namespace swiftlet::plant {

namespace {

constexpr double kStepPerTimeConstant = 1.0 / 3.0;

double square(double x) { return x * x; }

// y + h k
template <std::size_t kSize>
[[gnu::always_inline]] inline std::array<double, kSize> moved(const std::array<double, kSize>& y, double h,
                                                              const std::array<double, kSize>& k) {
  std::array<double, kSize> out;
  for (std::size_t i = 0; i < kSize; ++i) out[i] = y[i] + h * k[i];
  return out;
}

}  // namespace

// What battery and rotors do, for kRotors rotors, with what is constant over a step worked out. They do not
// feel how the body moves.
template <int kRotors, MotorForm kMotor>
struct Dynamics::Drivetrain {
  static constexpr std::size_t kN = kRotors;
  static constexpr std::size_t kCharge = 0;
  static constexpr std::size_t kSag = 1;
  static constexpr std::size_t kSpeeds = 2;
  static constexpr std::size_t kCurrents = kSpeeds + kN;
  static constexpr std::size_t kSize = kSpeeds + (kMotor == MotorForm::kInductive ? 2 : 1) * kN;

  // Plain doubles: with an optimiser at -O2 Eigen's small fixed-size arrays take twice the time.
  using State = std::array<double, kSize>;

  const Dynamics& d;
  OpenCircuit open_circuit;
  // Eq. (9): v_a^2 = v_a_gain v_s^2 + v_a_offset; a rotor that is off gets no voltage at all.
  std::array<double, kN> v_a_gain{};
  double v_a_offset = 0.0;

  Drivetrain(const Dynamics& dynamics, const RotorDrive& drive, const OpenCircuit& open_circuit_voltage)
      : d(dynamics), open_circuit(open_circuit_voltage) {
    if (drive.state != RotorState::kRunning) return;
    for (std::size_t i = 0; i < kN; ++i) v_a_gain[i] = d.esc_.gain * drive.throttle[i];
    v_a_offset = d.esc_.offset_v2;
  }

  static State pack(const VehicleState& from) {
    State y;
    y[kCharge] = from.state_of_charge;
    y[kSag] = from.sag_v;
    for (std::size_t i = 0; i < kN; ++i) y[kSpeeds + i] = from.rotor_speeds[i];
    if constexpr (kMotor == MotorForm::kInductive) {
      for (std::size_t i = 0; i < kN; ++i) y[kCurrents + i] = from.armature_currents[i];
    }
    return y;
  }

  static void unpack(const State& y, VehicleState& to) {
    to.state_of_charge = std::max(y[kCharge], 0.0);
    to.sag_v = y[kSag];
    for (std::size_t i = 0; i < kN; ++i) to.rotor_speeds[i] = y[kSpeeds + i];
    if constexpr (kMotor == MotorForm::kInductive) {
      for (std::size_t i = 0; i < kN; ++i) to.armature_currents[i] = y[kCurrents + i];
    }
  }

  // Eq. (9)-(22), all rotors side by side.
  [[gnu::always_inline]] State derivative(const State& y) const {
    State dy;
    const double v_s = std::max(open_circuit.voltage(y[kCharge]) - y[kSag], 0.0);
    const double inverse_v_s = v_s > 0.0 ? 1.0 / v_s : 0.0;
    const double v_s_squared = v_s * v_s;
    double power = 0.0;
    std::array<double, kN> powers;
    for (std::size_t i = 0; i < kN; ++i) {
      const double speed = y[kSpeeds + i];
      const double v_a = std::sqrt(std::max(v_a_gain[i] * v_s_squared + v_a_offset, 0.0));
      double current = (v_a - d.motor_.torque_constant * speed) * d.motor_.inverse_resistance;
      if constexpr (kMotor == MotorForm::kInductive) {
        dy[kCurrents + i] = (current - y[kCurrents + i]) * d.inverse_electrical_time_;
        current = y[kCurrents + i];
      }
      if constexpr (kMotor == MotorForm::kReduced) {
        const double steady = std::sqrt(d.steady_square_ + d.steady_gain_ * v_a) - d.steady_offset_;
        dy[kSpeeds + i] = (steady - speed) * d.motor_.inverse_time_constant;
      } else {
        dy[kSpeeds + i] = speed_rate_from_current(d.motor_, current, speed);
      }
      powers[i] = std::max(v_a * current, 0.0);
    }
    for (std::size_t i = 0; i < kN; ++i) power += powers[i];

    // The ESCs pass on all the power that they draw, as in esc_supply_current().
    const double drawn = d.battery_.electronics_current_a + power * inverse_v_s;
    dy[kCharge] = drawn * d.charge_per_current_;
    dy[kSag] = (d.battery_.internal_resistance_ohm * drawn - y[kSag]) * d.inverse_sag_time_;
    return dy;
  }

  // Eq. (25)-(28)
  [[gnu::always_inline]] Wrench wrench(const State& y) const {
    Wrench sum{0.0, d.push_moment_frd_.x(), d.push_moment_frd_.y(), d.push_moment_frd_.z()};
    for (std::size_t i = 0; i < kN; ++i) {
      const double speed_squared = square(y[kSpeeds + i]);
      sum.lift += d.wrenches_[i].lift * speed_squared;
      sum.roll += d.wrenches_[i].roll * speed_squared;
      sum.pitch += d.wrenches_[i].pitch * speed_squared;
      sum.yaw += d.wrenches_[i].yaw * speed_squared;
    }
    return sum;
  }
};

// How the body moves under what the rotors give.
struct Dynamics::RigidBody {
  static constexpr std::size_t kPosition = 0;
  static constexpr std::size_t kVelocity = 3;
  static constexpr std::size_t kQuaternion = 6;  // w, x, y, z
  static constexpr std::size_t kRates = 10;
  static constexpr std::size_t kSize = 13;
  using State = std::array<double, kSize>;

  const Dynamics& d;
  std::array<double, 3> drift;  // gravity, a push and the wind's part of the drag, m/s^2

  RigidBody(const Dynamics& dynamics, const Eigen::Vector3d& wind_ned)
      : d(dynamics),
        drift{d.drag_over_mass_ * wind_ned.x() + d.push_acceleration_ned_.x(),
              d.drag_over_mass_ * wind_ned.y() + d.push_acceleration_ned_.y(),
              d.drag_over_mass_ * wind_ned.z() + d.push_acceleration_ned_.z() + kGravity} {}

  static State pack(const VehicleState& from) {
    State y;
    for (int i = 0; i < 3; ++i) {
      const auto j = static_cast<std::size_t>(i);
      y[kPosition + j] = from.position_ned[i];
      y[kVelocity + j] = from.velocity_ned[i];
      y[kRates + j] = from.body_rates_frd[i];
    }
    y[kQuaternion] = from.q_ned_from_frd.w();
    y[kQuaternion + 1] = from.q_ned_from_frd.x();
    y[kQuaternion + 2] = from.q_ned_from_frd.y();
    y[kQuaternion + 3] = from.q_ned_from_frd.z();
    return y;
  }

  static void unpack(const State& y, VehicleState& to) {
    for (int i = 0; i < 3; ++i) {
      const auto j = static_cast<std::size_t>(i);
      to.position_ned[i] = y[kPosition + j];
      to.velocity_ned[i] = y[kVelocity + j];
      to.body_rates_frd[i] = y[kRates + j];
    }
    const double scale = 1.0 / std::sqrt(square(y[kQuaternion]) + square(y[kQuaternion + 1]) +
                                         square(y[kQuaternion + 2]) + square(y[kQuaternion + 3]));
    to.q_ned_from_frd = Eigen::Quaterniond(y[kQuaternion] * scale, y[kQuaternion + 1] * scale,
                                           y[kQuaternion + 2] * scale, y[kQuaternion + 3] * scale);
  }

  [[gnu::always_inline]] State derivative(const State& y, const Wrench& wrench) const {
    State dy;
    // Eq. (1), (5)
    const double q_w = y[kQuaternion];
    const double q_x = y[kQuaternion + 1];
    const double q_y = y[kQuaternion + 2];
    const double q_z = y[kQuaternion + 3];
    const double v_x = y[kVelocity];
    const double v_y = y[kVelocity + 1];
    const double v_z = y[kVelocity + 2];
    dy[kPosition] = v_x;
    dy[kPosition + 1] = v_y;
    dy[kPosition + 2] = v_z;
    dy[kVelocity] = drift[0] - d.drag_over_mass_ * v_x - wrench.lift * (2.0 * (q_x * q_z + q_w * q_y));
    dy[kVelocity + 1] = drift[1] - d.drag_over_mass_ * v_y - wrench.lift * (2.0 * (q_y * q_z - q_w * q_x));
    dy[kVelocity + 2] =
        drift[2] - d.drag_over_mass_ * v_z - wrench.lift * (q_w * q_w - q_x * q_x - q_y * q_y + q_z * q_z);

    // dq/dt = q (0, w) / 2
    const double p = y[kRates];
    const double q = y[kRates + 1];
    const double r = y[kRates + 2];
    dy[kQuaternion] = 0.5 * (-q_x * p - q_y * q - q_z * r);
    dy[kQuaternion + 1] = 0.5 * (q_w * p + q_y * r - q_z * q);
    dy[kQuaternion + 2] = 0.5 * (q_w * q + q_z * p - q_x * r);
    dy[kQuaternion + 3] = 0.5 * (q_w * r + q_x * q - q_y * p);

    // Eq. (6): dw/dt = J^-1 (M - w x J w)
    const Eigen::Matrix3d& inertia = d.inertia_;
    const Eigen::Matrix3d& inverse = d.inverse_inertia_;
    const double h_x = inertia(0, 0) * p + inertia(0, 1) * q + inertia(0, 2) * r;
    const double h_y = inertia(1, 0) * p + inertia(1, 1) * q + inertia(1, 2) * r;
    const double h_z = inertia(2, 0) * p + inertia(2, 1) * q + inertia(2, 2) * r;
    const double m_x = wrench.roll - (q * h_z - r * h_y);
    const double m_y = wrench.pitch - (r * h_x - p * h_z);
    const double m_z = wrench.yaw - (p * h_y - q * h_x);
    dy[kRates] = inverse(0, 0) * m_x + inverse(0, 1) * m_y + inverse(0, 2) * m_z;
    dy[kRates + 1] = inverse(1, 0) * m_x + inverse(1, 1) * m_y + inverse(1, 2) * m_z;
    dy[kRates + 2] = inverse(2, 0) * m_x + inverse(2, 1) * m_y + inverse(2, 2) * m_z;
    return dy;
  }
};

Dynamics::Dynamics(const Vehicle& vehicle, const Supply& supply)
    : rotor_count_(vehicle.rotor_count()),
      max_step_s_(kStepPerTimeConstant * vehicle.motor.time_constant_s),
      inverse_mass_(1.0 / vehicle.mass_kg),
      drag_over_mass_(vehicle.linear_drag * inverse_mass_),
      inertia_(vehicle.inertia),
      inverse_inertia_(vehicle.inertia.inverse()),
      esc_(vehicle.esc),
      motor_(motor_dynamics(vehicle)),
      inverse_electrical_time_(motor_.has_current_state() ? vehicle.motor.armature_resistance_ohm /
                                                                vehicle.motor.armature_inductance_h
                                                          : 0.0),
      steady_offset_(vehicle.motor.k2 / (2.0 * vehicle.motor.k3)),
      steady_square_(square(steady_offset_)),
      steady_gain_(1.0 / vehicle.motor.k3),
      ideal_supply_(supply.ideal),
      ideal_voltage_(supply.voltage_v),
      battery_(vehicle.battery),
      charge_per_current_(state_of_charge_rate(battery_, 1.0)),
      inverse_sag_time_(1.0 / battery_.sag_time_constant_s) {
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const RotorMount& mount = vehicle.rotors[i];
    const double yaw = mount.spin == Spin::kCounterClockwise ? vehicle.rotor.torque : -vehicle.rotor.torque;
    sound_wrenches_[i] = {vehicle.rotor.thrust * inverse_mass_,
                          -mount.position_frd.y() * vehicle.rotor.thrust,
                          mount.position_frd.x() * vehicle.rotor.thrust, yaw};
  }
  wrenches_ = sound_wrenches_;
  const std::vector<double>& charge = battery_.state_of_charge;
  const std::vector<double>& voltage = battery_.open_circuit_voltage_v;
  for (std::size_t i = 1; i < charge.size(); ++i) {
    const double slope = (voltage[i] - voltage[i - 1]) / (charge[i] - charge[i - 1]);
    open_circuits_.push_back({voltage[i] - slope * charge[i], slope});
  }
  if (ideal_supply_) {
    battery_.internal_resistance_ohm = 0.0;
    charge_per_current_ = 0.0;
  } else {
    max_step_s_ = std::min(max_step_s_, kStepPerTimeConstant * battery_.sag_time_constant_s);
  }
  const Motor& motor = vehicle.motor;
  if (motor_.has_current_state()) {
    const double electrical_time_s = motor.armature_inductance_h / motor.armature_resistance_ohm;
    max_step_s_ = std::min(max_step_s_, kStepPerTimeConstant * electrical_time_s);
    advance_ = choose<MotorForm::kInductive>(rotor_count_);
  } else if (motor.model == MotorModel::kPhysical) {
    advance_ = choose<MotorForm::kPhysical>(rotor_count_);
  } else {
    advance_ = choose<MotorForm::kReduced>(rotor_count_);
  }
}

template <MotorForm kMotor>
Dynamics::Advance Dynamics::choose(int rotor_count) {
  static_assert(kMinRotors == 4 && kMaxRotors == 8);
  switch (rotor_count) {
    case 5:
      return &Dynamics::advance_as<5, kMotor>;
    case 6:
      return &Dynamics::advance_as<6, kMotor>;
    case 7:
      return &Dynamics::advance_as<7, kMotor>;
    case 8:
      return &Dynamics::advance_as<8, kMotor>;
    default:
      return &Dynamics::advance_as<4, kMotor>;
  }
}

void Dynamics::advance(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                       double dt) const {
  (this->*advance_)(state, drive, wind_ned, dt);
}

// The classical Runge-Kutta step of both systems as one, its stages as a loop: the code stays small, so that
// plant and controller fit into the processor's first cache together.
template <int kRotors, MotorForm kMotor>
void Dynamics::advance_as(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                          double dt) const {
  using Rotors = Drivetrain<kRotors, kMotor>;
  const Rotors rotors(*this, drive, open_circuit(state.state_of_charge));
  const RigidBody body(*this, wind_ned);
  const int count = dt <= max_step_s_ ? 1 : static_cast<int>(std::ceil(dt / max_step_s_));
  const double h = dt / count;
  const std::array<double, 4> ahead = {0.5 * h, 0.5 * h, h, 0.0};  // to where the next stage looks
  const std::array<double, 4> weight = {h / 6.0, h / 3.0, h / 3.0, h / 6.0};
  typename Rotors::State x = Rotors::pack(state);
  RigidBody::State y = RigidBody::pack(state);
  for (int i = 0; i < count; ++i) {
    typename Rotors::State x_end = x;
    typename Rotors::State x_stage = x;
    RigidBody::State y_end = y;
    RigidBody::State y_stage = y;
    for (std::size_t stage = 0; stage < 4; ++stage) {
      const Wrench wrench = rotors.wrench(x_stage);
      const typename Rotors::State x_rate = rotors.derivative(x_stage);
      const RigidBody::State y_rate = body.derivative(y_stage, wrench);
      x_end = moved(x_end, weight[stage], x_rate);
      y_end = moved(y_end, weight[stage], y_rate);
      x_stage = moved(x, ahead[stage], x_rate);
      y_stage = moved(y, ahead[stage], y_rate);
    }
    x = x_end;
    y = y_end;
  }
  Rotors::unpack(x, state);
  RigidBody::unpack(y, state);
}

void Dynamics::disturb(const Disturbance& disturbance) {
  push_acceleration_ned_ = inverse_mass_ * disturbance.force_ned;
  push_moment_frd_ = disturbance.moment_frd;
  supply_drop_v_ = disturbance.supply_drop_v;
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    const double factor = disturbance.rotor_factors[i];
    const Wrench& sound = sound_wrenches_[i];
    wrenches_[i] = {factor * sound.lift, factor * sound.roll, factor * sound.pitch, factor * sound.yaw};
  }
}

Dynamics::OpenCircuit Dynamics::open_circuit(double state_of_charge) const {
  if (ideal_supply_) return {ideal_voltage_ - supply_drop_v_, 0.0};
  const std::vector<double>& charge = battery_.state_of_charge;
  if (state_of_charge <= charge.front())
    return {battery_.open_circuit_voltage_v.front() - supply_drop_v_, 0.0};
  std::size_t segment = open_circuits_.size() - 1;
  while (segment > 0 && state_of_charge <= charge[segment]) --segment;
  OpenCircuit line = open_circuits_[segment];
  line.at_empty -= supply_drop_v_;
  return line;
}

// Eq. (9); a rotor that is off gets no voltage at all.
double Dynamics::armature_voltage(double supply_voltage_v, const RotorDrive& drive, std::size_t rotor) const {
  return drive.state == RotorState::kRunning ? motor_voltage(esc_, supply_voltage_v, drive.throttle[rotor])
                                             : 0.0;
}

double Dynamics::supply_voltage(const VehicleState& state) const {
  return std::max(open_circuit(state.state_of_charge).voltage(state.state_of_charge) - state.sag_v, 0.0);
}

double Dynamics::supply_current(const VehicleState& state, const RotorDrive& drive) const {
  const double v_s = supply_voltage(state);
  const PerRotor currents =
      motor_.has_current_state() ? state.armature_currents : settled_currents(state, drive);
  double current = battery_.electronics_current_a;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count_); ++i) {
    current += esc_supply_current(v_s, armature_voltage(v_s, drive, i), currents[i]);
  }
  return current;
}

PerRotor Dynamics::settled_currents(const VehicleState& state, const RotorDrive& drive) const {
  const double v_s = supply_voltage(state);
  PerRotor currents{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count_); ++i) {
    currents[i] = motor_current(motor_, armature_voltage(v_s, drive, i), state.rotor_speeds[i]);
  }
  return currents;
}

Eigen::Vector3d Dynamics::specific_force_frd(const VehicleState& state,
                                             const Eigen::Vector3d& wind_ned) const {
  double lift = 0.0;
  for (std::size_t i = 0; i < wrenches_.size(); ++i)
    lift += wrenches_[i].lift * square(state.rotor_speeds[i]);
  Eigen::Vector3d thrust(0.0, 0.0, -lift);
  if (drag_over_mass_ == 0.0 && push_acceleration_ned_.isZero(0.0)) return thrust;
  const Eigen::Vector3d drag = drag_over_mass_ * (state.velocity_ned - wind_ned) - push_acceleration_ned_;
  return thrust - state.q_ned_from_frd.conjugate() * drag;
}

}  // namespace swiftlet::plant
