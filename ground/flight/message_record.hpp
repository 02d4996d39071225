// flight.mcap of a flight's record: every message of its vehicles.
#pragma once

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

  // Ends the file. Returns a sentence if it is not complete.
  std::string finish();

 private:
  comms::Participant participant_;
  FlightRecorder recorder_;
};

}  // namespace swiftlet::ground
