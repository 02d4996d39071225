#include "swiftlet/analysis/tuning/delay_design.hpp"

#include <fmt/core.h>

#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/design/flown_delay.hpp"

namespace swiftlet::analysis {
namespace {

constexpr double kFactorAccuracy = 1e-3;

struct NamedWeights {
  const char* name;
  control::LqrWeights control::AttitudeSettings::*weights;
};
constexpr NamedWeights kAttitudeAxes[] = {{"roll", &control::AttitudeSettings::roll},
                                          {"pitch", &control::AttitudeSettings::pitch},
                                          {"yaw", &control::AttitudeSettings::yaw}};

struct NamedRpt {
  const char* name;
  control::RptSettings control::PositionSettings::*settings;
};
constexpr NamedRpt kPositionAxes[] = {{"x", &control::PositionSettings::x},
                                      {"y", &control::PositionSettings::y},
                                      {"z", &control::PositionSettings::z}};

control::LoopsAtDelay loops_of(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                               const CommandLevel& commanded) {
  const control::ControlDesign design = control::design(vehicle, settings);
  const control::ControlGains gains = control::control_gains(design, settings);
  const control::ObservedRotors rotors = control::observed_rotors(design.rotor_lag_s, settings);
  return [gains, rotors, commanded](double delay_s) {
    if (commanded.level == plant::ControlLevel::kActuators)
      return control::flown_loops(gains, rotors, delay_s);
    return control::level_loops(commanded.level, gains, rotors, commanded.vehicle, delay_s);
  };
}

}  // namespace

// The angle is the second integral of the command, and the cost of the LQR is homogeneous in time.
control::ControlSettings slowed(const control::ControlSettings& settings, double factor) {
  control::ControlSettings out = settings;
  const double squared = factor * factor;
  for (const NamedWeights& axis : kAttitudeAxes) {
    Eigen::Vector3d& q = (out.attitude.*axis.weights).q;
    q[0] *= squared * squared;
    q[1] *= squared;
  }
  for (const NamedRpt& axis : kPositionAxes) {
    (out.position.*axis.settings).omega_n *= factor;
    (out.position.*axis.settings).integral_pole *= factor;
  }
  out.disturbance.bandwidth *= factor;
  return out;
}

DelayDesign design_for_delay(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                             double delay_s, const CommandLevel& commanded) {
  const auto least_margin_s = [&](double factor) {
    return control::least_delay_margin(loops_of(vehicle, slowed(settings, factor), commanded));
  };
  const auto suffices = [&](double factor) { return least_margin_s(factor) >= kDelayReserve * delay_s; };
  double factor = 1.0;
  if (!suffices(factor)) {
    double below = kLeastBandwidthFactor;
    if (!suffices(below)) {
      throw std::invalid_argument(fmt::format(
          "no gains for a delay of {:.0f} ms: even loops of {:.0f} % of the bandwidth tolerate "
          "only {:.0f} ms, "
          "and must tolerate {:.0f} ms",
          1e3 * delay_s, 100.0 * below, 1e3 * least_margin_s(below), 1e3 * kDelayReserve * delay_s));
    }
    double above = 1.0;
    while (above - below > kFactorAccuracy) {
      const double middle = 0.5 * (below + above);
      (suffices(middle) ? below : above) = middle;
    }
    factor = below;
  }
  DelayDesign out{factor, slowed(settings, factor)};
  out.margins_s = control::delay_margins(loops_of(vehicle, out.settings, commanded));
  return out;
}

std::vector<std::pair<std::string, std::string>> slowed_values(const control::ControlSettings& to) {
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  std::vector<std::pair<std::string, std::string>> out = {{"name", to.name}};
  for (const NamedWeights& axis : kAttitudeAxes) {
    const control::LqrWeights& weights = to.attitude.*axis.weights;
    for (int i = 0; i < 2; ++i)
      out.emplace_back(fmt::format("attitude.{}.q[{}]", axis.name, i), number(weights.q[i]));
  }
  for (const NamedRpt& axis : kPositionAxes) {
    const control::RptSettings& rpt = to.position.*axis.settings;
    out.emplace_back(fmt::format("position.{}.omega_n", axis.name), number(rpt.omega_n));
    out.emplace_back(fmt::format("position.{}.integral_pole", axis.name), number(rpt.integral_pole));
  }
  out.emplace_back("disturbance.bandwidth_rad_s", number(to.disturbance.bandwidth));
  return out;
}

}  // namespace swiftlet::analysis
