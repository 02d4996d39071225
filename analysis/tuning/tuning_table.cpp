#include "swiftlet/analysis/tuning/tuning_table.hpp"

#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const LoopStudy& loop) {
  return {{"stable", loop.stable},
          {"crossover_rad_s", number_or_null(loop.crossover)},
          {"phase_margin_deg", number_or_null(loop.margins.phase_deg)},
          {"gain_increase_db", number_or_null(control::decibels(loop.margins.gain_increase))},
          {"gain_decrease_db", number_or_null(control::decibels(loop.margins.gain_decrease))},
          {"delay_margin_s", number_or_null(loop.margins.delay_s)},
          {"rise_time_s", number_or_null(loop.step.rise_time_s)},
          {"overshoot", number_or_null(loop.step.overshoot)},
          {"settling_time_s", number_or_null(loop.step.settling_time_s)}};
}

// A cell of the given width, with `none` for a number that is not finite.
std::string cell(double value, int width, int digits, const char* none) {
  return std::isfinite(value) ? fmt::format(" {:{}.{}f}", value, width, digits)
                              : fmt::format(" {:>{}}", none, width);
}

std::string row(const char* name, const LoopStudy& loop) {
  std::string out = fmt::format("  {:<6}", name) + cell(loop.crossover, 9, 1, "-");
  if (!loop.stable) return out + "  unstable\n";
  return out + cell(loop.margins.phase_deg, 6, 1, "any") +
         cell(control::decibels(loop.margins.gain_decrease), 7, 1, "any") +
         cell(control::decibels(loop.margins.gain_increase), 7, 1, "any") +
         cell(1e3 * loop.margins.delay_s, 7, 1, "any") + cell(loop.step.rise_time_s, 7, 2, "-") +
         cell(100.0 * loop.step.overshoot, 9, 0, "-") + cell(loop.step.settling_time_s, 8, 2, "-") + "\n";
}

}  // namespace

std::string delay_text(const TuningStudy& study) {
  const LoopDelay& delay = study.delay;
  std::string actuation;
  if (delay.actuation_s > 0.0)
    actuation = fmt::format(", {:.2f} ms to the actuator", 1e3 * delay.actuation_s);
  if (!delay.flight.empty()) actuation += ", measured in " + delay.flight;
  return fmt::format("rotor lag {:.1f} ms, delay {:.2f} ms ({:.2f} ms of sampling{})",
                     1e3 * study.rotor_lag_s, 1e3 * delay.total_s(), 1e3 * delay.sampling_s, actuation);
}

std::string tuning_table(const TuningStudy& study) {
  std::string out = study.vehicle + ": " + delay_text(study) + "; with the observers of the estimator\n" +
                    "margins of phase, gain (lower, upper) and delay; unit step: 10 to 90 %, overshoot, to "
                    "stay within 5 %\n";
  for (const SettingsStudy& settings : study.settings) {
    out += settings.name +
           "\n         crossover  phase   lower   upper   delay    rise overshoot settling"
           "\n             rad/s    deg      dB      dB      ms       s         %        s\n";
    for (std::size_t i = 0; i < settings.loops.size(); ++i)
      out += row(control::kFlownLoopNames[i], settings.loops[i]);
  }
  return out;
}

std::string tuning_json(const TuningStudy& study) {
  Json settings = Json::array();
  for (const SettingsStudy& one : study.settings) {
    Json loops = Json::object();
    for (std::size_t i = 0; i < one.loops.size(); ++i)
      loops[control::kFlownLoopNames[i]] = json_of(one.loops[i]);
    settings.push_back({{"name", one.name}, {"loops", loops}});
  }
  const Json out = {{"vehicle", study.vehicle},
                    {"rotor_lag_s", study.rotor_lag_s},
                    {"delay",
                     {{"sampling_s", study.delay.sampling_s},
                      {"actuation_s", study.delay.actuation_s},
                      {"flight", study.delay.flight}}},
                    {"settings", settings}};
  return io::json_text(out, 2);
}

}  // namespace swiftlet::analysis
