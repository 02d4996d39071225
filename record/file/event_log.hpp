// The events of a vehicle as lines of a log, of type foxglove Log, which Foxglove's log panel shows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/record/file/standard_message.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::record {

enum class LogLevel : std::uint8_t { kDebug = 1, kInfo = 2, kWarning = 3, kError = 4, kFatal = 5 };

// A line of type foxglove Log. time_ns: since 1970. name: who says it.
StandardMessage log_message(const std::string& topic, std::int64_t time_ns, LogLevel level,
                            const std::string& name, const std::string& text);

// Lines follow from
//   control_status   mode and reason when they change, refused setpoints, conflicts of sources
//   mission_status   state of the mission when it changes
//   command_ack      whether a request was accepted, and why not
//   vehicle_info     faults when they change, rotors started and stopped
class EventLog {
 public:
  explicit EventLog(std::string vehicle);

  StandardTopic topic() const;

  // The lines that follow from one of the vehicle's messages, at its log time. topic: "control_status" ...
  std::vector<StandardMessage> of(const std::string& topic, const mcap::Message& message);

 private:
  StandardMessage line(std::int64_t time_ns, LogLevel level, const char* process,
                       const std::string& text) const;
  void of_control_status(const mcap::Message& message, std::vector<StandardMessage>& lines);
  void of_mission_status(const mcap::Message& message, std::vector<StandardMessage>& lines);
  void of_command_ack(const mcap::Message& message, std::vector<StandardMessage>& lines) const;
  void of_vehicle_info(const mcap::Message& message, std::vector<StandardMessage>& lines);

  std::string vehicle_;
  std::string mode_;  // last lines
  std::string source_conflict_;
  std::string setpoint_refusal_;
  std::string mission_;
  std::string fault_;
  std::optional<bool> rotors_running_;
};

}  // namespace swiftlet::record
