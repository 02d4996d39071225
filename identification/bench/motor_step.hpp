// Identifies the step response of the motor, Eq. (15)-(18): the time constant tau_m, read off at 63.2 % as in
// the paper and fitted with both models of plant/model/motor.hpp, and the rotor inertia J_r.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// One step up in voltage, sampled before, during and after it. The initial speed may be above 0.
struct MotorStepData {
  std::vector<double> time_s;  // strictly increasing
  std::vector<double> speed_rad_s;
  std::vector<double> motor_voltage_v;  // empty if not recorded: the speed then gives the step time
};

struct MotorStep {
  ParameterEstimate reading;  // tau_m, read off at 63.2 % of the step
  // tau_m of tau_m dOmega/dt = Omega_ss - Omega; measured and predicted are Omega, rad/s.
  Experiment reduced;
  // tau_m of J_r dOmega/dt = k_Q (s - Omega)(Omega + s'): the 63.2 % rise time from rest to hover.
  Experiment physical;
  ParameterEstimate rotor_inertia;    // J_r of the physical model, for the vehicle's k_Q
  double step_time_s = 0.0;           // time of the step, by the model that fits better
  bool physical_fits_better = false;  // smaller residuals than the reduced model
  bool decided = false;               // the difference of the models is significant
  std::vector<std::string> findings;
};

// Takes k2, k3, the rotor's torque factor and the hover speed from vehicle. torque_factor_error is the
// relative standard error of k_Q, shared by J_r. Calls on_iteration regularly during the fit. Throws BadData.
MotorStep identify_motor_step(const MotorStepData& data, const plant::Vehicle& vehicle,
                              double torque_factor_error, const std::function<void()>& on_iteration = {});

}  // namespace swiftlet::identification
