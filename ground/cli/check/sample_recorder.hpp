// Records what a vehicle publishes, for the checks of ground/vehicle_check.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Publishes nothing but clock_request. Thread-safe.
class SampleRecorder {
 public:
  // settings.vehicle names the vehicle. Throws std::runtime_error if the network cannot be joined.
  explicit SampleRecorder(const dds::NodeSettings& settings);
  SampleRecorder(const SampleRecorder&) = delete;
  SampleRecorder& operator=(const SampleRecorder&) = delete;

  // Forgets what was received. From now on times count seconds of a vehicle that passes so many of them in a second of this
  // computer: a simulation may be faster or slower.
  void restart(double vehicle_rate = 1.0);
  // The clock of the recording.
  std::int64_t now_ns() const;
  double vehicle_rate() const { return vehicle_rate_; }
  // Records for this time, and asks for the vehicle's clock meanwhile. Ends early, and returns false, if `cancelled`
  // returns true.
  bool record(std::chrono::milliseconds time, const std::function<bool()>& cancelled);
  // Everything since restart().
  VehicleRecording recording() const;

  bool hears_vehicle() const;  // its IMU, or its own estimate
  std::optional<Received<plant::PoseSample>> newest_tracked_pose() const;
  std::optional<ImuReport> newest_imu() const;
  std::int64_t imu_silence_ns() const;  // of this computer, since the newest sample, or since restart()

  // Who commands the vehicle: a control service that is alive, or another process that sends actuator_command; ""
  // if nobody. Commands of own_terms are those of this program.
  std::string other_controller(const std::set<std::uint32_t>& own_terms) const;

 private:
  template <class Message, class Sample>
  void take(TopicRecord<Sample>& record, const Message& message);
  void take_command(const messages::msg::ActuatorCommand& command);
  void count_peer(const dds::PeerEvent& event);
  void ask_clock();

  const std::string vehicle_;
  const std::uint64_t client_;
  std::atomic<double> vehicle_rate_{1.0};
  std::atomic<std::int64_t> rated_since_ns_{0};  // monotonic
  mutable std::mutex mutex_;                     // guards all below, up to the node; held briefly
  VehicleRecording recording_;
  int controllers_ = 0;             // announced
  std::int64_t controller_ns_ = 0;  // last controller_state
  struct HeardCommand {
    std::uint32_t term = 0;
    std::int64_t received_ns = 0;
  };
  std::vector<HeardCommand> commands_;  // the last of each term

  dds::Node node_;
  std::uint64_t clock_requests_ = 0;
  dds::Publisher<messages::msg::ClockRequest> clock_;
  // Last: their callbacks use all members above.
  dds::Subscription imu_, odometry_, battery_, mocap_, rotor_speeds_, info_, clock_replies_,
      controller_states_, actuator_commands_;
};

}  // namespace swiftlet::ground
