// flight.mcap of a flight in one process: the messages that the processes of the same flight in lockstep send, with
// simulated time as their times.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/request.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/plant/simulation/truth_schedule.hpp"
#include "swiftlet/record/file/message_file.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground {

// The samples are those that the controller received. A status comes with each change and each second, without the
// figures of processes, such as latencies.
class SimulatedRecorder {
 public:
  // Writes to the plan's folder. loop: new, must outlive the recorder. Throws std::runtime_error if the file cannot be
  // created.
  SimulatedRecorder(simulation::ClosedLoop& loop, const LaunchConfiguration& plan,
                    const std::string& program);
  ~SimulatedRecorder();
  SimulatedRecorder(const SimulatedRecorder&) = delete;
  SimulatedRecorder& operator=(const SimulatedRecorder&) = delete;

  // After each step of the loop. A flight goes on without its record: a message that cannot be written ends the file.
  void step();
  // After a request was answered.
  void request(const control::Request& request, const control::Outcome& outcome);

  // Adds the faults that began to the log, and ends the file. Returns a sentence if it is not complete.
  std::string finish(const std::vector<record::FaultRow>& faults);

 private:
  template <class T>
  void write(const messages::Topic<T>& topic, const T& message, std::int64_t time_ns);
  template <class Work>
  void attempt(const Work& work);
  void write_sample(const plant::TelemetryPacket& packet, const std::optional<plant::PoseSample>& pose);
  void write_command(std::int64_t now_ns);
  void write_telemetry();
  void write_changes();
  void write_status(const control::Status& status);
  void write_mission(const control::Status& status);
  void write_vehicle_info();

  simulation::ClosedLoop& loop_;
  const std::int64_t imu_period_ns_;
  plant::TruthSchedule truth_due_;
  const control::FailsafeSettings failsafe_;
  record::MessageFile file_;
  std::string fault_;
  std::map<std::string, std::uint16_t> channels_;  // by topic
  std::map<std::uint16_t, std::uint32_t> counts_;  // of messages, by channel
  messages::msg::VehicleInfo vehicle_info_;        // last written, as all below
  plant::LockstepInputs inputs_;
  std::uint64_t truth_sequence_ = 0;
  std::uint64_t answered_sequence_ = 0;
  std::uint64_t telemetry_sequence_ = 0;
  std::uint64_t status_sequence_ = 0;
  std::uint64_t mission_sequence_ = 0;
  std::uint64_t request_sequence_ = 0;
  std::optional<control::Status> status_;
  control::Reason mission_end_ = control::Reason::kStarted;  // why the mission was over
  std::int64_t status_ns_ = 0;
  std::int64_t mission_ns_ = 0;
  std::int64_t vehicle_info_ns_ = 0;
};

}  // namespace swiftlet::ground
