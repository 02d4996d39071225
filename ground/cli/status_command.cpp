#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/cli/status_json.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/ground/terminal/clock_text.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kTopicTimeout{1000};

struct StatusOptions : CommandOptions {
  double watch_s = 1.0;
};

template <class T>
double rate_hz(const Latest<T>& before, const Latest<T>& after, double time_s) {
  return static_cast<double>(after.count - before.count) / time_s;
}

TopicRates rates_between(const View& before, const View& after, double time_s) {
  return {rate_hz(before.estimate, after.estimate, time_s),
          rate_hz(before.reference, after.reference, time_s), rate_hz(before.battery, after.battery, time_s),
          rate_hz(before.truth, after.truth, time_s)};
}

void print(const LiveControllers& controllers) {
  for (const LiveController& controller : controllers.known) {
    std::printf("  controller %016llx: %s", static_cast<unsigned long long>(controller.number),
                role_name(controller));
    if (controller.state) {
      std::printf("%s, failover priority %u, term %u", controller.state->ready() ? "" : ", not ready",
                  controller.state->failover_priority(), controller.state->term());
    }
    std::printf("\n");
  }
  if (controllers.others > 0)
    std::printf("  controller %d more found, which report no state\n", controllers.others);
}

// "p50 2 ms, p95 2 ms, unstable from 52 ms on".
std::string delay_text(const msg::ControlStatus& control) {
  const double margin_ms = 1e3 * control.delay_margin_s();
  const std::string margin = control.delay_margin_s() < control::kLongestDelay_s
                                 ? fmt::format("unstable from {:.0f} ms on", margin_ms)
                                 : fmt::format("stable up to {:.0f} ms", margin_ms);
  if (control.loop_delay_p95_s() < 0.0) return "not measured, " + margin;
  return fmt::format("p50 {:.0f} ms, p95 {:.0f} ms, {}", 1e3 * control.loop_delay_p50_s(),
                     1e3 * control.loop_delay_p95_s(), margin);
}

template <class T>
std::string age_text(const Latest<T>& latest, Clock::time_point now) {
  if (!latest.seen()) return "not received";
  return fmt::format("{:.2f} s old", latest.age_s(now));
}

void print_battery(const View& view) {
  if (!view.battery.seen()) return;
  const auto& battery = view.battery.message;
  std::printf("  battery   %.2f V, %.2f A, %.0f %%\n", battery.voltage_v(), battery.current_a(),
              battery.state_of_charge() * 100.0);
}

void print_vehicle(const msg::VehicleInfo& info) {
  std::printf(
      "  vehicle   %s%s, IMU at %.0f Hz, sense to actuate p50 %.0f us, p99 %.0f us, max %.0f us%s%s\n",
      info.name().c_str(), info.simulated() ? " (simulated)" : "", info.imu_rate_hz(),
      info.sense_to_actuate_p50_us(), info.sense_to_actuate_p99_us(), info.sense_to_actuate_max_us(),
      info.fault().size() > 0 ? "; FAULT: " : "", info.fault().c_str());
}

void print_motion(const View& view, Clock::time_point now) {
  const auto& control = view.control.message;
  if (view.estimate.seen()) {
    const auto& p = view.estimate.message.position_ned();
    const auto& v = view.estimate.message.velocity_ned();
    std::printf("  position  %.3f, %.3f, %.3f m   velocity %.2f, %.2f, %.2f m/s   (NED)\n", p[0], p[1], p[2],
                v[0], v[1], v[2]);
    std::printf("  attitude  %s\n", attitude_text(view.estimate.message).c_str());
  }
  std::printf("  pose      %s, %.3f s old", control.has_pose() ? "tracked" : "MISSING",
              pose_age_s(view, now));
  if (view.estimate.seen()) {
    const auto& estimate = view.estimate.message;
    std::printf(", %llu accepted and %llu refused",
                static_cast<unsigned long long>(estimate.poses_accepted()),
                static_cast<unsigned long long>(estimate.poses_refused()));
    if (estimate.pose_fault() != msg::Estimate_Constants::POSE_FAULT_NONE)
      std::printf(", fault: %s", pose_fault_name(estimate.pose_fault()));
    if (estimate.resets() > 0) std::printf(", %u resets", estimate.resets());
  }
  std::printf("\n");
  const std::string odometry = odometry_text(control);
  if (!odometry.empty()) std::printf("  odometry  %s\n", odometry.c_str());
}

void print_plan(const msg::ControlStatus& control, const msg::MissionStatus& mission) {
  if (mission.state() != msg::MissionStatus_Constants::NONE) {
    std::printf("  mission   %s, item %u of %u\n", mission_state_name(mission.state()),
                mission.item_index() + 1, mission.item_count());
  }
  if (const msg::RequestStatus& request = control.request();
      request.state() != msg::RequestStatus_Constants::UNKNOWN) {
    const char* const result = request.result().size() > 0 ? request.result().c_str() : state_name(request);
    std::printf("  request   %s: %s, %.0f %%\n", kind_name(request), result, 100.0 * request.progress());
  }
}

void print_control(const View& view) {
  const auto& control = view.control.message;
  std::printf(
      "  control   level %s, %.1f Hz since the rotors started, %llu of %llu steps late, longest step %.0f "
      "us%s\n",
      levels_text(control.control_level()).c_str(), control.rate_hz(),
      static_cast<unsigned long long>(control.deadline_misses()),
      static_cast<unsigned long long>(control.cycles()), control.step_time_max_us(),
      control.realtime_scheduling() ? "" : ", no real-time scheduling");
  std::printf("  delay     %s\n", delay_text(control).c_str());
  if (const msg::ClockStatus& clock = view.clock.message; view.clock.seen()) {
    std::printf("  clock     frames %s (within %.3f ms, %.1f ppm)%s\n", clock_text(clock).c_str(),
                1e-6 * clock.uncertainty_ns(), 1e6 * clock.drift_uncertainty(),
                clock.known() ? "" : ", UNKNOWN: poses are withheld");
  }
  if (control.settings().size() > 0) {
    std::printf("  settings  %s", control.settings().c_str());
    if (control.gains_progress() < 1.0)
      std::printf(", the gains change to it: %.0f %%", 100.0 * control.gains_progress());
    std::printf("\n");
  }
}

void print(const View& view, const TopicRates& rates, const CommandOptions& options,
           const std::vector<std::string>& mismatches) {
  const auto now = Clock::now();
  const auto& control = view.control.message;
  const std::vector<Silence> silences = silences_of(view, now);
  for (const Silence& silence : silences)
    print_alarm(stdout, to_string(silence, std::chrono::system_clock::now()));
  if (control.source_conflict().size() > 0) print_alarm(stdout, control.source_conflict().c_str());
  for (const std::string& mismatch : mismatches) print_alarm(stdout, mismatch);
  if (control.delay_near_margin())
    print_alarm(stdout, "the delay of the loop is near what makes it unstable");
  std::printf("%s in domain %d: %s%s (%s), %s\n", options.network.vehicle.c_str(), options.network.domain,
              control_is_silent(silences) ? "last known: " : "", mode_name(control.mode()),
              control.reason().c_str(), control.airborne() ? "airborne" : "on the ground");
  print_motion(view, now);
  print_battery(view);
  print_plan(control, view.mission.message);
  print_control(view);
  print(controllers_of(view, now));
  if (view.vehicle.seen()) print_vehicle(view.vehicle.message);
  std::printf("  rates     estimate %.0f Hz, reference %.0f Hz, battery %.0f Hz, ground truth %.0f Hz\n",
              rates.estimate_hz, rates.reference_hz, rates.battery_hz, rates.ground_truth_hz);
  std::printf("  ages      control status %s, vehicle info %s, estimate %s, battery %s\n",
              age_text(view.control, now).c_str(), age_text(view.vehicle, now).c_str(),
              age_text(view.estimate, now).c_str(), age_text(view.battery, now).c_str());
}

// True if an autopilot flies the vehicle in place of control.
bool is_flown_by_autopilot(const View& view) {
  return !view.control.seen() && view.vehicle.seen() && view.vehicle.message.autopilot().size() > 0;
}

void print_flown_by_autopilot(const View& view, const TopicRates& rates, const CommandOptions& options) {
  const auto now = Clock::now();
  for (const Silence& silence : silences_of(view, now))
    print_alarm(stdout, to_string(silence, std::chrono::system_clock::now()));
  const auto& info = view.vehicle.message;
  std::printf("%s in domain %d: flown by %s, rotors %s\n", options.network.vehicle.c_str(),
              options.network.domain, info.autopilot().c_str(), info.rotors_running() ? "running" : "off");
  if (view.truth.seen()) {
    const auto& p = view.truth.message.position_ned();
    const auto& v = view.truth.message.velocity_ned();
    std::printf("  truth     %.3f, %.3f, %.3f m   velocity %.2f, %.2f, %.2f m/s   (NED)\n", p[0], p[1], p[2],
                v[0], v[1], v[2]);
  }
  print_battery(view);
  print_vehicle(info);
  std::printf("  rates     battery %.0f Hz, ground truth %.0f Hz\n", rates.battery_hz, rates.ground_truth_hz);
  std::printf("  ages      vehicle info %s, battery %s, ground truth %s\n",
              age_text(view.vehicle, now).c_str(), age_text(view.battery, now).c_str(),
              age_text(view.truth, now).c_str());
}

int show_status(const StatusOptions& options) {
  Client client(options.network);
  client.hear_controllers();
  if (!client.wait(options.timeout(),
                   [](const View& view) { return view.control.seen() || is_flown_by_autopilot(view); })) {
    std::fprintf(stderr, "swiftlet: status: %s\n", client.no_control().c_str());
    return io::kFailed;
  }
  // Topics that do not arrive within kTopicTimeout are shown as missing.
  client.wait(kTopicTimeout, [](const View& view) {
    return view.vehicle.seen() && view.battery.seen() &&
           (is_flown_by_autopilot(view) ? view.truth.seen() : view.estimate.seen() && view.mission.seen());
  });
  const View before = client.view();
  client.wait(std::chrono::milliseconds(static_cast<std::int64_t>(options.watch_s * 1e3)),
              [](const View&) { return false; });
  const View after = client.view();
  const TopicRates rates = rates_between(before, after, options.watch_s);
  const std::vector<std::string> mismatches = client.node().mismatches_seen();
  if (options.json) {
    std::printf("%s\n", io::json_text(status_json(after, rates, options, mismatches), 2).c_str());
  } else if (is_flown_by_autopilot(after)) {
    print_flown_by_autopilot(after, rates, options);
  } else {
    print(after, rates, options, mismatches);
  }
  return io::kDone;
}

}  // namespace

io::Command add_status_command(runtime::CommandLine root) {
  const auto options = std::make_shared<StatusOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      root, "status",
      "Print the state of a vehicle: who is silent first, then mode, position, battery and rates",
      "swiftlet status --json | jq .battery.voltage_v", options);
  app.add_option("--watch", options->watch_s, "time over which the rates are measured, s")
      .range(0.1, 60.0)
      .show_default();
  return {app, [options] { return show_status(*options); }};
}

}  // namespace swiftlet::ground
