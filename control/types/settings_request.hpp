// A request for other control settings while the controller runs. Some settings may change in flight; a
// request that changes another one is refused by its key.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// The settings that may change in flight: the keys attitude.{roll,pitch,yaw}, position and disturbance of the
// control settings file.
struct TunableSettings {
  LqrWeights roll, pitch, yaw;
  PositionSettings position;
  DisturbanceSettings disturbance;
};

TunableSettings tunable_settings(const ControlSettings& settings);
ControlSettings with_tunable(ControlSettings settings, const TunableSettings& tunable);

// A setting that cannot change in flight: key and value as in the control settings file.
struct FixedSetting {
  std::string key;    // "limits.max_speed_m_s"
  std::string value;  // "2.0", "[-3.0, -3.0, -2.5]", "rotation"
};

constexpr std::size_t kMaxFixedSettings = 192;
// The gains change over a time between these, s.
constexpr double kShortestGainChange_s = 0.5;
constexpr double kLongestGainChange_s = 60.0;

struct SettingsRequest {
  std::string name;  // of the settings, for control_status; at most kMaxSettingsName characters
  double ramp_s = 2.0;
  TunableSettings tunable;
  std::vector<FixedSetting>
      fixed;  // the sender's; the request is refused if one differs from the controller's
};

// The request for the settings of a file: those of the file that cannot change are `fixed`.
SettingsRequest settings_request(const ControlSettings& settings, std::vector<FixedSetting> fixed,
                                 double ramp_s);

}  // namespace swiftlet::control
