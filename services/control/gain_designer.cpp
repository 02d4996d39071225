#include "swiftlet/services/control/gain_designer.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/settings/fixed_settings.hpp"

namespace swiftlet::services {
namespace {

control::Outcome refuse(const plant::Violation& violation) {
  return control::refuse("%s: %s", violation.key.c_str(), violation.message.c_str());
}

}  // namespace

GainDesigner::GainDesigner(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                           std::vector<control::FixedSetting> fixed)
    : vehicle_(vehicle),
      settings_(settings),
      fixed_(std::move(fixed)),
      initial_(control::control_gains(control::design(vehicle, settings), settings)) {}

control::Outcome GainDesigner::check_fixed(const std::vector<control::FixedSetting>& asked) const {
  if (fixed_.empty()) return control::accept();
  for (const control::FixedSetting& setting : asked) {
    const auto own = std::find_if(fixed_.begin(), fixed_.end(),
                                  [&](const control::FixedSetting& f) { return f.key == setting.key; });
    if (own == fixed_.end())
      return control::refuse("%s: the controller has no such setting", setting.key.c_str());
    if (!io::same_setting(own->value, setting.value))
      return control::refuse("%s: cannot change in flight: is %s, the file has %s", setting.key.c_str(),
                             own->value.c_str(), setting.value.c_str());
  }
  return control::accept();
}

control::Outcome GainDesigner::design(const control::SettingsRequest& asked,
                                      const control::ControlGains& in_force,
                                      control::GainChange& change) const {
  const control::Outcome fixed = check_fixed(asked.fixed);
  if (!fixed.accepted) return fixed;
  control::ControlSettings settings = control::with_tunable(settings_, asked.tunable);
  settings.name = asked.name;
  const std::vector<plant::Violation> violations = control::validate(settings);
  if (!violations.empty()) return refuse(violations.front());
  if (settings.disturbance.bandwidth == 0.0 && in_force.disturbance_bandwidth > 0.0)
    return control::refuse(
        "disturbance.bandwidth_rad_s: cannot change to 0 in flight; disturbance.limit_m_s2: 0 switches it "
        "off");
  try {
    const control::ControlDesign design = control::design(vehicle_, settings);
    const control::ControlGains gains = control::control_gains(design, settings);
    if (const auto fault = control::unstable_change(in_force, gains, design.rotor_lag_s))
      return refuse(*fault);
    change.from = in_force;
    change.to = gains;
  } catch (const std::exception& e) {
    return control::refuse("%s", e.what());
  }
  change.name = control::settings_name(settings.name);
  change.duration_s = asked.ramp_s;
  return control::accept();
}

}  // namespace swiftlet::services
