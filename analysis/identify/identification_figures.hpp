// The paper's figures, drawn from bench data and fits.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/analysis/plot/figure.hpp"
#include "swiftlet/identification/bench/bench.hpp"

namespace swiftlet::analysis {

// Figs. 2 and 3: v_a over delta for each supply voltage, and v_a^2 over v_s^2 delta.
std::vector<plot::Figure> esc_figures(const identification::EscData& data,
                                      const identification::Experiment& fit);
// Fig. 4: speed over v_a.
plot::Figure steady_motor_figure(const identification::SteadyMotorData& data,
                                 const identification::Experiment& fit);
// Figs. 6 and 7: thrust and torque over the square of the speed.
plot::Figure thrust_figure(const identification::ThrustTorqueData& data,
                           const identification::Experiment& fit);
plot::Figure torque_figure(const identification::ThrustTorqueData& data,
                           const identification::Experiment& fit);
// Speed over time, with both models and the 63.2 % reading.
plot::Figure motor_step_figure(const identification::MotorStepData& data,
                               const identification::MotorStep& step);
// Thrust over delta for each supply voltage.
plot::Figure throttle_thrust_figure(const identification::ThrottleThrustData& data,
                                    const identification::Experiment& fit, const plant::Vehicle& vehicle);
// Residuals of a fit in the order of the rows. Outliers outside the range of the others are clipped to the
// edge.
plot::Figure residual_figure(const identification::Experiment& fit);

}  // namespace swiftlet::analysis
