// The six loops of a design as they run in flight: with the rotor lag, the observers of the estimator, and
// the delay from a sample to the rotors. ControlDesign and its margins leave the last two out.
//
// - The delay T acts on the rotor command. Its transfer function is the Pade approximation of third order,
//   whose phase is exact to 0.1 degrees for omega T < 2.
// - The rotor observer runs the motor model on the commands as they are sent, without the delay, and is
//   corrected by the measured rotor speeds. Its moment is the third state of the attitude law.
// - The thrust command leads the thrust of the rotor observer, as RoughAirSettings::thrust_lead.
// - The disturbance observer compares the vertical acceleration with the thrust of the rotor observer. A
//   delay makes the two differ. On the horizontal axes it has no effect in hover, with or without lead. That of the
//   incremental law compares the moments likewise.
// - The lift observer takes the ratio of two signals behind one filter: it closes no loop.
// - The Kalman filter integrates gyro and accelerometer, and corrects drift by poses at their own stamps. For
//   sensors without errors its estimate is the true state, whatever its gains: it adds no lag.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/loop.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// A loop with its reference r and output y: x' = (A - b c) x + reference r, y = output x.
struct FlownLoop {
  Loop loop;                  // cut at the rotor command (attitude), at the acceleration command (position)
  Eigen::VectorXd reference;  // of angle or position, without feed-forward
  Eigen::RowVectorXd output;  // the angle or position
};

// The rotors with their observer.
struct ObservedRotors {
  double lag_s = 0.0;
  double correction = 0.0;   // rad/s, bandwidth of the correction by measured speeds
  double thrust_lead = 0.0;  // as RoughAirSettings
  bool incremental = false;  // DisturbanceLaw::kIncremental
};

// The rotors as a controller with these settings observes them, if it commands them itself.
ObservedRotors observed_rotors(double rotor_lag_s, const ControlSettings& settings);

constexpr std::array<const char*, 6> kFlownLoopNames = {"roll", "pitch", "yaw", "x", "y", "z"};

// In the order of kFlownLoopNames. delay_s: at least 0, from the sample to the rotors.
std::array<FlownLoop, 6> flown_loops(const ControlGains& gains, const ObservedRotors& rotors, double delay_s);
std::array<FlownLoop, 6> flown_loops(const ControlDesign& design, const ControlSettings& settings,
                                     double delay_s);

// A position axis over an inner loop, as position_loop() with its reference and output. The integral is that of the error.
FlownLoop flown_position_loop(const RptGains& gains, const Eigen::MatrixXd& inner_a,
                              const Eigen::VectorXd& inner_b, const Eigen::RowVectorXd& acceleration);

// The vertical axis over the rotors behind a delay, with their observer and that of disturbances, rad/s (0: none).
FlownLoop flown_vertical_loop(const RptGains& gains, const ObservedRotors& rotors,
                              double disturbance_bandwidth, double delay_s);

// y at the times 0, step_s, 2 step_s, ... after a unit step of the reference: `count` values, exact but for
// rounding. Diverges for an unstable loop.
std::vector<double> step_response(const FlownLoop& loop, double step_s, std::size_t count);

}  // namespace swiftlet::control
