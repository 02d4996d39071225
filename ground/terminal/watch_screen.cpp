#include "swiftlet/ground/terminal/watch_screen.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/ground/terminal/clock_text.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using Eigen::Vector3d;
using messages::wire::vector;

constexpr double kFarOff_m = 0.1;    // tracking error
constexpr double kLateSteps = 0.01;  // share of the control steps
constexpr const char* kKeys = "h hold   l land   s stop (rotors off): each asks for y   q quit";
constexpr const char* kShortKeys = "h hold l land s stop q quit";
constexpr std::size_t kFullWidth = 80;  // a screen of this size shows everything
constexpr std::size_t kFullHeight = 24;

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

using Lines = std::vector<ScreenLine>;

void add(Lines& lines, std::string text, Emphasis emphasis = Emphasis::kPlain) {
  lines.push_back({std::move(text), emphasis});
}

// Breaks the text at blanks into lines of at most `width` characters; the further lines are indented.
std::vector<std::string> wrapped(std::string text, std::size_t width) {
  constexpr std::size_t kIndent = 2;
  std::vector<std::string> lines;
  while (text.size() > width && width > 2 * kIndent) {
    const std::size_t blank = text.rfind(' ', width);
    const bool breaks = blank != std::string::npos && blank > kIndent;
    lines.push_back(text.substr(0, breaks ? blank : width));
    text = std::string(kIndent, ' ') + text.substr(breaks ? blank + 1 : width);
  }
  lines.push_back(std::move(text));
  return lines;
}

class Screen {
 public:
  Screen(int width, int height) : width_(at_least_one(width)), height_(at_least_one(height)) {}

  void add(ScreenLine line) {
    if (lines_.size() + 1 >= height_) {
      incomplete_ = true;
      return;
    }
    cut(line);
    lines_.push_back(std::move(line));
  }
  void add_wrapped(const std::string& text, Emphasis emphasis) {
    for (const std::string& line : wrapped(text, width_)) add({line, emphasis});
  }
  // Side by side on a wide screen, else one after the other.
  void add_columns(const Lines& left, const Lines& right) {
    if (width_ < static_cast<std::size_t>(kWideScreen)) {
      for (const Lines* const column : {&left, &right}) {
        for (const ScreenLine& line : *column) add(line);
      }
      return;
    }
    for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
      ScreenLine line = i < left.size() ? left[i] : ScreenLine();
      if (i < right.size()) {
        line.right_text = right[i].text;
        line.right_emphasis = right[i].emphasis;
      }
      add(std::move(line));
    }
  }
  // Fills the screen with empty lines, and puts the last ones below.
  Lines close(const std::vector<std::string>& last, Emphasis emphasis) {
    Lines below;
    for (const std::string& text : last) {
      below.push_back({text, emphasis});
      cut(below.back());
    }
    const bool overflows = lines_.size() + below.size() > height_;
    if ((incomplete_ || overflows) && height_ >= static_cast<std::size_t>(kNoteHeight)) {
      below.push_back({too_small(), Emphasis::kWarning});
      cut(below.back());
    }
    if (below.size() > height_) below.resize(height_);
    lines_.resize(height_ - below.size());
    lines_.insert(lines_.end(), below.begin(), below.end());
    return std::move(lines_);
  }
  std::size_t width() const { return width_; }

 private:
  static std::size_t at_least_one(int size) { return static_cast<std::size_t>(std::max(size, 1)); }
  bool is_small() const { return width_ < kFullWidth || height_ < kFullHeight; }
  const char* too_small() const {
    return is_small() ? "terminal too small, 80x24 shows all" : "terminal too small for all lines";
  }
  void cut(ScreenLine& line) {
    const std::string whole = line.text;
    line.text = cut_to(line.text, width_);
    line.right_text = cut_to(line.right_text, width_ > kRightColumn ? width_ - kRightColumn : 0);
    if (is_small() && line.text != whole) incomplete_ = true;
  }

  bool incomplete_ = false;  // a line is left out, or cut on a small screen
  std::size_t width_, height_;
  Lines lines_;
};

Lines motion_of(const View& view) {
  Lines lines;
  if (!view.estimate.seen()) return lines;
  const msg::Estimate& estimate = view.estimate.message;
  const Vector3d position = vector(estimate.position_ned());
  add(lines, "              north     east     down", Emphasis::kHeading);
  add(lines, of_vector("position", position, "m"));
  add(lines, of_vector("velocity", vector(estimate.velocity_ned()), "m/s"));
  add(lines, fmt::format("{:<11} {}", "attitude", attitude_text(estimate)));
  if (!view.reference.seen()) return lines;
  const Vector3d reference = vector(view.reference.message.position_ned());
  const Vector3d off_mm = 1e3 * (position - reference);
  add(lines, of_vector("reference", reference, "m"));
  add(lines,
      fmt::format("{:<11} {:8.1f} {:8.1f} {:8.1f} mm   3-D {:.1f} mm", "error", off_mm.x(), off_mm.y(),
                  off_mm.z(), off_mm.norm()),
      off_mm.norm() > 1e3 * kFarOff_m && flies(view) ? Emphasis::kWarning : Emphasis::kPlain);
  constexpr const char* kAxes[] = {"north", "east", "down"};
  for (int i = 0; i < 3; ++i)
    add(lines, fmt::format("  {:<9} [{}] 100 mm", kAxes[i], bar(off_mm[i], 100.0, 37)));
  return lines;
}

void add_power(const View& view, Lines& lines) {
  if (!view.battery.seen()) return;
  const msg::Battery& battery = view.battery.message;
  add(lines, fmt::format("{:<11} {:5.2f} V  {:5.2f} A   lands {}", "battery", battery.voltage_v(),
                         battery.current_a(), below(low_battery(view))));
  add(lines, fmt::format("{:<11} [{}] {:3.0f} %", "", gauge(battery.state_of_charge(), 20),
                         100.0 * battery.state_of_charge()));
}

void add_mission(const View& view, Lines& lines) {
  const msg::MissionStatus& mission = view.mission.message;
  if (mission.state() == msg::MissionStatus_Constants::NONE) return;
  add(lines, fmt::format("{:<11} {}, item {} of {}", "mission", mission_state_name(mission.state()),
                         mission.item_index() + 1, mission.item_count()));
}

void add_timing(const View& view, const WatchFacts& facts, Clock::time_point now, Lines& lines) {
  const msg::ControlStatus& control = view.control.message;
  add(lines, fmt::format("{:<11} estimate {:.0f} Hz, poses {:.0f} Hz, battery {:.0f} Hz", "rates",
                         facts.estimate_hz, facts.pose_hz, facts.battery_hz));
  add(lines, fmt::format("{:<11} {:.3f} s old", "pose", pose_age_s(view, now)));
  const std::string odometry = odometry_text(control);
  if (!odometry.empty()) add(lines, fmt::format("{:<11} {}", "odometry", odometry));
  if (view.vehicle.seen()) {
    const msg::VehicleInfo& vehicle = view.vehicle.message;
    add(lines, fmt::format("{:<11} sense to actuate, us: p50 {:.0f}, p99 {:.0f}, max {:.0f}", "latency",
                           vehicle.sense_to_actuate_p50_us(), vehicle.sense_to_actuate_p99_us(),
                           vehicle.sense_to_actuate_max_us()));
    add(lines, fmt::format("{:<11} {:.0f} Hz", "IMU", vehicle.imu_rate_hz()));
  }
  if (view.clock.seen()) add(lines, fmt::format("{:<11} {}", "clock", clock_text(view.clock.message)));
  add(lines, fmt::format("{:<11} {:.1f} Hz, {} of {} steps late, longest {:.0f} us", "control",
                         control.rate_hz(), static_cast<unsigned long long>(control.deadline_misses()),
                         static_cast<unsigned long long>(control.cycles()), control.step_time_max_us()));
  const LiveControllers controllers = controllers_of(view, now);
  const auto active = std::count_if(controllers.known.begin(), controllers.known.end(),
                                    [](const LiveController& controller) { return controller.active; });
  const std::string others = controllers.others > 0 ? fmt::format(", {} unknown", controllers.others) : "";
  add(lines, fmt::format("{:<11} {} active, {} standby{}", "controllers", active,
                         static_cast<std::ptrdiff_t>(controllers.known.size()) - active, others));
}

const char* last_known(const std::vector<Silence>& silences) {
  return control_is_silent(silences) ? "last known: " : "";
}

}  // namespace

std::string cut_to(const std::string& text, std::size_t columns) {
  std::size_t cut_at = 0;  // the byte of the last column
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
    if (!begins) continue;
    if (++characters == columns) cut_at = i;
  }
  if (characters <= columns) return text;
  return columns > 0 ? text.substr(0, cut_at) + kCut : "";
}

std::vector<std::string> warnings_of(const View& view, Clock::time_point now) {
  std::vector<std::string> warnings;
  if (!view.control.seen()) return {"no control service"};
  const msg::ControlStatus& control = view.control.message;
  if (control.source_conflict().size() > 0) warnings.emplace_back(control.source_conflict().c_str());
  if (control.delay_near_margin())
    warnings.push_back(fmt::format("delay of the loop {:.0f} ms, unstable from {:.0f} ms on",
                                   1e3 * control.loop_delay_p95_s(), 1e3 * control.delay_margin_s()));
  if (mode_of(view) == Mode::kStopped)
    warnings.push_back("rotors stopped: " + std::string(control.reason().c_str()));
  if (view.vehicle.seen() && view.vehicle.message.fault().size() > 0)
    warnings.push_back("vehicle: " + std::string(view.vehicle.message.fault().c_str()));
  if (!control.has_pose()) warnings.push_back(fmt::format("no pose for {:.1f} s", pose_age_s(view, now)));
  if (view.clock.seen() && !view.clock.message.known())
    warnings.emplace_back("poses are withheld: the clock of motion capture is unknown");
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
  const auto close = [&] {
    if (!facts.message.empty())
      return screen.close(wrapped(facts.message, screen.width()), Emphasis::kHeading);
    const std::string keys = kKeys;
    return screen.close({keys.size() <= screen.width() ? keys : kShortKeys}, Emphasis::kPlain);
  };
  if (!view.control.seen()) {
    screen.add({fmt::format("{} in domain {}", facts.vehicle, facts.domain), Emphasis::kHeading});
    screen.add_wrapped("waiting: " + facts.where, Emphasis::kWarning);
    return close();
  }
  const std::vector<Silence> silences = silences_of(view, now);
  for (const Silence& silence : silences)
    screen.add_wrapped(to_string(silence, facts.system_now), Emphasis::kWarning);
  screen.add_wrapped(fmt::format("{} in domain {}: {}{} ({}), {}", facts.vehicle, facts.domain,
                                 last_known(silences), mode_name(control.mode()), control.reason().c_str(),
                                 control.airborne() ? "airborne" : "on the ground"),
                     Emphasis::kHeading);
  const std::vector<std::string> warnings = warnings_of(view, now);
  for (const std::string& warning : warnings) screen.add_wrapped("! " + warning, Emphasis::kWarning);
  if (warnings.empty() && silences.empty()) screen.add({"no warnings", Emphasis::kGood});
  Lines right;
  add_power(view, right);
  add_mission(view, right);
  add_timing(view, facts, now, right);
  screen.add_columns(motion_of(view), right);
  return close();
}

std::string watch_line(const View& view, const WatchFacts& facts, Clock::time_point now) {
  if (!view.control.seen()) return facts.vehicle + ": waiting: " + facts.where;
  const msg::ControlStatus& control = view.control.message;
  std::string line = facts.vehicle + ": ";
  const std::vector<Silence> silences = silences_of(view, now);
  for (const Silence& silence : silences) line += to_string(silence, facts.system_now) + "; ";
  line += last_known(silences);
  line += fmt::format("{} ({})", mode_name(control.mode()), control.reason().c_str());
  if (view.estimate.seen()) {
    const auto& p = view.estimate.message.position_ned();
    line += fmt::format(", at ({:.3f}, {:.3f}, {:.3f}) m, {}", p[0], p[1], p[2],
                        attitude_text(view.estimate.message));
  }
  if (view.reference.seen() && view.estimate.seen())
    line += fmt::format(", error {:.1f} mm", 1e3 * off_reference_m(view));
  if (view.battery.seen()) line += fmt::format(", {:.2f} V", view.battery.message.voltage_v());
  line += fmt::format(", poses {:.0f} Hz", facts.pose_hz);
  for (const std::string& warning : warnings_of(view, now)) line += "; ! " + warning;
  return line;
}

}  // namespace swiftlet::ground
