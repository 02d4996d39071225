#include "swiftlet/services/plant/autopilot_settings.hpp"

#include <fmt/core.h>

namespace swiftlet::services {

std::string AutopilotSettings::description() const {
  return device.empty() ? fmt::format("MAVLink on TCP port {}", port)
                        : fmt::format("MAVLink on {:.64}", device);
}

}  // namespace swiftlet::services
