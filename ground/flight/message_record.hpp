// flight.mcap of a flight's record: every message of its vehicles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/record/recorder/flight_recorder.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Receives with a participant of its own, beside the flight. In lockstep the times in the file are simulated time.
class MessageRecord {
 public:
  // Begins the file in the fleet's folder, with the flight's settings as metadata and its files as attachments. Throws
  // std::runtime_error.
  MessageRecord(const dds::NodeSettings& network, const Fleet& fleet);

  // Whether it has received the first samples of this vehicle: of its sensors, its motion capture and its controller.
  bool hears(const std::string& vehicle) const { return recorder_.hears(vehicle); }

  // As RecorderSettings::on_motion, of this vehicle. A new function replaces the former
  // one, which no longer runs when this returns; empty for none.
  void on_motion(const std::string& vehicle, std::function<void(std::int64_t stamp_ns)> use);

  // Adds the lines of the processes' logs to a file in real time, in lockstep the simulated faults, and ends it. The processes have
  // ended.
  // Returns a sentence if it lacks what was received. What a network has lost is counted in the file, and is no fault.
  std::string finish();

 private:
  record::RecorderSettings settings_of(const Fleet& fleet);

  std::mutex mutex_;            // guards on_motion_ and newest_ns_; held while one runs
  std::int64_t newest_ns_ = 0;  // stamp of a motion
  std::map<std::string, std::function<void(std::int64_t)>> on_motion_;
  dds::Participant participant_;
  record::FlightRecorder recorder_;
  const std::filesystem::path folder_;
  const bool simulated_time_;
  const std::vector<record::FaultRow> faults_;
};

}  // namespace swiftlet::ground
