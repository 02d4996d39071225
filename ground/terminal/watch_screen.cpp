#include "swiftlet/ground/terminal/watch_screen.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using comms::wire::vector;
using control::Mode;
using Eigen::Vector3d;

constexpr double kSilence_s = 1.0;
constexpr double kFarOff_m = 0.1;    // tracking error
constexpr double kLateSteps = 0.01;  // share of the control steps
constexpr const char* kKeys = "h hold   l land   s stop (rotors off)   q quit";

Mode mode_of(const View& view) { return static_cast<Mode>(view.control.message.mode()); }

bool flies(const View& view) { return !control::rotors_off(mode_of(view)) && mode_of(view) != Mode::kArmed; }

// Voltage below which a battery failsafe acts. A vehicle that publishes 0 does not say: then the default of
// the control settings is assumed.
struct Threshold {
  double voltage_v = 0.0;
  bool assumed = false;
};

Threshold threshold(double published_v, double default_v) {
  return published_v > 0.0 ? Threshold{published_v, false} : Threshold{default_v, true};
}
Threshold low_battery(const View& view) {
  return threshold(view.control.message.low_battery_voltage_v(),
                   control::FailsafeSettings().low_battery_voltage);
}
Threshold critical_battery(const View& view) {
  return threshold(view.control.message.critical_battery_voltage_v(),
                   control::FailsafeSettings().critical_battery_voltage);
}

std::string below(const Threshold& threshold) {
  return fmt::format("below {:.2f} V{}", threshold.voltage_v, threshold.assumed ? " (assumed)" : "");
}

void warn_of_battery(const View& view, std::vector<std::string>& warnings) {
  if (!view.battery.seen()) return;
  const double voltage_v = view.battery.message.voltage_v();
  const Threshold low = low_battery(view), critical = critical_battery(view);
  if (voltage_v < critical.voltage_v) {
    warnings.push_back(fmt::format("battery is critical: {:.2f} V, ", voltage_v) + below(critical));
  } else if (voltage_v < low.voltage_v) {
    warnings.push_back(fmt::format("battery is low: {:.2f} V, ", voltage_v) + below(low));
  }
}

double off_reference_m(const View& view) {
  return (vector(view.estimate.message.position_ned()) - vector(view.reference.message.position_ned()))
      .norm();
}

std::string of_vector(const char* name, const Vector3d& v, const char* unit) {
  return fmt::format("{:<11} {:8.3f} {:8.3f} {:8.3f} {}", name, v.x(), v.y(), v.z(), unit);
}

// ".....#....|.........." from -limit to limit.
std::string bar(double value, double limit, int width) {
  std::string text(static_cast<std::size_t>(width), '.');
  const double part = std::clamp(0.5 + 0.5 * value / limit, 0.0, 1.0);
  text[static_cast<std::size_t>(width / 2)] = '|';
  text[static_cast<std::size_t>(std::lround(part * (width - 1)))] = '#';
  return text;
}

std::string gauge(double part, int width) {
  const auto full = static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 1.0) * width));
  return std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, '.');
}

class Screen {
 public:
  Screen(int width, int height) : width_(std::max(width, 1)), height_(std::max(height, 1)) {}

  void add(std::string text, Emphasis emphasis = Emphasis::kPlain) {
    if (static_cast<int>(lines_.size()) + 1 < height_) lines_.push_back({cut(std::move(text)), emphasis});
  }
  // Fills the screen with empty lines, and adds the last line.
  std::vector<ScreenLine> close(std::string last, Emphasis emphasis) {
    while (static_cast<int>(lines_.size()) + 1 < height_) lines_.push_back({"", Emphasis::kPlain});
    lines_.push_back({cut(std::move(last)), emphasis});
    return std::move(lines_);
  }

 private:
  std::string cut(std::string text) const {
    if (static_cast<int>(text.size()) > width_) text.resize(static_cast<std::size_t>(width_));
    return text;
  }

  int width_, height_;
  std::vector<ScreenLine> lines_;
};

void show_motion(const View& view, Screen& screen) {
  if (!view.estimate.seen()) return;
  const msg::Estimate& estimate = view.estimate.message;
  const Vector3d position = vector(estimate.position_ned());
  screen.add("              north     east     down", Emphasis::kHeading);
  screen.add(of_vector("position", position, "m"));
  if (view.reference.seen()) {
    const Vector3d reference = vector(view.reference.message.position_ned());
    const Vector3d off_mm = 1e3 * (position - reference);
    screen.add(of_vector("reference", reference, "m"));
    screen.add(fmt::format("{:<11} {:8.1f} {:8.1f} {:8.1f} mm   3-D {:.1f} mm", "error", off_mm.x(),
                           off_mm.y(), off_mm.z(), off_mm.norm()),
               off_mm.norm() > 1e3 * kFarOff_m && flies(view) ? Emphasis::kWarning : Emphasis::kPlain);
    for (int i = 0; i < 3; ++i)
      screen.add(fmt::format("  {:<9} [{}] 100 mm",
                             i == 0   ? "north"
                             : i == 1 ? "east"
                                      : "down",
                             bar(off_mm[i], 100.0, 41).c_str()));
  }
  screen.add(of_vector("velocity", vector(estimate.velocity_ned()), "m/s"));
}

void show_power(const View& view, Screen& screen) {
  if (!view.battery.seen()) return;
  const msg::Battery& battery = view.battery.message;
  screen.add(fmt::format("{:<11} {:5.2f} V  {:5.2f} A  [{}] {:3.0f} %   lands {}", "battery",
                         battery.voltage_v(), battery.current_a(),
                         gauge(battery.state_of_charge(), 20).c_str(), 100.0 * battery.state_of_charge(),
                         below(low_battery(view)).c_str()));
}

void show_timing(const View& view, const WatchFacts& facts, Clock::time_point now, Screen& screen) {
  const msg::ControlStatus& control = view.control.message;
  screen.add(fmt::format("{:<11} estimate {:.0f} Hz, poses {:.0f} Hz, battery {:.0f} Hz; pose {:.3f} s old",
                         "rates", facts.estimate_hz, facts.pose_hz, facts.battery_hz, control.pose_age_s()));
  if (view.vehicle.seen()) {
    const msg::VehicleInfo& vehicle = view.vehicle.message;
    screen.add(fmt::format("{:<11} sense to actuate p50 {:.0f}, p99 {:.0f}, max {:.0f} us; IMU {:.0f} Hz",
                           "latency", vehicle.sense_to_actuate_p50_us(), vehicle.sense_to_actuate_p99_us(),
                           vehicle.sense_to_actuate_max_us(), vehicle.imu_rate_hz()));
  }
  screen.add(fmt::format("{:<11} {:.1f} Hz, {} of {} steps late, longest {:.0f} us", "control",
                         control.rate_hz(), static_cast<unsigned long long>(control.deadline_misses()),
                         static_cast<unsigned long long>(control.cycles()), control.step_time_max_us()));
  int controllers = 0;
  for (const auto& [number, latest] : view.controllers) controllers += latest.age_s(now) < kSilence_s ? 1 : 0;
  screen.add(fmt::format("{:<11} {}, of which {} on standby", "controllers", controllers,
                         std::max(controllers - 1, 0)));
}

}  // namespace

std::vector<std::string> warnings_of(const View& view, Clock::time_point now) {
  std::vector<std::string> warnings;
  if (!view.control.seen()) return {"no control service"};
  const msg::ControlStatus& control = view.control.message;
  if (view.control.age_s(now) > kSilence_s)
    warnings.push_back(fmt::format("no control status for {:.0f} s", view.control.age_s(now)));
  if (mode_of(view) == Mode::kStopped)
    warnings.push_back("rotors stopped: " + std::string(control.reason().c_str()));
  if (view.vehicle.seen() && view.vehicle.message.fault().size() > 0)
    warnings.push_back("vehicle: " + std::string(view.vehicle.message.fault().c_str()));
  if (!control.has_pose()) warnings.push_back(fmt::format("no pose for {:.1f} s", control.pose_age_s()));
  if (view.estimate.seen() && view.estimate.message.pose_fault() != msg::Estimate_Constants::POSE_FAULT_NONE)
    warnings.push_back(std::string("poses are refused: ") +
                       pose_fault_name(view.estimate.message.pose_fault()));
  warn_of_battery(view, warnings);
  if (flies(view) && view.estimate.seen() && view.reference.seen() && off_reference_m(view) > kFarOff_m)
    warnings.push_back(fmt::format("tracking error {:.2f} m", off_reference_m(view)));
  if (control.saturated()) warnings.emplace_back("commands saturate at the rotor limits");
  if (static_cast<double>(control.deadline_misses()) > kLateSteps * static_cast<double>(control.cycles()))
    warnings.push_back(fmt::format(
        "{:.1f} % of the control steps are late",
        100.0 * static_cast<double>(control.deadline_misses()) / static_cast<double>(control.cycles())));
  if (mode_of(view) == Mode::kSetpoint && control.setpoint_refusal().size() > 0)
    warnings.emplace_back(control.setpoint_refusal().c_str());
  return warnings;
}

std::vector<ScreenLine> watch_screen(const View& view, const WatchFacts& facts, Clock::time_point now,
                                     int width, int height) {
  Screen screen(width, height);
  const msg::ControlStatus& control = view.control.message;
  const std::string last = facts.message.empty() ? kKeys : facts.message;
  const Emphasis emphasis = facts.message.empty() ? Emphasis::kPlain : Emphasis::kHeading;
  if (!view.control.seen()) {
    screen.add(fmt::format("{} in domain {}", facts.vehicle.c_str(), facts.domain), Emphasis::kHeading);
    screen.add("waiting: " + facts.where, Emphasis::kWarning);
    return screen.close(last, emphasis);
  }
  screen.add(fmt::format("{} in domain {}: {} ({}), {}", facts.vehicle.c_str(), facts.domain,
                         mode_name(control.mode()), control.reason().c_str(),
                         control.airborne() ? "airborne" : "on the ground"),
             Emphasis::kHeading);
  const std::vector<std::string> warnings = warnings_of(view, now);
  for (const std::string& warning : warnings) screen.add("! " + warning, Emphasis::kWarning);
  if (warnings.empty()) screen.add("no warnings", Emphasis::kGood);
  show_motion(view, screen);
  show_power(view, screen);
  const msg::MissionStatus& mission = view.mission.message;
  if (mission.state() != msg::MissionStatus_Constants::NONE) {
    screen.add(fmt::format("{:<11} {}, item {} of {}", "mission", mission_state_name(mission.state()),
                           mission.item_index() + 1, mission.item_count()));
  }
  show_timing(view, facts, now, screen);
  return screen.close(last, emphasis);
}

std::string watch_line(const View& view, const WatchFacts& facts, Clock::time_point now) {
  std::string line;
  if (view.control.seen()) {
    const msg::ControlStatus& control = view.control.message;
    line = fmt::format("{}: {} ({})", facts.vehicle.c_str(), mode_name(control.mode()),
                       control.reason().c_str());
    if (view.estimate.seen()) {
      const auto& p = view.estimate.message.position_ned();
      line += fmt::format(", at ({:.3f}, {:.3f}, {:.3f}) m", p[0], p[1], p[2]);
    }
    if (view.reference.seen() && view.estimate.seen())
      line += fmt::format(", error {:.1f} mm", 1e3 * off_reference_m(view));
    if (view.battery.seen()) line += fmt::format(", {:.2f} V", view.battery.message.voltage_v());
    line += fmt::format(", poses {:.0f} Hz", facts.pose_hz);
    for (const std::string& warning : warnings_of(view, now)) line += "; ! " + warning;
    return line;
  }
  return facts.vehicle + ": waiting: " + facts.where;
}

}  // namespace swiftlet::ground
