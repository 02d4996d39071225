// IMU samples and poses of a vehicle, from its topics or from a record.
#pragma once

#include <optional>
#include <string>

#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"

namespace swiftlet::ground {

// From the record of a flight, an MCAP file by `swiftlet record`, or a CSV log as for `swiftlet identify flight`. Of several
// vehicles only what is this one's; a record of another one is refused. Only what lies
// between from_s and until_s, by the clock of the log, s. Throws ConfigError, or std::runtime_error if there are no poses.
identification::FlightLog read_motion(const std::string& file, const std::string& vehicle,
                                      std::optional<double> from_s, std::optional<double> until_s);

// Receives for this time of the vehicle's clock, from the first sample of both on; at most ten times as long. Throws
// std::runtime_error if one of them does not come, or if interrupted.
identification::FlightLog receive_motion(const dds::NodeSettings& settings, double time_s,
                                         runtime::StopSignal& stop);

}  // namespace swiftlet::ground
