// Simulated time that waits for the answers: the plant goes on from a stamp when the command that answers its
// IMU sample and the mocap frame that was due have arrived. What a fault of the simulation keeps back is not
// waited for.
//
// What has no answer is sent again; whoever took it in before answers as before and does not take it in
// twice. So a lost datagram costs time and changes nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap_schedule.hpp"
#include "swiftlet/recording/flight_trace.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"

namespace swiftlet::services {

struct LockstepSettings {
  bool paused = false;      // time passes only as far as simulation_clock grants it
  double speed = 0.0;       // of simulated time against real time, at most; 0: as fast as the answers come
  double patience_s = 2.0;  // for an answer
  std::string trace;        // file; empty: none is kept
};

class LockstepLoop {
 public:
  // Throws std::runtime_error if the trace cannot be written. The vehicle must outlive the loop.
  // Settings and seed are those that motion capture has, too.
  LockstepLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, std::uint64_t seed,
               const LockstepSettings& lockstep, int rotor_count, comms::Node& node);

  // Until `stop`. Throws std::runtime_error that names the peer whose answer has not come in time, of which
  // only what this process was awake for counts.
  void run(const std::atomic<bool>& stop);

 private:
  void on_command(const comms::msg::ActuatorCommand& message);
  void on_pose(const comms::msg::MocapPose& message);
  void on_clock(const comms::msg::SimulationClock& message);

  // All below with the lock held.
  bool command_due() const { return vehicle_.simulation().imu().has_value() && !command_arrived_; }
  bool mocap_silent() const {
    return !mocap_heard_ || mocap_sequence_ < mocap_due_ || mocap_seen_ns_ < truth_sent_ns_;
  }
  bool answered() const { return !command_due() && !mocap_silent(); }
  bool is_paused() const;
  bool may_advance() const;
  void keep_pace(double awake_s);
  void advance();
  void advance_to_imu_stamp();
  void publish();
  bool frame_is_due(std::int64_t stamp_ns, bool delivered);
  void look_after(double awake_s);
  std::string silent_peer() const;
  std::string silent_ground() const;

  SimulatedVehicle& vehicle_;
  plant::MocapSchedule mocap_;  // as motion capture keeps it
  const LockstepSettings lockstep_;
  std::int64_t imu_period_ns_;

  std::mutex mutex_;
  bool started_ = false;  // the first samples have been published
  plant::ActuatorCommand command_;
  bool command_arrived_ = false;
  bool mocap_heard_ = false;
  std::uint64_t mocap_sequence_ = 0;
  std::uint64_t mocap_due_ = 0;
  std::int64_t mocap_seen_ns_ = -1;  // truth up to this stamp, of which there was no frame
  std::int64_t truth_sent_ns_ = -1;  // likewise
  plant::MocapPath expected_;        // carries the numbers of the frames that are due
  std::int64_t granted_ns_ = 0;
  std::int64_t paced_ns_;  // up to which time has come at lockstep_.speed
  bool clock_heard_ = false;
  double silence_s_ = 0.0;        // since the last progress
  double clock_silence_s_ = 0.0;  // since simulation_clock was last heard
  std::optional<runtime::FlightTrace> trace_;
  std::string failure_;  // of a callback

  comms::Subscription commands_;  // last: their callbacks use what stands above
  comms::Subscription poses_;
  comms::Subscription clock_;
};

}  // namespace swiftlet::services
