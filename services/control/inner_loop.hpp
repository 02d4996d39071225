// Runs the flight controller in the thread that receives the IMU samples. All other inputs arrive through
// latest values and lock-free queues; all outputs but the command leave through lock-free queues. Does not
// block, allocate or log.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/loop_delay.hpp"
#include "swiftlet/services/control/pending_request.hpp"
#include "swiftlet/services/control/step_timing.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"

namespace swiftlet::services {

// Setpoints received while this controller was active.
struct SetpointTally {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  control::Outcome refusal;  // of the last one refused
};

// The state after a step, for telemetry.
struct Snapshot {
  std::int64_t stamp_ns = 0;  // of the IMU sample
  bool sampled = false;       // one of the 100 per second for telemetry; else a change of status
  control::Estimate estimate;
  control::ErrorState estimate_deviation;  // set if sampled
  control::Reference reference;
  control::AttitudeSetpoint setpoint;
  control::Status status;
  control::RequestStatuses requests;
  std::uint64_t trajectory_id = 0;  // of the trajectory being flown
  Role role = Role::kStandby;
  bool saturated = false;       // in any step since the last snapshot
  control::ControlGains gains;  // in force
  StepTiming::Figures timing;
  LoopDelay::Figures loop_delay;
  SetpointTally setpoints;
};

// The active controller's state, for a standby to follow.
struct FailoverState {
  std::uint64_t number = 0;  // counts up from 1, per process
  std::uint32_t term = 0;
  control::FlightState flight;
  // The uploaded or flown plan; null if it is not stored here.
  const control::Mission* mission = nullptr;
  const control::Trajectory* trajectory = nullptr;
};

// At which level the vehicle can be commanded, and is to be; see FlightController::set_levels().
struct LevelChoice {
  plant::ControlLevels accepted = plant::ControlLevel::kActuators;
  std::optional<plant::ControlLevel> wanted;
};

class InnerLoop {
 public:
  // Throws std::invalid_argument as FlightController does.
  InnerLoop(const plant::Vehicle& vehicle, const control::ControlSettings& settings);

  // Inputs, each from one thread. Of samples only the newest is used.
  runtime::LatestValue<plant::PoseSample> pose;
  runtime::LatestValue<plant::BatterySample> battery;
  runtime::LatestValue<plant::RotorSpeedSample> rotor_speeds;
  runtime::LatestValue<control::Setpoint> setpoint;
  runtime::LatestValue<FailoverState> failover_state;
  runtime::LatestValue<LevelChoice> levels;
  runtime::LatestValue<control::VehicleFault> vehicle_fault;
  runtime::LatestValue<control::VehicleFault> vehicle_refusal;
  std::atomic<bool> vehicle_rotors_running{true};
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> requests;

  boost::lockfree::spsc_queue<control::GroundHeartbeat, boost::lockfree::capacity<32>> ground_heartbeats;

  // Outputs, to one thread. If the snapshot queue is full, the newest snapshots are lost.
  boost::lockfree::spsc_queue<PendingRequest*, boost::lockfree::capacity<kMaxPendingRequests>> evaluated;
  boost::lockfree::spsc_queue<Snapshot, boost::lockfree::capacity<256>> snapshots;

  // What the vehicle reports with the sample of the next step; from the IMU thread.
  // term: of this controller's commands. A standby sends none.
  void set_obeyed(const plant::ObeyedCommand& obeyed, Role role, std::uint32_t term);
  // The vehicle was restarted before the sample of the next step, which arrived at now_ns; from the IMU thread. A standby adopts
  // no flight from before.
  void restart_vehicle(std::int64_t now_ns);

  // Call both from the IMU thread. step() returns the command. finish() does the rest of the step after the
  // command is sent, and returns true if there is new output. now_ns, monotonic: arrival of the sample for
  // step(), departure of the command for finish(). A standby steps too and adopts the active controller's
  // state of term followed_term; its command must not be sent. loop_delay: for telemetry.
  plant::VehicleCommand step(const plant::ImuSample& sample, std::int64_t now_ns, Role role = Role::kActive,
                             std::uint32_t followed_term = 0);
  // The same for the vehicle's own estimate, in place of the IMU sample.
  plant::VehicleCommand step(const plant::OdometrySample& sample, std::int64_t now_ns,
                             Role role = Role::kActive, std::uint32_t followed_term = 0);
  bool finish(std::int64_t now_ns, const LoopDelay::Figures& loop_delay = {});

  // In-air restart, if there is no controller state to continue from: from the next step on detects whether
  // the vehicle is airborne, and if so engages hold. Until that is decided, for at most kAirborneDetectionNs,
  // commands must not be sent: the vehicle keeps executing its last one.
  void attempt_restart_in_air() { detecting_since_ns_ = kDetectFromNow; }
  bool detecting_airborne() const { return detecting_since_ns_ != kNotDetecting; }
  static constexpr std::int64_t kAirborneDetectionNs = 300'000'000;

  // A standby is ready when it has had a pose without interruption for this long: its estimate has settled, and Fast DDS, which
  // does so after a second, has repeated what the vehicle missed of its topics.
  static constexpr std::int64_t kReadyAfterNs = 1'250'000'000;
  // report_due(): this step must publish a controller_state. report() fills in its flight fields.
  bool report_due() const { return report_due_; }
  void report(messages::ControllerReport& report) const;

  // The level of the last command. Call from any thread.
  plant::ControlLevel level() const { return level_.load(std::memory_order_relaxed); }

  // The number of the newest FailoverState that was adopted: its plans may be in use. Call from any thread.
  std::uint64_t adopted_state() const { return adopted_state_.load(std::memory_order_acquire); }

  // Monotonic; 0 before the first sample. Call from any thread.
  std::int64_t last_arrival_ns() const { return last_arrival_ns_.load(std::memory_order_relaxed); }

  // While simulated time stands still: answers pending requests as step() does, at the last sample.
  void answer_requests();

 private:
  // The pending requests and the newest setpoint, for one step.
  struct Clients {
    control::ClientInputs inputs;
    control::Setpoint setpoint;
    std::array<PendingRequest*, kMaxPendingRequests> requests{};
    std::size_t request_count = 0;
  };

  // What comes before and after the controller's step.
  void begin_step(std::int64_t stamp_ns, std::int64_t now_ns, Role role, std::uint32_t followed_term,
                  Clients& clients);
  void end_step(const plant::VehicleCommand& command, const Clients& clients, std::int64_t stamp_ns,
                std::uint64_t sequence, std::int64_t now_ns);
  void take_samples();
  void take_levels();
  void take_requests(Clients& clients);
  void take_setpoint(Clients& clients);
  void return_outcomes(const Clients& clients, std::int64_t stamp_ns);
  void count(const control::Outcome& setpoint_outcome);
  void follow(std::uint32_t term);
  bool predates_restart(const FailoverState& state) const;
  void detect_airborne(std::int64_t stamp_ns);
  void take_heartbeats();
  bool status_changed() const;

  static constexpr std::int64_t kNotDetecting = -1;
  static constexpr std::int64_t kDetectFromNow = -2;

  control::FlightController controller_;
  StepTiming timing_;
  Snapshot snapshot_;
  control::Status last_snapshot_;  // of the last snapshot
  control::RequestStatuses snapshot_requests_{};
  std::int64_t stamp_ns_ = 0;
  std::int64_t unposed_ns_ = 0;  // stamp of the last sample at which there was no pose
  std::uint64_t imu_sequence_ = 0;
  std::uint64_t last_imu_sequence_ = 0;  // of the sample before
  std::atomic<std::int64_t> last_arrival_ns_{0};
  std::atomic<std::uint64_t> adopted_state_{0};
  LevelChoice level_choice_;
  std::atomic<plant::ControlLevel> level_{plant::ControlLevel::kActuators};
  Role role_ = Role::kStandby;
  Role snapshot_role_ = Role::kStandby;
  SetpointTally setpoints_;
  std::int64_t detecting_since_ns_ = kNotDetecting;
  bool has_obeyed_ = true;         // the vehicle, since its last restart
  std::int64_t restarted_ns_ = 0;  // arrival of the first sample after it; 0: never
  int rotor_samples_ = 0;          // rotor speed samples since detection began
  bool knows_plan_ = false;        // plan of the followed flight is stored here
  bool report_due_ = false;
  std::int64_t reported_ns_ = 0;
  bool rotors_running_ = false;
  bool saturated_ = false;
  bool evaluated_any_ = false;
  bool accepted_any_ = false;  // since the last report
};

}  // namespace swiftlet::services
