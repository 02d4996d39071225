// A flight of one vehicle over DDS: flies the mission, writes record and report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/flight/process_group.hpp"
#include "swiftlet/ground/flight/start_barrier.hpp"
#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/ground/terminal/progress.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

class ProcessFlight {
 public:
  // network.vehicle names the vehicle. The processes and the participant are shared with the other vehicles of the
  // flight and must outlive this object. Throws std::runtime_error.
  ProcessFlight(LaunchConfiguration plan, comms::NodeSettings network, ProcessGroup& processes,
                const comms::Participant& participant);

  // Flies the mission. barrier: shared with the other vehicles of the flight; null for a single one. Call once, from any
  // thread. The vehicle is attended to until finish().
  void fly(const Interrupts& interrupts, StartBarrier* barrier, Progress& progress);

  // Writes the record, once the processes have ended. end_errors: what ProcessGroup::stop() returned. Throws
  // std::runtime_error if the record cannot be written.
  void finish(const std::vector<std::string>& end_errors, Progress& progress);

  // Until finish().
  Client& client() { return *client_; }
  const FlightReport& report() const { return report_; }
  const std::string& vehicle_name() const { return network_.vehicle; }

 private:
  LaunchConfiguration plan_;
  comms::NodeSettings network_;
  FlightRecord record_;
  FlightReport report_;
  Window window_;
  ProcessGroup& processes_;
  std::optional<Client> client_;  // last: records into the members above
};

}  // namespace swiftlet::ground
