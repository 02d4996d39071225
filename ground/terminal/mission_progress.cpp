#include "swiftlet/ground/terminal/mission_progress.hpp"

#include <cmath>

#include <fmt/format.h>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::ground {

std::string state_text(const VehicleState& state) {
  const Eigen::Vector3d& position = state.position_ned_m;
  const std::string where = position.allFinite() ? fmt::format("({:5.2f}, {:5.2f}, {:5.2f}) m", position.x(),
                                                               position.y(), position.z())
                                                 : "no position yet";
  const std::string battery = std::isfinite(state.battery_voltage_v)
                                  ? fmt::format("{:.2f} V", state.battery_voltage_v)
                                  : "no battery voltage yet";
  return fmt::format("{}  {}, {}", control::to_string(state.mode), where, battery);
}

std::string mission_progress_text(const VehicleState& state) {
  return fmt::format("{}/{}  {}", state.mission.item, state.mission.items, state_text(state));
}

}  // namespace swiftlet::ground
