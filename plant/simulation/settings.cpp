#include "swiftlet/plant/simulation/settings.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/setting_values.hpp"
#include "swiftlet/plant/simulation/settings_visit.hpp"
#include "swiftlet/plant/simulation/wind_model.hpp"

namespace swiftlet::plant {

namespace {

double step_s(const SimulationSettings& settings) { return static_cast<double>(settings.step_ns) * 1.0e-9; }

// Samples are taken at the ends of integration steps only.
void check_whole_steps(const std::string& key, double rate_hz, const SimulationSettings& settings,
                       RuleChecker& check) {
  if (!(rate_hz > 0.0) || settings.step_ns <= 0) return;
  const double period = 1.0e9 / rate_hz;
  const std::int64_t rounded = period_ns(rate_hz);
  if (std::abs(period - static_cast<double>(rounded)) < 1.0e-6 * period && rounded % settings.step_ns == 0)
    return;
  check.add(key, "is ", rate_hz, ", must have a period that is a whole number of steps of ", step_s(settings),
            " s");
}

// Gusts that change within a few steps would alternate in sign.
void check_dryden(const DrydenSettings& dryden, double step_s, RuleChecker& check) {
  constexpr double kLeastSteps = 10.0;
  if (!(dryden.height_m > 0.0 && dryden.airspeed_m_s > 0.0)) return;
  const double time_s = dryden_times_s(dryden).minCoeff();
  if (time_s < kLeastSteps * step_s)
    check.add("air.dryden.height_m", "is ", dryden.height_m, ": turbulence of that size passes at ",
              dryden.airspeed_m_s, " m/s in ", time_s, " s, must take at least ", kLeastSteps, " steps of ",
              step_s, " s");
}

void check_intervals(const MocapSettings& mocap, RuleChecker& check) {
  double shortest = 1.0e-4;
  for (std::size_t i = 0; i < mocap.interval_quantiles_s.size(); ++i) {
    const std::string key = "mocap.interval_quantiles_s[" + std::to_string(i) + "]";
    if (!check.between(key, mocap.interval_quantiles_s[i], shortest, 10.0)) break;
    shortest = mocap.interval_quantiles_s[i];
  }
}

}  // namespace

std::int64_t period_ns(double rate_hz) {
  return rate_hz > 0.0 ? std::llround(static_cast<double>(math::kSecond_ns) / rate_hz) : 0;
}

std::vector<Violation> validate(const SimulationSettings& settings) {
  RuleChecker check;
  check.between("step_s", step_s(settings), 1.0e-5, 1.0e-3);
  check_settings(settings, check);
  check_whole_steps("rotor_speed_rate_hz", settings.rotor_speed_rate_hz, settings, check);
  check_whole_steps("imu.rate_hz", settings.imu.rate_hz, settings, check);
  check_whole_steps("supply.rate_hz", settings.supply.rate_hz, settings, check);
  check_intervals(settings.mocap, check);
  check_dryden(settings.air.dryden, step_s(settings), check);
  check_faults(settings.faults, step_s(settings), check);
  return check.take();
}

}  // namespace swiftlet::plant
