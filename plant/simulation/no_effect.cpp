#include "swiftlet/plant/simulation/no_effect.hpp"

#include <cstddef>

#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::plant {
namespace {

// Why the air does not act on the vehicle; empty if it does.
std::string still_air(const AirSettings& air, const Vehicle& vehicle) {
  if (air.rotor_drag > 0.0 || (air.drag && vehicle.linear_drag > 0.0)) return {};
  return air.drag ? "linear_drag of " + vehicle.name + " and air.rotor_drag are 0"
                  : "air.drag is false and air.rotor_drag is 0";
}

std::string reason(const Fault& fault, const SimulationSettings& settings, const Vehicle& vehicle) {
  switch (fault.kind) {
    case FaultKind::kWind:
      return still_air(settings.air, vehicle);
    case FaultKind::kRotorSpeedsStop:
      return settings.rotor_speed_rate_hz == 0.0 ? "rotor_speed_rate_hz is 0" : "";
    case FaultKind::kOdometryJump:
      return settings.odometry.source == OdometrySource::kNone ? "the vehicle has no estimate of its own"
                                                               : "";
    default:
      return {};
  }
}

}  // namespace

std::vector<std::string> settings_without_effect(const SimulationSettings& settings, const Vehicle& vehicle,
                                                 double simulated_s) {
  RuleChecker sentences;
  const std::string still = still_air(settings.air, vehicle);
  if (!still.empty() && !settings.air.wind_ned.isZero()) sentences.add("air.wind_ned_m_s", still);
  if (!still.empty() && !settings.air.gust_sigma_ned.isZero()) sentences.add("air.gust_sigma_ned_m_s", still);
  for (std::size_t i = 0; i < settings.faults.size(); ++i) {
    const Fault& fault = settings.faults[i];
    const std::string key = "faults[" + std::to_string(i) + "], " + to_string(fault.kind);
    if (fault.at_s >= simulated_s) {
      sentences.add(key, "it begins at ", fault.at_s, " s, the flight ended at ", simulated_s, " s");
    } else if (const std::string why = reason(fault, settings, vehicle); !why.empty()) {
      sentences.add(key, why);
    }
  }
  std::vector<std::string> without_effect;
  for (const Violation& found : sentences.take())
    without_effect.push_back(found.key + " has no effect: " + found.message);
  return without_effect;
}

}  // namespace swiftlet::plant
