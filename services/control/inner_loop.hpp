// The flight controller in the thread that receives the IMU. All other input reaches it through mailboxes and
// a ring, all output but the command leaves it through rings. Nothing in it waits, allocates or logs.
#pragma once

#include <atomic>
#include <cstdint>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/pending_request.hpp"
#include "swiftlet/services/control/step_timing.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"

namespace swiftlet::services {

// What became of the setpoints that came while this controller was the active one.
struct SetpointTally {
  std::uint64_t taken = 0;
  std::uint64_t refused = 0;
  control::Outcome refusal;  // the last
};

// What a step says to the rest of the process.
struct Snapshot {
  std::int64_t stamp_ns = 0;  // of the IMU sample
  bool sampled =
      false;  // one of the 100 a second that telemetry shows; others are there for a change of status
  control::Estimate estimate;
  control::ErrorState estimate_deviation;  // of a sampled one
  control::Reference reference;
  control::AttitudeSetpoint setpoint;
  control::Status status;
  control::RequestStatuses requests;
  std::uint64_t trajectory_id = 0;  // of the one being flown
  Role role = Role::kStandby;
  bool saturated = false;  // in any step since the last snapshot
  StepTiming::Figures timing;
  SetpointTally setpoints;
};

// The active controller's flight, for a standby to follow.
struct FailoverState {
  std::uint64_t number = 0;  // counts up from 1
  std::uint32_t term = 0;
  control::FlightState flight;
  // What is there or flown; null if it is not known here.
  const control::Mission* mission = nullptr;
  const control::Trajectory* trajectory = nullptr;
};

class InnerLoop {
 public:
  // Throws std::invalid_argument as FlightController does.
  InnerLoop(const plant::Vehicle& vehicle, const control::ControlSettings& settings);

  // Input, from one thread each; of samples, the newest counts.
  runtime::LatestValue<plant::PoseSample> pose;
  runtime::LatestValue<plant::BatterySample> battery;
  runtime::LatestValue<plant::RotorSpeedSample> rotor_speeds;
  runtime::LatestValue<control::Setpoint> setpoint;
  runtime::LatestValue<FailoverState> failover_state;
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> requests;

  boost::lockfree::spsc_queue<control::GroundHeartbeat, boost::lockfree::capacity<32>> ground_heartbeats;

  // Output, to one thread. When snapshots are not taken, the newest are lost.
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> evaluated;
  boost::lockfree::spsc_queue<Snapshot, boost::lockfree::capacity<256>> snapshots;

  // By the IMU thread: step() gives the command; once it is sent, finish() does the rest of the step and
  // returns whether there is new output. now_ns: monotonic time of the sample's arrival, or of the command's
  // departure. A standby steps as the active one does and follows the flight of that term; its command is not
  // for sending.
  plant::ActuatorCommand step(const plant::ImuSample& sample, std::int64_t now_ns, Role role = Role::kActive,
                              std::uint32_t followed_term = 0);
  bool finish(std::int64_t now_ns);

  // Nobody was there to go on from: from the next step on looks whether the vehicle flies, and takes it into
  // hold if it does. Until that is clear, for at most kLook, there are no commands to be sent: the vehicle
  // goes on with its last one.
  void attempt_restart_in_air() { looks_since_ns_ = kLooksFromNow; }
  bool looking() const { return looks_since_ns_ != kLooksNot; }
  static constexpr std::int64_t kLookNs = 300'000'000;

  // Whether a report to the other controllers is due with this step, and what it says of the flight.
  bool report_due() const { return report_due_; }
  void report(comms::ControllerReport& report) const;

  // The newest handover that was gone over to. By any thread.
  std::uint64_t taken_handover() const { return taken_handover_.load(std::memory_order_acquire); }

  // Monotonic; 0 before the first sample. By any thread.
  std::int64_t last_arrival_ns() const { return last_arrival_ns_.load(std::memory_order_relaxed); }

  // Between two steps: has the controller judge what is asked. step() does it too.
  void evaluate_requests();

 private:
  void take_samples();
  void take_setpoint(const control::Setpoint& setpoint);
  void follow(std::uint32_t term);
  void look(const plant::ImuSample& sample);
  void hear_ground();
  bool status_changed() const;

  static constexpr std::int64_t kLooksNot = -1;
  static constexpr std::int64_t kLooksFromNow = -2;

  control::FlightController controller_;
  StepTiming timing_;
  Snapshot snapshot_;
  control::Status last_snapshot_;  // in the last snapshot
  control::RequestStatuses snapshot_requests_{};
  std::int64_t stamp_ns_ = 0;
  std::uint64_t imu_sequence_ = 0;
  std::atomic<std::int64_t> last_arrival_ns_{0};
  std::atomic<std::uint64_t> taken_handover_{0};
  Role role_ = Role::kStandby;
  Role snapshot_role_ = Role::kStandby;
  SetpointTally setpoints_;
  std::int64_t looks_since_ns_ = kLooksNot;
  int rotor_samples_ = 0;    // of the rotors' speeds, since it looks
  bool knows_plan_ = false;  // of the flight that it follows
  bool report_due_ = false;
  std::int64_t reported_ns_ = 0;
  bool rotors_running_ = false;
  bool saturated_ = false;
  bool evaluated_any_ = false;
  bool accepted_any_ = false;  // since the last report
};

}  // namespace swiftlet::services
