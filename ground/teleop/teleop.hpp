// Flies a vehicle by sticks: streams velocity setpoints while they are deflected, and requests hold when they
// are released. If this program dies or is cut off, the vehicle holds after failsafe.setpoint_timeout_s.
#pragma once

#include <cstdint>
#include <future>
#include <string>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/teleop/sticks.hpp"

namespace swiftlet::ground {

class Teleop {
 public:
  // The vehicle must outlive this object.
  Teleop(Vehicle& vehicle, const TeleopLimits& limits) : vehicle_(vehicle), limits_(limits) {}
  Teleop(const Teleop&) = delete;
  Teleop& operator=(const Teleop&) = delete;

  // Call it at 10 Hz or more. Does not block. Sends nothing while the vehicle neither holds nor follows
  // setpoints.
  void update(const Sticks& sticks);
  // Requests hold in the background.
  void hold();
  // Requests hold if the vehicle moves by the last setpoint, takes off, or flies a mission or trajectory, and
  // waits for the answer, 2 s at most. Returns false if it was not accepted.
  bool finish();

  std::uint64_t sent() const { return sent_; }  // setpoints
  // Why the last hold was not accepted; or empty.
  const std::string& hold_fault() const { return hold_fault_; }

 private:
  void take_hold_answer();

  Vehicle& vehicle_;
  TeleopLimits limits_;
  std::uint64_t sent_ = 0;
  bool moving_ = false;  // setpoints were sent since the last hold
  std::string hold_fault_;
  std::future<Result> holding_;  // valid until its answer is taken
};

}  // namespace swiftlet::ground
