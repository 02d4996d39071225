// A flight of one vehicle over DDS: flies the mission, and judges it by its record.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/flight/message_record.hpp"
#include "swiftlet/ground/flight/process_group.hpp"
#include "swiftlet/ground/flight/start_barrier.hpp"
#include "swiftlet/io/command_line/progress.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

class ProcessFlight {
 public:
  // network.vehicle names the vehicle. The processes, the participant and the record are shared with the other vehicles of the
  // flight and must outlive this object. Throws std::runtime_error.
  ProcessFlight(LaunchConfiguration plan, dds::NodeSettings network, ProcessGroup& processes,
                const dds::Participant& participant, MessageRecord& messages);
  ~ProcessFlight();
  ProcessFlight(const ProcessFlight&) = delete;
  ProcessFlight& operator=(const ProcessFlight&) = delete;

  // Flies the mission. barrier: shared with the other vehicles of the flight; null for a single one. Call once, from any
  // thread. The vehicle is attended to until finish().
  void fly(const Interrupts& interrupts, StartBarrier* barrier, io::Progress& progress);

  // Judges the flight, once processes and record have ended. end_errors: what ProcessGroup::stop() returned. record_fault: what
  // MessageRecord::finish() returned. messages: the folder of flight.mcap.
  void finish(const std::vector<std::string>& end_errors, const std::string& record_fault,
              const std::filesystem::path& messages, io::Progress& progress);

  // Null after finish().
  const std::shared_ptr<Client>& client() const { return client_; }
  const analysis::FlightReport& report() const { return report_; }
  const std::string& vehicle_name() const { return network_.vehicle; }

 private:
  LaunchConfiguration plan_;
  dds::NodeSettings network_;
  analysis::FlightReport report_;
  ProcessGroup& processes_;
  MessageRecord& messages_;
  std::shared_ptr<Client> client_;
};

}  // namespace swiftlet::ground
