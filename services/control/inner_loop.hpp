// The flight controller in the thread that receives the IMU. All other input reaches it through mailboxes and
// a ring, all output but the command leaves it through rings. Nothing in it waits, allocates or logs.
#pragma once

#include <atomic>
#include <cstdint>

#include <boost/lockfree/spsc_queue.hpp>

#include "control/flight_controller.hpp"
#include "services/control/pending_request.hpp"
#include "services/control/step_timing.hpp"
#include "services/runtime/mailbox.hpp"

namespace swiftlet::services {

// What a step says to the rest of the process.
struct Snapshot {
  std::int64_t stamp_ns = 0;  // of the IMU sample
  bool sampled =
      false;  // one of the 100 a second that telemetry shows; others are there for a change of status
  control::Estimate estimate;
  control::Reference reference;
  control::AttitudeSetpoint setpoint;
  control::Status status;
  bool saturated = false;  // in any step since the last snapshot
  StepTiming::Figures timing;
};

class InnerLoop {
 public:
  // Throws std::invalid_argument as FlightController does.
  InnerLoop(const plant::Vehicle& vehicle, const control::ControlSettings& settings);

  // Input, from one thread each; of samples, the newest counts.
  runtime::Mailbox<plant::PoseSample> pose;
  runtime::Mailbox<plant::BatterySample> battery;
  runtime::Mailbox<plant::RotorSpeedSample> rotor_speeds;
  runtime::Mailbox<control::Setpoint> setpoint;
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> requests;

  boost::lockfree::spsc_queue<control::GroundSign, boost::lockfree::capacity<32>> ground_signs;

  // Output, to one thread. When snapshots are not taken, the newest are lost.
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> judged;
  boost::lockfree::spsc_queue<Snapshot, boost::lockfree::capacity<256>> snapshots;

  // By the IMU thread: step() gives the command; once it is sent, finish() does the rest of the step and
  // returns whether there is new output. now_ns: monotonic time of the sample's arrival, or of the command's
  // departure.
  plant::ActuatorCommand step(const plant::ImuSample& sample, std::int64_t now_ns);
  bool finish(std::int64_t now_ns);

  // Monotonic; 0 before the first sample. By any thread.
  std::int64_t last_arrival_ns() const { return last_arrival_ns_.load(std::memory_order_relaxed); }

  // Between two steps: has the controller judge what is asked. step() does it too.
  void judge_requests();

 private:
  void take_samples();
  void hear_ground();
  bool status_changed() const;

  control::FlightController controller_;
  StepTiming timing_;
  Snapshot snapshot_;
  control::Status told_;  // in the last snapshot
  std::int64_t stamp_ns_ = 0;
  std::uint64_t imu_sequence_ = 0;
  std::atomic<std::int64_t> last_arrival_ns_{0};
  bool rotors_running_ = false;
  bool saturated_ = false;
  bool judged_any_ = false;
};

}  // namespace swiftlet::services
