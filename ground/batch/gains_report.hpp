// A control design with its margins, as text and as JSON.
#pragma once

#include <array>
#include <string>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/ground/batch/margin_study.hpp"

namespace swiftlet::ground {

using FlownDelays = std::array<double, 6>;  // as control::flown_delay_margins() returns them

// Returns the design as JSON, indented by two spaces, without a newline at the end:
//   vehicle, control: names
//   rotor_lag_s: tau_m of Eq. (18)
//   thrust_lead: of the control settings; the thrust follows with rotor_lag_s / (1 + thrust_lead)
//   attitude.{roll,pitch,yaw}
//     model: "double_integrator", Eq. (38)-(40), or "motor_lag"
//     q, r, k: diagonal weights and gains on (angle, rate) or (angle, rate, moment / inertia)
//     poles: [re, im] in rad/s, of the closed loop with that model
//     poles_with_motor_lag: of the same gains with the rotor lag
//     phase_margin_deg: loop opened at the rotor command, with rotor lag; null if the gain never crosses one
//   position.{x,y,z}
//     omega_n, zeta, epsilon, integral_pole
//     f: Eq. (49) for the state (x_r, u_r, a_r, x, u) of Eq. (45), without the integral
//     integral_form: only with integral_pole > 0, the gains that are then used in place of f:
//       a = a_r + k_v (u_r - u) + k_p (x_r - x) + k_i integral(x_r - x)
//     poles: of the closed loop with inner loop and rotor lag (x with pitch, y with roll, at yaw 0)
//     phase_margin_deg: loop opened at the acceleration command, with inner loop and rotor lag
//   margins.{roll,pitch,yaw,x,y,z}.{designed,most,worst}: of the nominal vehicle, held by 95 % of the samples
//     of its uncertainty, and worst of all samples; most and worst exist only if samples > 0
//     phase_deg, gain_increase_db, gain_decrease_db, delay_s; null if no such change makes the loop unstable
//   flown_delay_s.{roll,pitch,yaw,x,y,z}: least delay from a sample to the rotors that makes the loop unstable, with the
//     observers of the estimator; null if none up to 0.5 s does
//   samples, seed, unstable: number of samples, seed of the first, number of samples with an unstable loop
// The other margins and poles do not include the estimator and the sampling.
std::string gains_json(const control::ControlDesign& design, const MarginStudy& margins,
                       const FlownDelays& flown_delay_s, const std::string& vehicle,
                       const std::string& control);

// A gain margin in a cell of six characters: " +12.3"; "   any" for one that is infinite.
std::string decibels_text(double factor);

// Returns the design as a table for a terminal, with a newline at the end.
std::string gains_table(const control::ControlDesign& design, const MarginStudy& margins,
                        const FlownDelays& flown_delay_s, const std::string& vehicle,
                        const std::string& control);

}  // namespace swiftlet::ground
