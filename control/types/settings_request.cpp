#include "swiftlet/control/types/settings_request.hpp"

#include <utility>

namespace swiftlet::control {

TunableSettings tunable_settings(const ControlSettings& settings) {
  return {settings.attitude.roll, settings.attitude.pitch, settings.attitude.yaw, settings.position,
          settings.disturbance};
}

ControlSettings with_tunable(ControlSettings settings, const TunableSettings& tunable) {
  settings.attitude.roll = tunable.roll;
  settings.attitude.pitch = tunable.pitch;
  settings.attitude.yaw = tunable.yaw;
  settings.position = tunable.position;
  settings.disturbance = tunable.disturbance;
  return settings;
}

SettingsRequest settings_request(const ControlSettings& settings, std::vector<FixedSetting> fixed,
                                 double ramp_s) {
  return {settings.name, ramp_s, tunable_settings(settings), std::move(fixed)};
}

}  // namespace swiftlet::control
