// When the samples of the vehicle are answered, and in which role: RealtimeDriver and LockstepDriver.
#pragma once

#include <cstdint>
#include <functional>

#include "swiftlet/services/control/lockstep_gate.hpp"
#include "swiftlet/services/control/vehicle_sample.hpp"

namespace swiftlet::services {

class StepDriver {
 public:
  using Stream = LockstepGate::Stream;

  virtual ~StepDriver() = default;

  // A sample to be answered, and one of the streams beside it: `put` passes that to the inner loop. Call each from the thread that
  // received it.
  virtual void on_sample(const VehicleSample& sample) = 0;
  virtual void on_sensor(Stream stream, std::uint64_t sequence, const std::function<void()>& put) = 0;

  // The levels that the vehicle accepts have come, or that it is refused. Call from any thread.
  virtual void levels_known() {}
  // What is due in the thread of ControlService::run(). Call periodically.
  virtual void attend() {}

  // Call both from any thread. The term of a command that is sent beside the steps, and whether the threads of IMU and poses have
  // real-time scheduling.
  virtual std::uint32_t command_term() const = 0;
  virtual bool is_realtime() const { return false; }
  // True if another controller commands the vehicle and this one must end.
  virtual bool has_rival() const { return false; }
};

}  // namespace swiftlet::services
