// What the MCAP file of a flight says about it.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/record/mcap/records.hpp"
#include "swiftlet/record/mcap/writer.hpp"

namespace swiftlet::ground {

mcap::WriterSettings writer_settings(const std::string& program);

// Metadata swiftlet/flight: vehicles, missions, and unless the flight is attached to running processes its settings. vehicle: the
// model of the first; models: of all.
mcap::Metadata flight_metadata(const Fleet& fleet);

// The files of a flight by the names that they have in its record: vehicle.yaml and so on. Missions and vehicles that
// differ from those of the first are called kl2/mission.yaml. Throws ConfigError if a file cannot be read.
std::vector<mcap::Attachment> flight_attachments(const Fleet& fleet);

}  // namespace swiftlet::ground
