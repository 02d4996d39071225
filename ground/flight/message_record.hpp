// flight.mcap of a flight's record: every message of its vehicles.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/recording/flight_recorder.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Receives with a participant of its own, beside the flight. In lockstep the times in the file are simulated time.
class MessageRecord {
 public:
  // Begins the file in the fleet's folder, with the flight's settings as metadata and its files as attachments. Throws
  // std::runtime_error.
  MessageRecord(const comms::NodeSettings& network, const Fleet& fleet);

  // Adds the lines of the processes' logs to a file in real time, and ends it. The processes have ended.
  // Returns a sentence if it is not complete.
  std::string finish();

 private:
  comms::Participant participant_;
  FlightRecorder recorder_;
  const std::filesystem::path folder_;
  const bool simulated_time_;
};

}  // namespace swiftlet::ground
