#include "swiftlet/plant/simulation/dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/esc.hpp"

namespace swiftlet::plant {

namespace {

constexpr double kStepPerTimeConstant = 1.0 / 3.0;

double square(double x) { return x * x; }

}  // namespace

// What battery and rotors do, for kRotors rotors, with what is constant over a step worked out. They do not
// feel how the body moves.
template <int kRotors, MotorForm kMotor>
struct Dynamics::Drivetrain {
  static constexpr std::size_t kPairs = (kRotors + 1) / 2;
  using Rotors = std::array<Pair, kPairs>;
  struct State {
    double charge;
    double sag;
    double voltage;  // at the terminals: follows from charge and sag, but all of the next stage waits for it
    Rotors speeds;
    Rotors currents;  // with inductance
  };

  const Dynamics& d;
  OpenCircuit open_circuit;
  // Eq. (9): v_a^2 = v_a_gain v_s^2 + v_a_offset; a rotor that is off gets no voltage at all, nor does what
  // stands beside the last of an odd number.
  Rotors v_a_gain;
  Rotors v_a_offset;
  double voltage_per_current;  // V/(A s)

  Drivetrain(const Dynamics& dynamics, const RotorDrive& drive, const OpenCircuit& open_circuit_voltage)
      : d(dynamics), open_circuit(open_circuit_voltage) {
    const bool running = drive.state == RotorState::kRunning;
    const double gain = running ? d.esc_.gain : 0.0;
    const double offset = running ? d.esc_.offset_v2 : 0.0;
    for (std::size_t i = 0; i < kPairs; ++i) {
      const Pair exists(1.0, 2 * i + 1 < kRotors ? 1.0 : 0.0);
      v_a_gain[i] = gain * exists * pair(&drive.throttle[2 * i]);
      v_a_offset[i] = offset * exists;
    }
    voltage_per_current =
        open_circuit.slope * d.charge_per_current_ - d.battery_.internal_resistance_ohm * d.inverse_sag_time_;
  }

  State pack(const VehicleState& from) const {
    State y;
    y.charge = from.state_of_charge;
    y.sag = from.sag_v;
    y.voltage = open_circuit.voltage(y.charge) - y.sag;
    for (std::size_t i = 0; i < kPairs; ++i) {
      y.speeds[i] = pair(&from.rotor_speeds[2 * i]);
      if constexpr (kMotor == MotorForm::kInductive) y.currents[i] = pair(&from.armature_currents[2 * i]);
    }
    return y;
  }

  static void unpack(const State& y, VehicleState& to) {
    to.state_of_charge = std::max(y.charge, 0.0);
    to.sag_v = y.sag;
    for (std::size_t i = 0; i < kPairs; ++i) {
      store(y.speeds[i], &to.rotor_speeds[2 * i]);
      if constexpr (kMotor == MotorForm::kInductive) store(y.currents[i], &to.armature_currents[2 * i]);
    }
  }

  // y + h k
  [[gnu::always_inline]] static State moved(const State& y, double h, const State& k) {
    State out;
    out.charge = y.charge + h * k.charge;
    out.sag = y.sag + h * k.sag;
    out.voltage = y.voltage + h * k.voltage;
    for (std::size_t i = 0; i < kPairs; ++i) {
      out.speeds[i] = y.speeds[i] + h * k.speeds[i];
      if constexpr (kMotor == MotorForm::kInductive) out.currents[i] = y.currents[i] + h * k.currents[i];
    }
    return out;
  }

  // Eq. (9)-(22), all rotors side by side.
  [[gnu::always_inline]] State derivative(const State& y) const {
    State dy;
    const double v_s = std::max(y.voltage, 0.0);
    const double inverse_v_s = v_s > 0.0 ? 1.0 / v_s : 0.0;
    const double v_s_squared = v_s * v_s;
    Pair power = Pair::Zero();
    for (std::size_t i = 0; i < kPairs; ++i) {
      const Pair speed = y.speeds[i];
      const Pair v_a = (v_a_gain[i] * v_s_squared + v_a_offset[i]).max(0.0).sqrt();
      Pair current = (v_a - d.motor_.torque_constant * speed) * d.motor_.inverse_resistance;
      if constexpr (kMotor == MotorForm::kInductive) {
        dy.currents[i] = (current - y.currents[i]) * d.inverse_electrical_time_;
        current = y.currents[i];
      }
      if constexpr (kMotor == MotorForm::kReduced) {
        const Pair steady = (d.steady_square_ + d.steady_gain_ * v_a).sqrt() - d.steady_offset_;
        dy.speeds[i] = (steady - speed) * d.motor_.inverse_time_constant;
      } else {
        dy.speeds[i] = {speed_rate_from_current(d.motor_, current[0], speed[0]),
                        speed_rate_from_current(d.motor_, current[1], speed[1])};
      }
      power += (v_a * current).max(0.0);
    }

    // The ESCs pass on all the power that they draw, as in esc_supply_current().
    const double idle = d.battery_.electronics_current_a;
    const double total_power = power[0] + power[1];
    const double drawn = idle + total_power * inverse_v_s;
    dy.charge = drawn * d.charge_per_current_;
    dy.sag = (d.battery_.internal_resistance_ohm * drawn - y.sag) * d.inverse_sag_time_;
    dy.voltage = total_power * (inverse_v_s * voltage_per_current) +
                 (idle * voltage_per_current + y.sag * d.inverse_sag_time_);
    return dy;
  }

  // Eq. (25)-(28)
  [[gnu::always_inline]] Wrench wrench(const State& y) const {
    Wrench sum = d.push_;
    for (std::size_t i = 0; i < kRotors; ++i) {
      const double speed_squared = square(y.speeds[i / 2][i % 2]);
      sum.lift_roll += d.wrenches_[i].lift_roll * speed_squared;
      sum.pitch_yaw += d.wrenches_[i].pitch_yaw * speed_squared;
    }
    return sum;
  }
};

// How the body moves under what the rotors give.
struct Dynamics::RigidBody {
  struct State {
    Triple position_ned;
    Triple velocity_ned;
    Pair q_xy;
    Pair q_zw;
    Triple rates_frd;
  };

  const Dynamics& d;
  Triple drift;  // gravity, a push and the wind's part of the drag, m/s^2

  RigidBody(const Dynamics& dynamics, const Eigen::Vector3d& wind_ned)
      : d(dynamics),
        drift{d.drag_over_mass_ * Pair(wind_ned.head<2>()) + d.push_acceleration_ned_.head<2>().array(),
              d.drag_over_mass_ * wind_ned.z() + d.push_acceleration_ned_.z() + kGravity} {}

  static State pack(const VehicleState& from) {
    const Eigen::Quaterniond& q = from.q_ned_from_frd;
    return {triple(from.position_ned),
            triple(from.velocity_ned),
            {q.x(), q.y()},
            {q.z(), q.w()},
            triple(from.body_rates_frd)};
  }

  static void unpack(const State& y, VehicleState& to) {
    to.position_ned = vector(y.position_ned);
    to.velocity_ned = vector(y.velocity_ned);
    to.body_rates_frd = vector(y.rates_frd);
    const double scale = 1.0 / std::sqrt((y.q_xy * y.q_xy + y.q_zw * y.q_zw).sum());
    to.q_ned_from_frd =
        Eigen::Quaterniond(y.q_zw[1] * scale, y.q_xy[0] * scale, y.q_xy[1] * scale, y.q_zw[0] * scale);
  }

  // y + h k
  [[gnu::always_inline]] static State moved(const State& y, double h, const State& k) {
    return {plant::moved(y.position_ned, h, k.position_ned), plant::moved(y.velocity_ned, h, k.velocity_ned),
            y.q_xy + h * k.q_xy, y.q_zw + h * k.q_zw, plant::moved(y.rates_frd, h, k.rates_frd)};
  }

  [[gnu::always_inline]] State derivative(const State& y, const Wrench& wrench) const {
    State dy;
    // Eq. (1), (5)
    dy.position_ned = y.velocity_ned;
    const double q_z = y.q_zw[0];
    const double q_w = y.q_zw[1];
    const double lift = wrench.lift_roll[0];
    const Pair z_axis_xy = 2.0 * (q_z * y.q_xy + q_w * clockwise(y.q_xy));
    const Pair squares = y.q_zw * y.q_zw - y.q_xy * y.q_xy;
    dy.velocity_ned.xy = drift.xy - d.drag_over_mass_ * y.velocity_ned.xy - lift * z_axis_xy;
    dy.velocity_ned.z = drift.z - d.drag_over_mass_ * y.velocity_ned.z - lift * (squares[0] + squares[1]);

    // dq/dt = q (0, w) / 2
    const Pair rates_xy = y.rates_frd.xy;
    const double p = rates_xy[0];
    const double q = rates_xy[1];
    const double r = y.rates_frd.z;
    dy.q_xy = 0.5 * (q_w * rates_xy - q_z * clockwise(rates_xy) + r * clockwise(y.q_xy));
    dy.q_zw = 0.5 * (y.q_xy[0] * Pair(q, -p) - y.q_xy[1] * rates_xy - r * Pair(-q_w, q_z));

    // Eq. (6): dw/dt = J^-1 (M - w x J w)
    const Triple h = product(d.inertia_, y.rates_frd);
    const Pair m_xy(wrench.lift_roll[1], wrench.pitch_yaw[0]);
    const double m_z = wrench.pitch_yaw[1] - (p * h.xy[1] - q * h.xy[0]);
    dy.rates_frd = product(d.inverse_inertia_, {m_xy - h.z * clockwise(rates_xy) + r * clockwise(h.xy), m_z});
    return dy;
  }
};

Dynamics::Dynamics(const Vehicle& vehicle, const Supply& supply, Instructions instructions)
    : rotor_count_(vehicle.rotor_count()),
      max_step_s_(kStepPerTimeConstant * vehicle.motor.time_constant_s),
      inverse_mass_(1.0 / vehicle.mass_kg),
      drag_over_mass_(vehicle.linear_drag * inverse_mass_),
      inertia_(symmetric(vehicle.inertia)),
      inverse_inertia_(symmetric(vehicle.inertia.inverse())),
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
    sound_wrenches_[i] = {
        {vehicle.rotor.thrust * inverse_mass_, -mount.position_frd.y() * vehicle.rotor.thrust},
        {mount.position_frd.x() * vehicle.rotor.thrust, yaw}};
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
    advance_ = choose<MotorForm::kInductive>(rotor_count_, instructions);
  } else if (motor.model == MotorModel::kPhysical) {
    advance_ = choose<MotorForm::kPhysical>(rotor_count_, instructions);
  } else {
    advance_ = choose<MotorForm::kReduced>(rotor_count_, instructions);
  }
}

template <int kRotors, MotorForm kMotor>
Dynamics::Advance Dynamics::choose(Instructions instructions) {
#ifdef __x86_64__
  if (instructions == Instructions::kBest && __builtin_cpu_supports("avx"))
    return &Dynamics::advance_by_avx<kRotors, kMotor>;
#endif
  return &Dynamics::advance_as<kRotors, kMotor>;
}

template <MotorForm kMotor>
Dynamics::Advance Dynamics::choose(int rotor_count, Instructions instructions) {
  static_assert(kMinRotors == 4 && kMaxRotors == 8);
  switch (rotor_count) {
    case 5:
      return choose<5, kMotor>(instructions);
    case 6:
      return choose<6, kMotor>(instructions);
    case 7:
      return choose<7, kMotor>(instructions);
    case 8:
      return choose<8, kMotor>(instructions);
    default:
      return choose<4, kMotor>(instructions);
  }
}

void Dynamics::advance(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                       double dt) const {
  (this->*advance_)(state, drive, wind_ned, dt);
}

// The classical Runge-Kutta step of both systems as one, its stages as a loop: the code stays small, so that
// plant and controller fit into the processor's first cache together.
template <int kRotors, MotorForm kMotor>
[[gnu::always_inline]] inline void Dynamics::runge_kutta(VehicleState& state, const RotorDrive& drive,
                                                         const Eigen::Vector3d& wind_ned, double dt) const {
  using Rotors = Drivetrain<kRotors, kMotor>;
  const Rotors rotors(*this, drive, open_circuit(state.state_of_charge));
  const RigidBody body(*this, wind_ned);
  const int count = dt <= max_step_s_ ? 1 : static_cast<int>(std::ceil(dt / max_step_s_));
  const double h = dt / count;
  const std::array<double, 4> ahead = {0.5 * h, 0.5 * h, h, 0.0};  // to where the next stage looks
  const std::array<double, 4> weight = {h / 6.0, h / 3.0, h / 3.0, h / 6.0};
  typename Rotors::State x = rotors.pack(state);
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
      x_end = Rotors::moved(x_end, weight[stage], x_rate);
      y_end = RigidBody::moved(y_end, weight[stage], y_rate);
      x_stage = Rotors::moved(x, ahead[stage], x_rate);
      y_stage = RigidBody::moved(y, ahead[stage], y_rate);
    }
    x = x_end;
    y = y_end;
  }
  Rotors::unpack(x, state);
  RigidBody::unpack(y, state);
}

template <int kRotors, MotorForm kMotor>
void Dynamics::advance_as(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                          double dt) const {
  runge_kutta<kRotors, kMotor>(state, drive, wind_ned, dt);
}

#ifdef __x86_64__
// Instructions with three operands: fewer of them.
template <int kRotors, MotorForm kMotor>
[[gnu::target("avx")]] void Dynamics::advance_by_avx(VehicleState& state, const RotorDrive& drive,
                                                     const Eigen::Vector3d& wind_ned, double dt) const {
  runge_kutta<kRotors, kMotor>(state, drive, wind_ned, dt);
}
#endif

void Dynamics::disturb(const Disturbance& disturbance) {
  push_acceleration_ned_ = inverse_mass_ * disturbance.force_ned;
  push_ = {{0.0, disturbance.moment_frd.x()}, {disturbance.moment_frd.y(), disturbance.moment_frd.z()}};
  supply_drop_v_ = disturbance.supply_drop_v;
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    const double factor = disturbance.rotor_factors[i];
    wrenches_[i] = {factor * sound_wrenches_[i].lift_roll, factor * sound_wrenches_[i].pitch_yaw};
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
    lift += wrenches_[i].lift_roll[0] * square(state.rotor_speeds[i]);
  Eigen::Vector3d thrust(0.0, 0.0, -lift);
  if (drag_over_mass_ == 0.0 && push_acceleration_ned_.isZero(0.0)) return thrust;
  const Eigen::Vector3d drag = drag_over_mass_ * (state.velocity_ned - wind_ned) - push_acceleration_ned_;
  return thrust - state.q_ned_from_frd.conjugate() * drag;
}

}  // namespace swiftlet::plant
