// Publishes and logs the reports of a simulated vehicle.
#pragma once

#include <cstdint>
#include <string>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"

namespace swiftlet::services {

class PlantReporter {
 public:
  // autopilot: what flies the vehicle in place of control; empty: control does.
  PlantReporter(dds::Node& node, const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                const std::string& autopilot);

  // Publishes vehicle_info every second, and at once when the rotors start or stop or the pause changes.
  void publish_due(const PlantReport& report);
  // Logs the figures of the whole run.
  static void log_end(const PlantReport& last);

 private:
  void log_faults(std::int64_t stamp_ns);
  void log_rotors(const PlantReport& report, const std::string& fault);
  bool log_trouble(const PlantReport& report);

  dds::Publisher<messages::msg::VehicleInfo> publisher_;
  messages::msg::VehicleInfo info_;
  std::string timeout_fault_;
  double command_hold_s_;
  std::vector<plant::Fault> faults_;  // that have not begun
  PlantReport last_report_;
  PlantReport logged_report_;
  std::int64_t due_ns_ = 0;
  std::int64_t trouble_due_ns_ = 0;
};

}  // namespace swiftlet::services
