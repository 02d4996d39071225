// Lockstep: simulated time waits for the answers. The plant advances from a stamp when the command that
// answers its IMU sample and the mocap frame that was due have arrived. It does not wait for messages that a
// simulated fault withholds.
//
// Unanswered samples are sent again. A receiver that processed one before repeats its answer and does not
// process it twice. A lost datagram thus costs time but does not change the flight.
//
// With goes_on a peer that dies or stands still is left behind after patience_s: time goes on without its answers until the
// next one comes. While control is missing it does so at a quarter of the pace of real time, as nothing else limits it; also before the
// first command, since one of several controllers in real time becomes active in the course of some samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap_schedule.hpp"
#include "swiftlet/record/flight_trace.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"

namespace swiftlet::services {

struct LockstepSettings {
  bool paused = false;      // time advances only up to simulation_clock
  double speed = 0.0;       // limit, simulated time per real time; 0: no limit
  double patience_s = 2.0;  // time-out of an answer of a peer that has answered before
  bool goes_on = false;     // after it, without that peer; otherwise the loop fails
  std::string trace;        // file; empty: no trace
};

class LockstepLoop {
 public:
  // Throws std::runtime_error if the trace cannot be written. The vehicle must outlive the loop. Motion
  // capture must run with the same settings and seed.
  LockstepLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, std::uint64_t seed,
               const LockstepSettings& lockstep, int rotor_count, dds::Node& node);

  // Runs until `stop`. Waits without limit for a peer that has not answered yet, as it may start later. Throws
  // std::runtime_error naming a peer that has answered before and is then silent for patience_s, unless it goes on without
  // it. Only time in which this process was running counts.
  void run(const std::atomic<bool>& stop);

 private:
  void on_command(const ReceivedCommand& received);
  void on_pose(const messages::msg::MocapPose& message);
  void on_clock(const messages::msg::SimulationClock& message);

  // Call all functions below with mutex_ held.
  bool command_due() const { return vehicle_.awaited().has_value(); }
  bool mocap_silent() const {
    return !mocap_heard_ || mocap_sequence_ < mocap_due_ || mocap_seen_ns_ < truth_sent_ns_;
  }
  bool answered() const {
    return (!command_due() || control_missing_) && (!mocap_silent() || mocap_missing_);
  }
  bool is_paused() const;
  bool may_advance() const;
  void keep_pace(double awake_s);
  void go_on_without_silent_peers();
  void return_of_control();
  void advance();
  void advance_to_imu_stamp();
  void publish();
  bool frame_is_due(std::int64_t stamp_ns, bool delivered);
  void poll(double awake_s);
  void note_silence(double awake_s);
  std::string silent_peer() const;
  std::string silent_ground() const;

  SimulatedVehicle& vehicle_;
  plant::MocapSchedule mocap_;  // same as in motion capture
  const LockstepSettings lockstep_;
  std::int64_t imu_period_ns_;
  bool
      sends_every_truth_;  // faults lose samples of the IMU, and telemetry then has stamps that cannot be foreseen

  std::mutex mutex_;
  bool started_ = false;  // the first samples have been published
  plant::VehicleCommand command_;
  bool control_heard_ = false;
  bool mocap_heard_ = false;
  bool control_missing_;  // it has been silent for too long, and time goes on without it
  bool mocap_missing_ = false;
  std::uint64_t mocap_sequence_ = 0;
  std::uint64_t mocap_due_ = 0;
  std::int64_t mocap_seen_ns_ = -1;  // newest truth without a frame that mocap answered
  std::int64_t truth_sent_ns_ = -1;  // newest truth without a frame that was sent
  plant::MocapPath expected_;        // passes the sequence numbers of the frames due
  std::int64_t advance_to_ns_ = 0;
  std::int64_t paced_ns_;  // time limit at lockstep_.speed, or of real time
  bool clock_heard_ = false;
  double silence_s_ = 0.0;        // since the last progress
  std::string logged_wait_;       // for peers that have not answered yet; the last line of the log
  double clock_silence_s_ = 0.0;  // since simulation_clock was last heard
  std::optional<record::FlightTrace> trace_;

  std::vector<dds::Subscription> commands_;  // last: their callbacks use all members above
  dds::Subscription poses_;
  dds::Subscription clock_;
};

}  // namespace swiftlet::services
