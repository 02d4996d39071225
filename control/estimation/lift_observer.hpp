// Lift observer: learns the ratio of actual lift (thrust over mass) and modelled lift while the vehicle takes off, and
// follows it in flight. It covers a wrong mass, worn rotors and a wrong battery model.
//
// On the ground the floor carries what the rotors do not, and the accelerometer measures gravity whatever the thrust:
// the ratio cannot be seen before lift-off. Lift-off shows it: thrust rises until the accelerometer measures an
// upward acceleration that its vibration does not explain, and at that moment the lift is the weight. From then on the
// ratio is that of the means of the measured and the modelled lift, over the time since lift-off, at most kMemory_s. It
// is a quotient of two signals behind one filter, so that noise and the lag of the rotors do not bias it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::control {

class LiftObserver {
 public:
  static constexpr double kLiftOff = 0.15;   // m/s^2, upward acceleration that shows lift-off
  static constexpr double kSure = 4.0;       // and so many standard deviations of its noise on the ground
  static constexpr double kNoise_s = 0.3;    // of the mean of that noise
  static constexpr double kLeastLift = 5.0;  // m/s^2, modelled: with less, the vehicle does not lift off
  static constexpr double kOnset_s = 0.02;   // of the filter until lift-off
  static constexpr double kMemory_s = 1.0;   // of the means in flight
  static constexpr double kLeast = 0.6;      // of the ratio
  static constexpr double kMost = 1.6;

  // A step of dt_s > 0. specific_force_frd: measured, bias removed, m/s^2. lift: modelled thrust over mass, m/s^2. Both ignore
  // an input that is not finite.
  //
  // On the ground, with rising thrust.
  void step_on_ground(double dt_s, const Eigen::Vector3d& specific_force_frd,
                      const Eigen::Quaterniond& q_ned_from_frd, double lift);
  // In free flight. Without a lift-off before, the ratio begins at 1.
  void step_in_flight(double dt_s, const Eigen::Vector3d& specific_force_frd, double lift);

  // Actual over modelled lift; 1 before lift-off.
  double ratio() const { return ratio_; }
  bool lifted_off() const { return lifted_off_; }

  // For a vehicle on the ground with its rotors off.
  void reset() { *this = LiftObserver(); }
  // Takes over the ratio of another controller in flight.
  void adopt(double ratio);

 private:
  void update(double dt_s, double measured, double lift, double time_s);

  bool lifted_off_ = false;
  bool begun_ = false;
  double ratio_ = 1.0;
  double time_s_ = kOnset_s;   // of the means
  double measured_ = 0.0;      // m/s^2, mean
  double modelled_ = 0.0;      // m/s^2, mean
  double upward_ = 0.0;        // m/s^2, mean acceleration
  double ground_s_ = 0.0;      // time on the ground, at most kNoise_s
  double innovation_ = 0.0;    // (m/s^2)^2, mean square of a measured acceleration less the mean before
  double squared_lift_ = 0.0;  // (m/s^2)^2, mean square of the modelled lift of that time
};

}  // namespace swiftlet::control
