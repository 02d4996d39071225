#include "swiftlet/control/design/mismatch.hpp"

#include <algorithm>

#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::control {
namespace {

// One rotor in hover: the commanded thrust, and the change of actual thrust with it.
struct HoverPoint {
  double commanded_thrust_n = 0.0;
  double thrust_gain = 1.0;  // d thrust / d commanded thrust
};

HoverPoint hover_point(const plant::Vehicle& designed, const plant::Vehicle& flown, double supply_voltage_v) {
  const double thrust = flown.mass_kg * plant::kGravity / flown.rotor_count();
  const double speed = plant::speed_from_thrust(flown.rotor, thrust);
  const double v_a = plant::voltage_from_steady_speed(flown.motor, speed);
  const double throttle = plant::throttle_from_motor_voltage(flown.esc, supply_voltage_v, v_a);
  const double assumed_v_a = plant::motor_voltage(designed.esc, supply_voltage_v, throttle);
  const double assumed_speed = plant::steady_speed_from_voltage(designed.motor, assumed_v_a);

  // Factors of the chain T_c -> Omega_c -> v_c -> delta -> v_a -> Omega -> T.
  const double speed_per_thrust = 1.0 / (2.0 * designed.rotor.thrust * assumed_speed);
  const double voltage_per_speed = designed.motor.k2 + 2.0 * designed.motor.k3 * assumed_speed;
  const double voltage_per_voltage = flown.esc.gain / designed.esc.gain * assumed_v_a / v_a;
  const double speed_per_voltage = 1.0 / (flown.motor.k2 + 2.0 * flown.motor.k3 * speed);
  const double thrust_per_speed = 2.0 * flown.rotor.thrust * speed;
  return {plant::thrust_from_speed(designed.rotor, assumed_speed),
          speed_per_thrust * voltage_per_speed * voltage_per_voltage * speed_per_voltage * thrust_per_speed};
}

// A loop that is not stable has no margin, whatever its phase at the crossovers.
double margin_of(const Loop& loop) {
  const double margin = phase_margin_deg(loop);
  return closed_loop_poles(loop).back().real() < 0.0 ? margin : std::min(margin, 0.0);
}

}  // namespace

LoopSet loops_on(const ControlDesign& design, const plant::Vehicle& designed, const plant::Vehicle& flown,
                 double supply_voltage_v) {
  const HoverPoint hover = hover_point(designed, flown, supply_voltage_v);
  const double lag = flown.motor.time_constant_s;
  const double thrust_ratio = flown.rotor.thrust / designed.rotor.thrust;
  const double torque_ratio = flown.rotor.torque / designed.rotor.torque;

  // Moment / inertia: commanded with the design's inertia, observed with the design's rotor coefficients.
  const auto moment = [&](int axis, double factor_ratio) {
    const double inertia_ratio = flown.inertia(axis, axis) / designed.inertia(axis, axis);
    return RotorResponse{lag, hover.thrust_gain * factor_ratio / thrust_ratio / inertia_ratio,
                         inertia_ratio / factor_ratio};
  };
  const RotorResponse roll = moment(0, thrust_ratio);
  const RotorResponse pitch = moment(1, thrust_ratio);
  const RotorResponse yaw = moment(2, torque_ratio);
  const double mass_ratio = flown.mass_kg / designed.mass_kg;
  const RotorResponse lift{lag, hover.thrust_gain / mass_ratio, mass_ratio / thrust_ratio};
  const double tilt_gain =
      designed.mass_kg * plant::kGravity / (designed.rotor_count() * hover.commanded_thrust_n);

  return {attitude_loop(design.roll.k, roll),
          attitude_loop(design.pitch.k, pitch),
          attitude_loop(design.yaw.k, yaw),
          horizontal_position_loop(design.x.gains, design.pitch.k, pitch, tilt_gain),
          horizontal_position_loop(design.y.gains, design.roll.k, roll, tilt_gain),
          vertical_position_loop(design.z.gains, led(lift, design.thrust_lead))};
}

PhaseMargins margins_on(const ControlDesign& design, const plant::Vehicle& designed,
                        const plant::Vehicle& flown, double supply_voltage_v) {
  const LoopSet loops = loops_on(design, designed, flown, supply_voltage_v);
  return {margin_of(loops.roll), margin_of(loops.pitch), margin_of(loops.yaw),
          margin_of(loops.x),    margin_of(loops.y),     margin_of(loops.z)};
}

}  // namespace swiftlet::control
