// A flight of one vehicle over DDS: starts its processes, flies the mission, writes record and report.
#pragma once

#include <filesystem>

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
  // Creates the record's folder and starts the plan's processes, which end with the calling thread. Throws
  // InputError or std::runtime_error; no process is running then.
  ProcessFlight(LaunchConfiguration plan, comms::NodeSettings network);

  // Flies the mission, ends the processes and writes the record. barrier: shared with the other vehicles of
  // the flight; null for a single one. Call once, from any thread. Throws std::runtime_error if the record
  // cannot be written.
  void fly(const Interrupts& interrupts, StartBarrier* barrier, Progress& progress);

  const FlightReport& report() const { return report_; }
  const std::string& vehicle_name() const { return network_.vehicle; }

 private:
  void fly_mission(const Interrupts& interrupts, StartBarrier* barrier, Progress& progress);

  LaunchConfiguration plan_;
  comms::NodeSettings network_;
  FlightRecord record_;
  FlightReport report_;
  Window window_;
  std::optional<ProcessGroup> processes_;
};

}  // namespace swiftlet::ground
