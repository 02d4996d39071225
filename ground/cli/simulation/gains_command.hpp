// `swiftlet gains`: what the controller will fly, computed from a vehicle file and control settings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/ground/batch/margin_study.hpp"
#include "swiftlet/ground/command_line/command.hpp"

namespace swiftlet::ground {

struct GainsOptions {
  std::string vehicle = "kaylion";    // a file, or the name of one in the configuration
  std::string control = "motor_lag";  // likewise
  std::size_t draws = 1000;           // of vehicles, where the vehicle file says how sure its parameters are
  std::uint64_t seed = 1;             // of the first draw
  bool json = false;
};

// The design as JSON, two spaces to a level, without a newline at its end:
//   vehicle, control: names
//   rotor_lag_s: tau_m of Eq. (18)
//   attitude.{roll,pitch,yaw}
//     model: "double_integrator", Eq. (38)-(40), or "motor_lag"
//     q, r, k: diagonal weights and gains on (angle, rate) or (angle, rate, moment / inertia)
//     poles: [re, im] in rad/s, of the closed loop on that model
//     poles_with_motor_lag: the same gains with the rotor lag
//     phase_margin_deg: cut at the rotor command, rotor lag included; null if the gain never crosses one
//   position.{x,y,z}
//     omega_n, zeta, epsilon, integral_pole
//     f: Eq. (49) for the state (x_r, u_r, a_r, x, u) of Eq. (45), without the integral
//     integral_form: only with integral_pole > 0, the gains that are then flown in place of f:
//       a = a_r + k_v (u_r - u) + k_p (x_r - x) + k_i integral(x_r - x)
//     poles: of the closed loop over inner loop and rotor lag (x over pitch, y over roll, yaw 0)
//     phase_margin_deg: cut at the acceleration command, inner loop and rotor lag included
//   margins.{roll,pitch,yaw,x,y,z}.{designed,most,worst}: on the vehicle, and over draws of its uncertainty,
//     those that 95 % of the draws keep and the worst; the last two only where there are draws
//     phase_deg, gain_increase_db, gain_decrease_db, delay_s; null where nothing ends the loop's stability
//   draws, seed, unstable: of the margins
// Margins and poles leave out the estimator and the sampling.
std::string gains_json(const control::ControlDesign& design, const MarginStudy& margins,
                       const std::string& vehicle, const std::string& control);

// The same for reading, ending in a newline.
std::string gains_table(const control::ControlDesign& design, const MarginStudy& margins,
                        const std::string& vehicle, const std::string& control);

// Prints one of both; loops that would not be stable are named on stderr. Returns kDone. Throws
// runtime::ConfigError for a file that is refused.
int run_gains(const GainsOptions& options);

}  // namespace swiftlet::ground
