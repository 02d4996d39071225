#include "swiftlet/identification/bench/bench_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::array<double, 5> kSupplies = {4.190 / 4.19, 4.040 / 4.19, 3.906 / 4.19, 3.809 / 4.19,
                                             3.637 / 4.19};  // of Fig. 2, over full charge
constexpr int kThrottles = 9;                                // 0.1 .. 0.9
constexpr int kSpeeds = 40;
constexpr double kSampleS = 1e-3;  // s, sample period of the step
constexpr int kStepsPerSample = 20;
constexpr double kRestS = 0.1;          // s, before the step
constexpr double kTimeConstants = 6.0;  // length of the record after the step
constexpr int kWeighings = 8;
constexpr std::array<double, 3> kStringLengths = {0.6, 0.9, 1.2};  // m
constexpr int kSwings = 4;                                         // with each length

// One random stream for each experiment: the noise of one does not depend on the others.
enum Stream : std::uint64_t {
  kMass = 1,
  kEsc,
  kThrustTorque,
  kSteadyMotor,
  kMotorStep,
  kThrottleThrust,
  kInertia
};

class Reader {
 public:
  Reader(const BenchNoise& noise, std::uint64_t seed, std::uint64_t stream)
      : noise_(noise), random_(seed, stream) {}

  // Adds noise relative to the full scale of the column.
  void read(std::vector<double>& column) {
    const double full = *std::max_element(column.begin(), column.end());
    for (double& value : column) value += noise_.share * full * random_.normal();
  }
  // Adds noise relative to each value.
  void read_relative(std::vector<double>& column) {
    for (double& value : column) value *= 1.0 + noise_.share * random_.normal();
  }
  // Turns some rows of a column into outliers.
  void spoil(std::vector<double>& column) {
    const double full = *std::max_element(column.begin(), column.end());
    for (double& value : column) {
      if (random_.uniform() >= noise_.outliers) continue;
      const double off = full * random_.uniform(0.2, 0.6);
      value = value > 0.5 * full ? value - off : value + off;
    }
  }

 private:
  const BenchNoise& noise_;
  math::RandomStream random_;
};

EscData esc_data(const plant::Vehicle& vehicle, Reader reader) {
  EscData out;
  for (const double share : kSupplies) {
    for (int i = 1; i <= kThrottles; ++i) {
      const double supply = share * vehicle.battery.open_circuit_voltage_v.back();
      out.supply_voltage_v.push_back(supply);
      out.throttle.push_back(0.1 * i);
      out.motor_voltage_v.push_back(plant::motor_voltage(vehicle.esc, supply, out.throttle.back()));
    }
  }
  reader.read(out.supply_voltage_v);
  reader.read(out.motor_voltage_v);
  reader.spoil(out.motor_voltage_v);
  return out;
}

double full_voltage(const plant::Vehicle& vehicle) {
  return plant::motor_voltage(vehicle.esc, vehicle.battery.open_circuit_voltage_v.back(), 1.0);
}

SteadyMotorData steady_motor_data(const plant::Vehicle& vehicle, Reader reader) {
  SteadyMotorData out;
  for (int i = 0; i < kSpeeds; ++i) {
    out.motor_voltage_v.push_back(full_voltage(vehicle) * (0.1 + 0.9 * i / (kSpeeds - 1)));
    out.speed_rad_s.push_back(plant::steady_speed_from_voltage(vehicle.motor, out.motor_voltage_v.back()));
  }
  reader.read(out.motor_voltage_v);
  reader.read(out.speed_rad_s);
  reader.spoil(out.speed_rad_s);
  return out;
}

ThrustTorqueData thrust_torque_data(const plant::Vehicle& vehicle, Reader reader) {
  ThrustTorqueData out;
  const double top = plant::steady_speed_from_voltage(vehicle.motor, full_voltage(vehicle));
  for (int i = 0; i < kSpeeds; ++i) {
    const double speed = top * (0.25 + 0.75 * i / (kSpeeds - 1));
    out.speed_rad_s.push_back(speed);
    out.thrust_n.push_back(plant::thrust_from_speed(vehicle.rotor, speed));
    out.torque_n_m.push_back(plant::torque_from_speed(vehicle.rotor, speed));
  }
  reader.read(out.speed_rad_s);
  reader.read(out.thrust_n);
  reader.read(out.torque_n_m);
  reader.spoil(out.thrust_n);
  reader.spoil(out.torque_n_m);
  return out;
}

// State of one motor: speed, rad/s, and current, A, if the motor model has it as a state.
struct Shaft {
  double speed = 0.0;
  double current = 0.0;
};

Shaft rate(const plant::MotorDynamics& dynamics, double voltage, const Shaft& now) {
  if (!dynamics.has_current_state())
    return {plant::speed_rate_from_voltage(dynamics, voltage, now.speed), 0.0};
  return {plant::speed_rate_from_current(dynamics, now.current, now.speed),
          plant::motor_current_rate(dynamics, voltage, now.current, now.speed)};
}

// Advances the state by dt with the classical Runge-Kutta method of order 4.
Shaft advanced(const plant::MotorDynamics& dynamics, double voltage, const Shaft& now, double dt) {
  const auto moved = [&](const Shaft& by, double time) {
    return Shaft{now.speed + time * by.speed, now.current + time * by.current};
  };
  const Shaft k1 = rate(dynamics, voltage, now);
  const Shaft k2 = rate(dynamics, voltage, moved(k1, 0.5 * dt));
  const Shaft k3 = rate(dynamics, voltage, moved(k2, 0.5 * dt));
  const Shaft k4 = rate(dynamics, voltage, moved(k3, dt));
  return {now.speed + dt / 6.0 * (k1.speed + 2.0 * k2.speed + 2.0 * k3.speed + k4.speed),
          now.current + dt / 6.0 * (k1.current + 2.0 * k2.current + 2.0 * k3.current + k4.current)};
}

MotorStepData motor_step_data(const plant::Vehicle& vehicle, Reader reader) {
  const plant::MotorDynamics dynamics = plant::motor_dynamics(vehicle);
  const double voltage = plant::voltage_from_steady_speed(vehicle.motor, plant::hover_speed(vehicle));
  const auto rest = static_cast<int>(std::lround(kRestS / kSampleS));
  const auto moving = static_cast<int>(std::ceil(kTimeConstants * vehicle.motor.time_constant_s / kSampleS));
  // Where the current is a state, its time constant limits the integration step.
  const double electrical = vehicle.motor.armature_inductance_h / vehicle.motor.armature_resistance_ohm;
  const int steps = dynamics.has_current_state()
                        ? std::max(kStepsPerSample, static_cast<int>(std::ceil(2.0 * kSampleS / electrical)))
                        : kStepsPerSample;
  MotorStepData out;
  Shaft shaft;
  for (int i = 0; i < rest + moving; ++i) {
    out.time_s.push_back(i * kSampleS);
    out.motor_voltage_v.push_back(i < rest ? 0.0 : voltage);
    out.speed_rad_s.push_back(shaft.speed);
    if (i < rest) continue;
    for (int step = 0; step < steps; ++step) shaft = advanced(dynamics, voltage, shaft, kSampleS / steps);
  }
  reader.read(out.motor_voltage_v);
  reader.read(out.speed_rad_s);
  reader.spoil(out.speed_rad_s);
  return out;
}

ThrottleThrustData throttle_thrust_data(const plant::Vehicle& vehicle, Reader reader) {
  ThrottleThrustData out;
  for (const double share : kSupplies) {
    for (int i = 1; i <= kThrottles; ++i) {
      const double supply = share * vehicle.battery.open_circuit_voltage_v.back();
      out.supply_voltage_v.push_back(supply);
      out.throttle.push_back(0.1 * i);
      out.thrust_n.push_back(plant::steady_thrust_from_throttle(vehicle, supply, out.throttle.back()));
    }
  }
  reader.read(out.supply_voltage_v);
  reader.read(out.thrust_n);
  reader.spoil(out.thrust_n);
  return out;
}

BifilarData bifilar_data(const plant::Vehicle& vehicle, double inertia, Reader reader) {
  BifilarData out;
  const double separation = 2.0 * plant::hub_distance(vehicle);
  for (const double length : kStringLengths) {
    for (int i = 0; i < kSwings; ++i) {
      out.length_m.push_back(length);
      out.separation_m.push_back(separation);
      out.period_s.push_back(4.0 * M_PI / separation *
                             std::sqrt(inertia * length / (vehicle.mass_kg * plant::kGravity)));
    }
  }
  reader.read_relative(out.period_s);
  reader.spoil(out.period_s);
  return out;
}

}  // namespace

BenchData simulate_bench(const plant::Vehicle& vehicle, const BenchNoise& noise, std::uint64_t seed) {
  const auto reader = [&](std::uint64_t stream) { return Reader(noise, seed, stream); };
  BenchData out;
  out.mass_kg = std::vector<double>(kWeighings, vehicle.mass_kg);
  reader(kMass).read_relative(*out.mass_kg);
  out.esc = esc_data(vehicle, reader(kEsc));
  out.thrust_torque = thrust_torque_data(vehicle, reader(kThrustTorque));
  out.steady_motor = steady_motor_data(vehicle, reader(kSteadyMotor));
  out.motor_step = motor_step_data(vehicle, reader(kMotorStep));
  out.throttle_thrust = throttle_thrust_data(vehicle, reader(kThrottleThrust));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    out.inertia[axis] =
        InertiaData{bifilar_data(vehicle, vehicle.inertia(i, i), reader(kInertia + axis)), {}};
  }
  return out;
}

}  // namespace swiftlet::identification
