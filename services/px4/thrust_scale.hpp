// PX4's collective throttle, 0 to 1, for a thrust in newtons, and what is learnt of it in flight.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::px4 {

// The curve is that of the vehicle file, Eq. (9), (22) and (25), at the supply voltage. PX4's THR_MDL_FAC must be 0, so that
// it passes the throttle on unchanged. A factor on the throttle is learnt from the measured specific force, so that the thrust is
// right whatever the battery and the vehicle. Not thread-safe. Does not allocate after construction.
class ThrustScale {
 public:
  // hover_throttle: PX4's throttle of hover, its MPC_THR_HOVER, to begin with; without it, that of the vehicle file.
  explicit ThrustScale(const plant::Vehicle& vehicle, std::optional<double> hover_throttle = std::nullopt);

  double throttle(double thrust_n) const;  // 0 .. 1
  double hover_throttle() const { return throttle(weight_n_); }
  double factor() const { return factor_; }  // of the throttle, over the curve; 1 before anything is learnt

  // PX4 reports the voltage of a simulated battery, too: only one that the vehicle's battery can have is used.
  void set_voltage(double supply_voltage_v);

  // An IMU sample while PX4 obeys thrust_n. specific_force_up: along -z of FRD, m/s^2. flying: the vehicle does not touch the
  // ground. Learns while the thrust is near the weight. In a touchdown the ground carries the vehicle before `flying` tells: what
  // was learnt in the last 1.5 s of a flight is forgotten.
  void learn(double thrust_n, double specific_force_up, bool flying, std::int64_t stamp_ns);

 private:
  double curve(double thrust_n) const;
  void note_flight(bool flying, std::int64_t stamp_ns);

  plant::Vehicle vehicle_;
  double weight_n_;
  double voltage_v_;
  double factor_ = 1.0;
  // In flight, the factor of up to kTouchdown_s ago and that of before.
  double recent_factor_ = 1.0;
  double earlier_factor_ = 1.0;
  std::int64_t marked_ns_ = -1;  // when they were set; -1: on the ground
  double lagged_n_ = 0.0;        // the commanded thrust through the lag of the motors
  double steady_s_ = 0.0;        // for how long the vehicle has flown near hover
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace swiftlet::px4
