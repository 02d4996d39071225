// `swiftlet teleop`: flies a vehicle by the keys of the terminal or by a gamepad.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/teleop/input_device.hpp"
#include "swiftlet/ground/teleop/key_sticks.hpp"
#include "swiftlet/ground/teleop/teleop.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/ground/terminal/terminal_screen.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kTick = 40ms;
constexpr auto kRefusalShown = 1500ms;
constexpr auto kModeTimeout = 1s;

struct TeleopOptions : CommandOptions {
  TeleopLimits limits;
  KeyTimeouts timeouts;
  std::string joystick;
};

bool is_flying(Mode mode) {
  return mode == Mode::kTakingOff || mode == Mode::kHolding || mode == Mode::kMission ||
         mode == Mode::kTrajectory || mode == Mode::kSetpoint;
}

bool accepts_setpoints(Mode mode) { return mode == Mode::kHolding || mode == Mode::kSetpoint; }

std::optional<StickKey> stick_key(int key) {
  switch (key) {
    case TerminalScreen::kUpArrow:
      return StickKey::kForward;
    case TerminalScreen::kDownArrow:
      return StickKey::kBack;
    case TerminalScreen::kLeftArrow:
      return StickKey::kLeft;
    case TerminalScreen::kRightArrow:
      return StickKey::kRight;
    case 'w':
    case 'W':
      return StickKey::kUp;
    case 's':
    case 'S':
      return StickKey::kDown;
    case 'q':
    case 'Q':
      return StickKey::kTurnLeft;
    case 'e':
    case 'E':
      return StickKey::kTurnRight;
    default:
      return std::nullopt;
  }
}

std::string position_text(const VehicleState& state) {
  std::string text =
      fmt::format("north {:6.2f}  east {:6.2f}  up {:6.2f} m   heading {:5.1f} deg", state.position_ned_m.x(),
                  state.position_ned_m.y(), -state.position_ned_m.z(), heading_deg(state.q_ned_from_frd));
  if (std::isfinite(state.battery_voltage_v)) text += fmt::format("   {:.2f} V", state.battery_voltage_v);
  return text;
}

// Flies until the pilot quits or the flight ends otherwise.
class Session {
 public:
  Session(Vehicle& vehicle, const TeleopOptions& options, std::unique_ptr<InputDevice> joystick,
          const Interrupts& interrupts)
      : vehicle_(vehicle),
        options_(options),
        joystick_(std::move(joystick)),
        interrupts_(interrupts),
        keys_(options.timeouts),
        teleop_(vehicle, options.limits),
        before_(vehicle.state().setpoints),
        refused_(before_.refused) {}

  // Returns why the flight ended, a sentence; empty if the pilot ended it.
  std::string fly(bool at_terminal) {
    std::optional<TerminalScreen> screen;  // restores the terminal after the vehicle holds
    if (at_terminal) screen.emplace("set TERM, or use --joystick with < /dev/null");
    std::string fault = screen ? fly_on(*screen) : fly_without_terminal();
    const bool holds = teleop_.finish();
    if (!holds) fault += (fault.empty() ? "" : "; ") + ("hold was not accepted: " + teleop_.hold_fault());
    return fault;
  }

  std::uint64_t sent() const { return teleop_.sent(); }
  SetpointTally tally() const { return vehicle_.state().setpoints.since(before_); }

 private:
  std::string fly_on(TerminalScreen& screen) {
    while (true) {
      screen.show(lines());
      const int wait_ms = static_cast<int>(kTick.count());
      for (std::optional<int> key = screen.key(wait_ms); key; key = screen.key(0)) {
        if (!press(*key)) return "";
      }
      if (!screen.is_open()) return "the terminal was closed";
      if (interrupts_.count() > 0) return "";
      if (std::string fault = step(); !fault.empty()) return fault;
    }
  }

  std::string fly_without_terminal() {
    io::ProgressLine progress;
    while (true) {
      progress.update(sticks().centred() ? 0 : 1, "teleop: " + status_text() + "; " + command_text());
      std::this_thread::sleep_for(kTick);
      if (interrupts_.count() > 0) return "";
      if (std::string fault = step(); !fault.empty()) return fault;
    }
  }

  // Returns why the flight has ended; empty if it goes on.
  std::string step() {
    if (joystick_ && !joystick_->update()) return "the joystick " + joystick_->name() + " was lost";
    teleop_.update(sticks());
    const VehicleState state = vehicle_.state();
    if (state.setpoints.refused != refused_) {
      refused_ = state.setpoints.refused;
      refused_at_ = Clock::now();
    }
    if (is_flying(state.mode)) return "";
    return fmt::format("the vehicle is {}: {}", control::to_string(state.mode), state.mode_reason);
  }

  // Returns false if the key quits.
  bool press(int key) {
    if (key == 'x' || key == 'X') return false;
    if (key == ' ') {
      keys_.release_all();
      teleop_.hold();
    } else if (const std::optional<StickKey> moved = stick_key(key)) {
      keys_.press(*moved, now_s());
    }
    return true;
  }

  static double now_s() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

  Sticks sticks() const {
    const bool by_joystick = joystick_ && joystick_->gamepad().enabled();
    return by_joystick ? joystick_->gamepad().sticks() : keys_.sticks(now_s());
  }

  std::string status_text() const {
    const VehicleState state = vehicle_.state();
    return fmt::format("{} {} ({})", vehicle_.name(), control::to_string(state.mode), state.mode_reason);
  }

  std::string command_text() const {
    const Sticks sticks = this->sticks();
    const TeleopLimits& limits = options_.limits;
    return fmt::format("forward {:+.2f}  right {:+.2f}  up {:+.2f} m/s   turn {:+.2f} rad/s",
                       sticks.forward * limits.horizontal_m_s, sticks.right * limits.horizontal_m_s,
                       sticks.up * limits.vertical_m_s, sticks.turn * limits.yaw_rate_rad_s);
  }

  std::string message() const {
    const VehicleState state = vehicle_.state();
    if (!vehicle_.connected()) return "no control_status for 1 s";
    if (refused_at_ && Clock::now() - *refused_at_ < kRefusalShown) return state.setpoints.refusal;
    if (!accepts_setpoints(state.mode))
      return "The sticks have no effect before the vehicle holds: press space";
    return teleop_.hold_fault();
  }

  // At most 80 columns, and 11 rows.
  std::vector<ScreenLine> lines() const {
    std::vector<ScreenLine> lines = {{status_text(), Emphasis::kHeading},
                                     {"position  " + position_text(vehicle_.state())},
                                     {"command   " + command_text()},
                                     {message(), Emphasis::kWarning},
                                     {""}};
    if (joystick_) {
      const bool enabled = joystick_->gamepad().enabled();
      lines.push_back(
          {"joystick  " + joystick_->name() + (enabled ? "" : ": hold a shoulder button to fly")});
      lines.push_back({"          left stick: climb, turn   right stick: forward, sideways"});
    }
    lines.push_back({"arrows    forward, back, left, right, as seen from the vehicle"});
    lines.push_back({"w s       up, down                  q e   turn left, right"});
    lines.push_back({"space     hold                      x     hold and quit"});
    lines.push_back({"The vehicle flies as long as a key is held, and then holds."});
    return lines;
  }

  Vehicle& vehicle_;
  const TeleopOptions& options_;
  std::unique_ptr<InputDevice> joystick_;
  const Interrupts& interrupts_;
  KeySticks keys_;
  Teleop teleop_;
  SetpointTally before_;
  std::uint64_t refused_;
  std::optional<Clock::time_point> refused_at_;
};

void print(const Session& session, const VehicleState& end, const std::string& fault, bool json) {
  const SetpointTally tally = session.tally();
  if (json) {
    nlohmann::ordered_json text = {{"sent", session.sent()},
                                   {"accepted", tally.accepted},
                                   {"refused", tally.refused},
                                   {"mode", control::to_string(end.mode)}};
    if (!fault.empty()) text["reason"] = fault;
    std::printf("%s\n", io::json_text(text).c_str());
  } else {
    std::printf("teleop: %llu setpoints, %llu accepted and %llu refused; now %s at (%.2f, %.2f, %.2f) m\n",
                static_cast<unsigned long long>(session.sent()),
                static_cast<unsigned long long>(tally.accepted),
                static_cast<unsigned long long>(tally.refused), control::to_string(end.mode),
                end.position_ned_m.x(), end.position_ned_m.y(), end.position_ned_m.z());
  }
  if (!fault.empty()) std::fprintf(stderr, "swiftlet: teleop: %s\n", fault.c_str());
}

int teleop(const TeleopOptions& options) {
  const bool at_terminal = isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0;
  if (!at_terminal && options.joystick.empty())
    throw io::InputError("teleop: requires a terminal, or --joystick DEVICE");
  std::unique_ptr<InputDevice> joystick;
  try {
    if (!options.joystick.empty()) joystick = std::make_unique<InputDevice>(options.joystick);
  } catch (const std::runtime_error& error) {
    throw io::InputError("teleop: --joystick: " + std::string(error.what()));
  }
  Vehicle vehicle(options.network);
  const Result found = vehicle.connect(options.timeout());
  if (!found.accepted()) {
    std::fprintf(stderr, "swiftlet: teleop: %s\n", found.reason.c_str());
    return io::kFailed;
  }
  const Mode mode = vehicle.state().mode;
  if (!is_flying(mode)) {
    std::fprintf(stderr, "swiftlet: teleop: %s is %s; take off first: swiftlet arm && swiftlet takeoff 1\n",
                 vehicle.name().c_str(), control::to_string(mode));
    return io::kFailed;
  }
  const Interrupts interrupts;
  Session session(vehicle, options, std::move(joystick), interrupts);
  const std::string fault = session.fly(at_terminal);
  vehicle.wait_until([](const VehicleState& state) { return state.mode != Mode::kSetpoint; }, kModeTimeout);
  print(session, vehicle.state(), fault, options.json);
  return fault.empty() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_teleop_command(runtime::CommandLine root) {
  const auto options = std::make_shared<TeleopOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      root, "teleop", io::purpose_of("teleop"),
      "swiftlet teleop --speed 0.3    (after swiftlet arm && swiftlet takeoff 1)", options);
  app.footer(
      "Arrows: forward, back, left and right, as seen from the vehicle. w, s: up, down. q, e: turn. Space: "
      "hold.\n"
      "x: quit. The vehicle must be in the air. It holds when a key is released, and when this command ends "
      "or "
      "the\n"
      "terminal is closed, also if it was taking off or flying a mission.\n\n" +
      app.footer());
  TeleopLimits& limits = options->limits;
  app.add_option("--speed", limits.horizontal_m_s, "horizontal speed, m/s").range(0.05, 10.0).show_default();
  app.add_option("--climb-speed", limits.vertical_m_s, "vertical speed, m/s")
      .range(0.05, 10.0)
      .show_default();
  app.add_option("--yaw-rate", limits.yaw_rate_rad_s, "rate of turn, rad/s").range(0.05, 10.0).show_default();
  app.add_option(
         "--key-timeout", options->timeouts.repeat_s,
         "dead-man timeout, s: a key that repeats counts as released if it does not for so long; 0.7 s "
         "after the first press, because keyboards begin to repeat late")
      .range(0.05, 0.7)
      .show_default();
  app.add_option(
         "--joystick", options->joystick,
         "gamepad as a Linux event device, /dev/input/event*: left stick climb and turn, right stick "
         "forward and sideways, both only while a shoulder button or the trigger is held. With it, no "
         "terminal is required")
      .type_name("DEVICE");
  return {app, [options] { return teleop(*options); }};
}

}  // namespace swiftlet::ground
