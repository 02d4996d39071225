// The flight controller of a vehicle of swiftlet-control, which serves one or several.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/control/control_service.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

struct ControllerSettings {
  plant::Vehicle vehicle;
  control::ControlSettings control;
  std::vector<control::FixedSetting> fixed;
  int failover_priority = 0;
  std::optional<plant::ControlLevel> level;  // nullopt: the lowest that the vehicle accepts
  runtime::Clock clock = runtime::Clock::kRealtime;
  runtime::RealtimeSettings realtime;
  messages::msg::FlownFiles files;  // of vehicle and control
};

class HostedControl final : public runtime::HostedVehicle {
 public:
  // Throws as ControlService does.
  HostedControl(const dds::Participant& participant, const std::string& name,
                const ControllerSettings& settings);

  void run(const std::atomic<bool>& stop) override { service_.run(stop); }
  void attend() override;
  bool goes_on() const override { return service_.goes_on(); }
  void log_end() override;

 private:
  void tell_files();

  dds::Node node_;
  const messages::msg::FlownFiles files_;
  dds::Publisher<messages::msg::FlownFiles> files_out_;  // while it is active
  bool has_told_files_ = false;
  ControlService service_;
};

}  // namespace swiftlet::services
