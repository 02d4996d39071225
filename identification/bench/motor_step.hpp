// Motor's answer to a step of its voltage, Eq. (15)-(18): the time constant tau_m, read off at 63.2 % as in
// the paper and fitted by both models of plant/model/motor.hpp, and the rotor inertia J_r.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// One step up, sampled before, during and after. The speed need not start at 0.
struct MotorStepData {
  std::vector<double> time_s;  // rising
  std::vector<double> speed_rad_s;
  std::vector<double> motor_voltage_v;  // empty: not recorded, the step's time is then found from the speed
};

struct MotorStep {
  ParameterEstimate reading;  // tau_m by the 63.2 % reading
  Experiment reduced;         // tau_m by tau_m dOmega/dt = Omega_ss - Omega; measured and predicted are Omega
  Experiment
      physical;  // tau_m by J_r dOmega/dt = k_Q (s - Omega)(Omega + s'): the 63.2 % rise of a step from rest to hover
  ParameterEstimate rotor_inertia;  // J_r, by the physical model, for the k_Q given
  double step_time_s = 0.0;         // by the model that fits better
  bool physical_fits_better = false;
  bool decided = false;  // one of them fits better by more than chance
  std::vector<std::string> findings;
};

// k2, k3 and the rotor's torque factor are taken from vehicle, as is the hover speed. torque_factor_error:
// standard error of k_Q, relative, which J_r shares. on_iteration is called now and then. Throws BadData.
MotorStep identify_motor_step(const MotorStepData& data, const plant::Vehicle& vehicle,
                              double torque_factor_error, const std::function<void()>& on_iteration = {});

}  // namespace swiftlet::identification
