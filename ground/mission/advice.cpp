#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kScalePrecision = 0.01;  // of a time scale
constexpr double kFirstTolerance_m = 1e-4, kLargestTolerance_m = 0.05;

class SlowestSearch {
 public:
  SlowestSearch(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                const CheckConditions& conditions)
      : vehicle_(vehicle), settings_(settings), conditions_(conditions) {
    conditions_.state_of_charge.reset();  // slower takes longer
  }

  // The least factor by which the mission must be slowed, 0 if none up to kLargestTimeScale helps.
  double slower(const io::MissionFile& file) const {
    double fails = 1.0;
    double flies = 1.0;
    do {
      fails = flies;
      flies *= 1.5;
      if (flies > io::kLargestTimeScale) return 0.0;
    } while (!can_fly_slower(file, flies));
    while (flies - fails > kScalePrecision) {
      const double middle = 0.5 * (fails + flies);
      (can_fly_slower(file, middle) ? flies : fails) = middle;
    }
    const double rounded = std::ceil(flies / kScalePrecision) * kScalePrecision;
    return can_fly_slower(file, rounded) ? rounded : flies;
  }

  // The least of some tolerances with which the samples of the file can be flown; 0 if none.
  double tolerance_m(const std::string& path, io::FileOptions options) const {
    for (double m = std::max(kFirstTolerance_m, 2.0 * options.tolerance_m.value_or(0.0));
         m <= kLargestTolerance_m; m *= 2.0) {
      options.tolerance_m = m;
      try {
        if (can_fly(io::load_mission_file(path, settings_.limits, options))) return m;
      } catch (const io::ConfigError&) {  // with this tolerance a limit is exceeded
      }
    }
    return 0.0;
  }

  bool can_fly(const io::MissionFile& file) const {
    return check_mission(file, vehicle_, settings_, conditions_).feasible();
  }

 private:
  bool can_fly_slower(const io::MissionFile& file, double factor) const {
    return can_fly(io::stretched(file, factor));
  }

  const plant::Vehicle& vehicle_;
  const control::ControlSettings& settings_;
  CheckConditions conditions_;
};

}  // namespace

std::string advice(const io::MissionFile& file, const std::string& path, const io::FileOptions& options,
                   const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                   const CheckConditions& conditions) {
  const SlowestSearch search(vehicle, settings, conditions);
  if (search.can_fly(file)) return "";  // but for the battery
  std::string text;
  if (const double slower = search.slower(file); slower > 1.0) text = io::advice_of(slower, options);
  if (io::read_source(path, options).format != io::MissionFormat::kSampledCsv) return text;
  if (const double tolerance_m = search.tolerance_m(path, options); tolerance_m > 0.0)
    text += fmt::format("{}past the samples by up to {:.3g} mm: --tolerance {:.3g}",
                        text.empty() ? "" : ", or ", tolerance_m * 1e3, tolerance_m);
  return text;
}

std::string refusal_with_advice(const io::MissionFile& file, const std::string& path,
                                const io::FileOptions& options, const plant::Vehicle& vehicle,
                                const control::ControlSettings& settings, const MissionCheck& check,
                                const CheckConditions& conditions) {
  if (check.feasible()) return "";
  const std::string help = advice(file, path, options, vehicle, settings, conditions);
  return fmt::format("{} cannot fly it: {}{}", vehicle.name, check.refusal(),
                     help.empty() ? "" : "; " + help);
}

}  // namespace swiftlet::ground
