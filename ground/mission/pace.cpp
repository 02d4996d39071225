#include "swiftlet/ground/mission/pace.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/control/design/battery_limits.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kLeastTimeScale = 0.01;
constexpr double kStep = 1.5;  // of the search for a time scale at which the mission can be flown, or not
constexpr double kScaleRatio = 1.002;  // ratio of two time scales that are told apart

// Which time scales are possible, and what stands against the others.
class FastestSearch {
 public:
  FastestSearch(const io::MissionFile& file, const plant::Vehicle& vehicle,
                const control::ControlSettings& settings, const CheckConditions& conditions)
      : file_(file), vehicle_(vehicle), settings_(settings), conditions_(conditions) {}

  Pace fastest() const {
    double fails = 1.0;
    double flies = 1.0;
    for (std::string reason = refusal(flies); !reason.empty(); reason = refusal(flies)) {
      fails = flies;
      flies *= kStep;
      if (flies > io::kLargestTimeScale)
        throw io::ConfigError(file_.name, 0, "",
                              fmt::format("cannot be flown, also {:g} times as slow: {}", fails, reason));
    }
    while (fails == flies || refusal(fails).empty()) {
      flies = fails;
      fails /= kStep;
      if (fails < kLeastTimeScale) return {flies, ""};
    }
    while (flies > kScaleRatio * fails) {
      const double middle = std::sqrt(fails * flies);
      (refusal(middle).empty() ? flies : fails) = middle;
    }
    const double digit = std::pow(10.0, std::floor(std::log10(flies)) - 2.0);
    const double rounded = std::ceil(flies / digit - 1e-9) * digit;
    return {refusal(rounded).empty() ? rounded : flies, refusal(fails)};
  }

 private:
  // Why the mission cannot be flown at this time scale; empty if it can.
  std::string refusal(double time_scale) const {
    const io::MissionFile scaled = io::stretched(file_, time_scale);
    const control::Outcome outcome = control::check(scaled.mission, settings_.limits);
    if (outcome.accepted) return check_mission(scaled, vehicle_, settings_, conditions_).refusal();
    const std::string motion = exceeded_motion(scaled.mission);
    return motion.empty() ? outcome.reason : motion;
  }

  // Where ready-made paths exceed a limit of the control settings; empty if they do not.
  std::string exceeded_motion(const control::Mission& mission) const {
    if (mission.segments.empty()) return "";
    const control::Limits limits = control::tightened(settings_.limits, mission.bounds);
    const double voltage_v = control::with_battery_limits(settings_.failsafe, vehicle_).low_battery_voltage;
    for (const control::WorstDemand& worst :
         control::worst_demands(vehicle_, limits, voltage_v, mission.segments)) {
      const bool of_motion =
          worst.demand == control::Demand::kSpeed || worst.demand == control::Demand::kAcceleration;
      if (of_motion && worst.exceeded()) return worst.sentence();
    }
    return "";
  }

  const io::MissionFile& file_;
  const plant::Vehicle& vehicle_;
  const control::ControlSettings& settings_;
  const CheckConditions& conditions_;
};

// Ready-made paths may be too fast as they are: the search slows them.
control::Limits limits_to_begin_with(const std::string& path, const io::FileOptions& options,
                                     control::Limits limits) {
  const io::MissionFormat format = io::read_source(path, options).format;
  if (format != io::MissionFormat::kPolynomialCsv && format != io::MissionFormat::kSampledCsv) return limits;
  limits.max_speed = limits.max_acceleration = std::numeric_limits<double>::infinity();
  return limits;
}

std::string sentence_of(const Pace& pace, const ReadingOptions& options) {
  const double time_scale = pace.time_scale * options.time_scale;
  if (pace.limit.empty()) return fmt::format("no limit is met: --time-scale {:.4g}", time_scale);
  return fmt::format("as fast as possible with a reserve of {:g} %: --time-scale {:.4g}; faster, {}",
                     100.0 * options.reserve, time_scale, pace.limit);
}

}  // namespace

Pace fastest_pace(const io::MissionFile& file, const plant::Vehicle& vehicle,
                  const control::ControlSettings& settings, const CheckConditions& conditions) {
  return FastestSearch(file, vehicle, settings, conditions).fastest();
}

io::MissionFile load_mission(const std::string& path, const ReadingOptions& options,
                             const plant::Vehicle& vehicle, const control::ControlSettings& settings) {
  if (!options.as_fast_as_possible) return io::load_mission_file(path, settings.limits, options);
  const Pace pace =
      fastest_pace(io::load_mission_file(path, limits_to_begin_with(path, options, settings.limits), options),
                   vehicle, settings, {Eigen::Vector2d::Zero(), {}, options.reserve});
  io::FileOptions scaled = options;
  scaled.time_scale *= pace.time_scale;
  io::MissionFile file = io::load_mission_file(path, settings.limits, scaled);
  file.assumptions.push_back(sentence_of(pace, options));
  return file;
}

io::TrajectoryFile load_trajectory(const std::string& path, const ReadingOptions& options,
                                   const plant::Vehicle& vehicle, const control::ControlSettings& settings) {
  if (!options.as_fast_as_possible) return io::load_trajectory_file(path, settings.limits, options);
  const io::TrajectoryFile given =
      io::load_trajectory_file(path, limits_to_begin_with(path, options, settings.limits), options);
  CheckConditions conditions = at_start_of(given);
  conditions.reserve = options.reserve;
  const std::string name = std::filesystem::path(path).stem();
  const Pace pace = fastest_pace(mission_of(name, given, settings), vehicle, settings, conditions);
  io::FileOptions scaled = options;
  scaled.time_scale *= pace.time_scale;
  io::TrajectoryFile file = io::load_trajectory_file(path, settings.limits, scaled);
  file.assumptions.push_back(sentence_of(pace, options));
  return file;
}

io::MissionFile mission_of(const std::string& name, const io::TrajectoryFile& path,
                           const control::ControlSettings& settings) {
  io::MissionFile file;
  file.name = name;
  file.mission.segments = path.segments;
  control::MissionItem& item = file.mission.items.emplace_back();
  item.kind = control::MissionItemKind::kTrajectory;
  item.yaw_free = false;
  item.speed = std::min(io::kApproachSpeed, settings.limits.max_speed);
  item.segment_count = static_cast<std::uint32_t>(path.segments.size());
  file.is_path = true;
  return file;
}

CheckConditions at_start_of(const io::TrajectoryFile& path) {
  return {control::evaluate(path.segments.front(), 0.0).position_ned.head<2>(), {}, 0.0};
}

}  // namespace swiftlet::ground
