#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/cli/status_json.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/controllers.hpp"
#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/ground/terminal/clock_text.hpp"
#include "swiftlet/ground/terminal/state_lines.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/messages/wire.hpp"

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
  return fmt::format("{:.2f} s", latest.age_s(now));
}

void print_battery(const View& view) {
  if (!view.battery.seen()) return;
  const auto& battery = view.battery.message;
  std::printf("  battery    %.2f V, %.2f A, %.0f %%\n", battery.voltage_v(), battery.current_a(),
              battery.state_of_charge() * 100.0);
}

void print_vehicle(const msg::VehicleInfo& info) {
  std::printf("  vehicle    %s%s, IMU at %.0f Hz%s%s\n", info.name().c_str(),
              info.simulated() ? " (simulated)" : "", info.imu_rate_hz(),
              info.fault().size() > 0 ? "; FAULT: " : "", info.fault().c_str());
  std::printf("  latency    sense to actuate p50 %.0f us, p99 %.0f us, max %.0f us\n",
              info.sense_to_actuate_p50_us(), info.sense_to_actuate_p99_us(), info.sense_to_actuate_max_us());
}

// Without the sign of a negative zero.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit + 0.0; }

void print_motion_line(const char* label, const std::array<double, 3>& position,
                       const std::array<double, 3>& velocity) {
  const auto p = [&](std::size_t i) { return rounded(position.at(i), 1000.0); };
  const auto v = [&](std::size_t i) { return rounded(velocity.at(i), 100.0); };
  fmt::print("  {:<10} {:8.3f} {:8.3f} {:8.3f} m   velocity {:6.2f} {:6.2f} {:6.2f} m/s   (NED)\n", label,
             p(0), p(1), p(2), v(0), v(1), v(2));
}

void print_motion(const View& view, Clock::time_point now) {
  const auto& control = view.control.message;
  if (view.estimate.seen()) {
    const auto& p = view.estimate.message.position_ned();
    const auto& v = view.estimate.message.velocity_ned();
    print_motion_line("position", p, v);
    std::printf("  attitude   %s\n", attitude_text(view.estimate.message).c_str());
  }
  std::printf("  pose       %s, %.3f s old", control.has_pose() ? "tracked" : "MISSING",
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
  if (!odometry.empty()) std::printf("  odometry   %s\n", odometry.c_str());
}

void print_plan(const msg::ControlStatus& control, const msg::MissionStatus& mission) {
  if (mission.state() != msg::MissionStatus_Constants::NONE) {
    std::printf("  mission    %s, item %u of %u\n", mission_state_name(mission.state()),
                mission.item_index() + 1, mission.item_count());
  }
  if (const msg::RequestStatus& request = control.request();
      request.state() != msg::RequestStatus_Constants::UNKNOWN) {
    const char* const result = request.result().size() > 0 ? request.result().c_str() : state_name(request);
    std::printf("  request    %s: %s, %.0f %%\n", kind_name(request), result, 100.0 * request.progress());
  }
}

void print_control(const View& view) {
  const auto& control = view.control.message;
  std::printf("  control    level %s, %.1f Hz since the rotors started%s\n",
              levels_text(control.control_level()).c_str(), control.rate_hz(),
              control.realtime_scheduling() ? "" : ", no real-time scheduling");
  std::printf("  steps      %llu of %llu late, longest %.0f us\n",
              static_cast<unsigned long long>(control.deadline_misses()),
              static_cast<unsigned long long>(control.cycles()), control.step_time_max_us());
  std::printf("  delay      %s\n", delay_text(control).c_str());
  if (const msg::ClockStatus& clock = view.clock.message; view.clock.seen()) {
    std::printf("  clock      frames %s (within %.3f ms, %.1f ppm)%s\n", clock_text(clock).c_str(),
                1e-6 * clock.uncertainty_ns(), 1e6 * clock.drift_uncertainty(),
                clock.known() ? "" : ", UNKNOWN: poses are withheld");
  }
  if (control.settings().size() > 0) {
    std::printf("  settings   %s", control.settings().c_str());
    if (control.gains_progress() < 1.0)
      std::printf(", the gains change to it: %.0f %%", 100.0 * control.gains_progress());
    std::printf("\n");
  }
}

void print_silences(const View& view, const std::string& who) {
  for (const Silence& silence : silences_of(view, Clock::now()))
    print_alarm(stdout, who + to_string(silence, std::chrono::system_clock::now()));
}

void print(const View& view, const TopicRates& rates, const CommandOptions& options,
           const std::vector<std::string>& mismatches) {
  const auto now = Clock::now();
  const auto& control = view.control.message;
  print_silences(view, "");
  if (control.source_conflict().size() > 0) print_alarm(stdout, control.source_conflict().c_str());
  for (const std::string& mismatch : mismatches) print_alarm(stdout, mismatch);
  if (control.delay_near_margin())
    print_alarm(stdout, "the delay of the loop is near what makes it unstable");
  std::printf("%s in domain %d: %s%s (%s), %s\n", options.network.vehicle.c_str(), options.network.domain,
              control_is_silent(silences_of(view, now)) ? "last known: " : "", mode_name(control.mode()),
              control.reason().c_str(), control.airborne() ? "airborne" : "on the ground");
  print_motion(view, now);
  print_battery(view);
  print_plan(control, view.mission.message);
  print_control(view);
  print(controllers_of(view, now));
  if (view.vehicle.seen()) print_vehicle(view.vehicle.message);
  std::printf("  rates      estimate %.0f Hz, reference %.0f Hz, battery %.0f Hz, ground truth %.0f Hz\n",
              rates.estimate_hz, rates.reference_hz, rates.battery_hz, rates.ground_truth_hz);
  std::printf("  ages       control status %s, vehicle info %s, estimate %s, battery %s\n",
              age_text(view.control, now).c_str(), age_text(view.vehicle, now).c_str(),
              age_text(view.estimate, now).c_str(), age_text(view.battery, now).c_str());
}

// True if an autopilot flies the vehicle in place of control.
bool is_flown_by_autopilot(const View& view) {
  return !view.control.seen() && view.vehicle.seen() && view.vehicle.message.autopilot().size() > 0;
}

void print_flown_by_autopilot(const View& view, const TopicRates& rates, const CommandOptions& options) {
  const auto now = Clock::now();
  print_silences(view, "");
  const auto& info = view.vehicle.message;
  std::printf("%s in domain %d: flown by %s, rotors %s\n", options.network.vehicle.c_str(),
              options.network.domain, info.autopilot().c_str(), info.rotors_running() ? "running" : "off");
  if (view.truth.seen()) {
    const auto& p = view.truth.message.position_ned();
    const auto& v = view.truth.message.velocity_ned();
    print_motion_line("truth", p, v);
  }
  print_battery(view);
  print_vehicle(info);
  std::printf("  rates      battery %.0f Hz, ground truth %.0f Hz\n", rates.battery_hz,
              rates.ground_truth_hz);
  std::printf("  ages       vehicle info %s, battery %s, ground truth %s\n",
              age_text(view.vehicle, now).c_str(), age_text(view.battery, now).c_str(),
              age_text(view.truth, now).c_str());
}

bool is_heard(const View& view) { return view.control.seen() || is_flown_by_autopilot(view); }

struct Watched {
  std::unique_ptr<Client> client;
  CommandOptions options;  // of this vehicle alone
  View before{};           // the measured time before `after`
  View after{};
};

// Topics that do not arrive within kTopicTimeout are shown as missing.
void wait_for_topics(Client& client) {
  client.wait(kTopicTimeout, [](const View& view) {
    return view.vehicle.seen() && view.battery.seen() &&
           (is_flown_by_autopilot(view) ? view.truth.seen() : view.estimate.seen() && view.mission.seen());
  });
}

// A row for each vehicle, all with the same columns.
void print_table(const std::vector<Watched>& vehicles) {
  for (const Watched& one : vehicles) print_silences(one.after, one.options.network.vehicle + ": ");
  std::size_t widest = std::strlen("vehicle");
  for (const Watched& one : vehicles) widest = std::max(widest, one.options.network.vehicle.size());
  fmt::print("{:<{}} {:<12} {:>8} {:>8} {:>8} {:>9} {:>8} {:>9}\n", "vehicle", widest, "mode", "north m",
             "east m", "down m", "heading", "battery", "pose age");
  for (const Watched& one : vehicles) {
    const View& view = one.after;
    std::array<std::string, 6> cells;
    cells.fill("-");
    if (view.estimate.seen()) {
      const msg::Estimate& estimate = view.estimate.message;
      for (std::size_t i = 0; i < 3; ++i)
        cells.at(i) = fmt::format("{:.2f}", rounded(estimate.position_ned()[i], 100.0));
      cells[3] =
          fmt::format("{:.1f} deg", heading_deg(messages::wire::quaternion(estimate.q_ned_from_frd())));
    }
    if (view.battery.seen()) cells[4] = fmt::format("{:.2f} V", view.battery.message.voltage_v());
    if (view.control.message.has_pose()) cells[5] = fmt::format("{:.3f} s", pose_age_s(view, Clock::now()));
    fmt::print("{:<{}} {:<12} {:>8} {:>8} {:>8} {:>9} {:>8} {:>9}\n", one.options.network.vehicle, widest,
               view.control.seen() ? mode_name(view.control.message.mode()) : "no control", cells[0],
               cells[1], cells[2], cells[3], cells[4], cells[5]);
  }
}

void print_json(const std::vector<Watched>& vehicles, double time_s) {
  nlohmann::ordered_json json;
  for (const Watched& one : vehicles)
    json[one.options.network.vehicle] = status_json(one.after, rates_between(one.before, one.after, time_s),
                                                    one.options, one.client->node().mismatches_seen());
  std::printf("%s\n", io::json_text(vehicles.size() == 1 ? json.front() : json, 2).c_str());
}

void print_one(const Watched& one, double time_s) {
  const TopicRates rates = rates_between(one.before, one.after, time_s);
  if (is_flown_by_autopilot(one.after)) {
    print_flown_by_autopilot(one.after, rates, one.options);
  } else {
    print(one.after, rates, one.options, one.client->node().mismatches_seen());
  }
}

int show_status(const StatusOptions& options) {
  const Context context(options.network);
  std::vector<Watched> vehicles;
  for (const std::string& name : messages::vehicles_of_list(options.network.vehicle)) {
    vehicles.push_back({nullptr, options});
    vehicles.back().options.network.vehicle = name;
    vehicles.back().client = std::make_unique<Client>(context.participant(), vehicles.back().options.network);
    vehicles.back().client->hear_controllers();
  }
  int silent = 0;
  for (const Watched& one : vehicles) {
    if (one.client->wait(options.timeout(), is_heard)) continue;
    ++silent;
    std::fprintf(stderr, "swiftlet: status: %s\n", one.client->no_control().c_str());
  }
  if (silent == static_cast<int>(vehicles.size())) return io::kFailed;
  for (const Watched& one : vehicles) wait_for_topics(*one.client);
  for (Watched& one : vehicles) one.before = one.client->view();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.watch_s));
  for (Watched& one : vehicles) one.after = one.client->view();
  if (options.json) {
    print_json(vehicles, options.watch_s);
  } else if (vehicles.size() == 1) {
    print_one(vehicles.front(), options.watch_s);
  } else {
    print_table(vehicles);
  }
  return silent == 0 ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_status_command(runtime::CommandLine root) {
  const auto options = std::make_shared<StatusOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      root, "status",
      "Print the state of a vehicle: who is silent first, then mode, position, battery and rates; of several "
      "a table",
      "swiftlet status --json | jq .battery.voltage_v", options, Vehicles::kSeveral);
  app.add_option("--watch", options->watch_s, "time over which the rates are measured, s")
      .range(0.1, 60.0)
      .show_default();
  return {app, [options] { return show_status(*options); }};
}

}  // namespace swiftlet::ground
