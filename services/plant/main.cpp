// swiftlet-plant: the simulated vehicle.
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/peer_log.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/plant/lockstep_loop.hpp"
#include "swiftlet/services/plant/realtime_loop.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::services {
namespace {

using namespace std::chrono_literals;

struct Options {
  std::string vehicle = "kaylion";
  std::string simulation = "default";
  std::uint64_t seed = 1;
  std::array<double, 2> start{};  // m, north and east
  int imu_rate = 0;               // Hz; 0: as in the simulation file
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 0.0;  // 0: real time, or in lockstep no limit
  LockstepSettings lockstep;
  comms::NodeSettings node;
  runtime::ProcessOptions process;
};

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  app.add_option("--simulation", options.simulation, "Simulation file").show_default();
  app.add_option("--seed", options.seed, "Random seed of noise, biases and gusts")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  app.add_option("--start", options.start, "Initial position on the ground, m north and m east of the origin")
      .range(-1e3, 1e3);
  app.add_option("--imu-rate", options.imu_rate,
                 "IMU rate, Hz, 500 or 1000; default: as in the simulation file")
      .one_of({"500", "1000"});
  runtime::add_clock_option(app, options.clock);
  app.add_option("--speed", options.speed,
                 "Simulation speed factor (1 = real time). In lockstep an upper limit; default: as fast as "
                 "answers arrive")
      .range(0.01, 100.0);
  app.add_flag("--paused", options.lockstep.paused, "Lockstep: advance time only up to simulation_clock");
  app.add_option("--trace", options.lockstep.trace,
                 "Lockstep: write every sample and command of the flight to this CSV file, without rounding");
  comms::add_node_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

// Throws std::invalid_argument for lockstep options without --clock lockstep.
void check(const Options& options) {
  const bool lockstep = options.clock == runtime::Clock::kLockstep;
  if (!lockstep && options.lockstep.paused) throw std::invalid_argument("--paused: needs --clock lockstep");
  if (!lockstep && !options.lockstep.trace.empty())
    throw std::invalid_argument("--trace: needs --clock lockstep");
}

comms::msg::VehicleInfo describe(const plant::Vehicle& vehicle, double imu_rate_hz) {
  comms::msg::VehicleInfo info;
  info.name() = vehicle.name;
  info.simulated(true);
  info.rotor_count(static_cast<std::uint8_t>(vehicle.rotor_count()));
  info.mass_kg(vehicle.mass_kg);
  info.imu_rate_hz(imu_rate_hz);
  return info;
}

void update(comms::msg::VehicleInfo& info, const PlantReport& report, const std::string& fault) {
  info.stamp_ns(report.stamp_ns);
  info.sequence_number(info.sequence_number() + 1);
  info.rotors_running(report.rotors_running);
  info.paused(report.paused);
  info.answered(report.answered);
  info.unanswered(report.unanswered);
  info.late(report.late);
  info.sense_to_actuate_p50_us(static_cast<double>(report.answer_p50_ns) * 1e-3);
  info.sense_to_actuate_p99_us(static_cast<double>(report.answer_p99_ns) * 1e-3);
  info.sense_to_actuate_p999_us(static_cast<double>(report.answer_p999_ns) * 1e-3);
  info.sense_to_actuate_max_us(static_cast<double>(report.answer_max_ns) * 1e-3);
  info.fault() = fault;
}

// Publishes and logs the loop's reports: every second, and at once when the rotors start or stop or the pause
// changes.
class Reporter {
 public:
  Reporter(comms::Node& node, const plant::Vehicle& vehicle, const plant::SimulationSettings& settings)
      : publisher_(node.publish(comms::topics::kVehicleInfo)),
        info_(describe(vehicle, settings.imu.rate_hz)) {
    const std::string text = fmt::format("no actuator command for {:g} s", settings.command_timeout_s);
    timeout_fault_ = text;
  }

  void publish_due(const PlantReport& report) {
    const bool changed = report.rotors_running != last_report_.rotors_running ||
                         report.timed_out != last_report_.timed_out || report.paused != last_report_.paused ||
                         (report.paused && report.stamp_ns != last_report_.stamp_ns);
    const std::int64_t now_ns = runtime::monotonic_ns();
    if (!changed && now_ns < due_ns_) return;
    due_ns_ = now_ns + kPeriodNs;
    const std::string fault = report.timed_out ? timeout_fault_ : "";
    update(info_, report, fault);
    publisher_.publish(info_);
    log_rotors(report, fault);
    if (now_ns >= trouble_due_ns_ && log_trouble(report)) trouble_due_ns_ = now_ns + kTroublePeriodNs;
    last_report_ = report;
  }

 private:
  static constexpr std::int64_t kPeriodNs = 1'000'000'000;
  static constexpr std::int64_t kTroublePeriodNs = 10'000'000'000;

  void log_rotors(const PlantReport& report, const std::string& fault) {
    if (report.rotors_running == last_report_.rotors_running) return;
    if (report.rotors_running) {
      spdlog::info("rotors started");
    } else if (report.timed_out) {
      spdlog::error("rotors stopped: {}", fault);
    } else {
      spdlog::info("rotors stopped on command");
    }
  }

  // Logs refused commands and slips since the last call. Returns true if there were any.
  bool log_trouble(const PlantReport& report) {
    const bool refused = report.refused_commands > logged_report_.refused_commands;
    const bool slipped = report.slips > logged_report_.slips;
    if (refused) {
      spdlog::warn("refused {} actuator commands, the last: {}",
                   report.refused_commands - logged_report_.refused_commands, report.refusal.text);
    }
    if (slipped) {
      spdlog::warn("fell behind real time: delayed simulated time {} times, by {:.1f} ms in total",
                   report.slips - logged_report_.slips,
                   static_cast<double>(report.slipped_ns - logged_report_.slipped_ns) * 1e-6);
    }
    logged_report_ = report;
    return refused || slipped;
  }

  comms::Publisher<comms::msg::VehicleInfo> publisher_;
  comms::msg::VehicleInfo info_;
  std::string timeout_fault_;
  PlantReport last_report_;
  PlantReport logged_report_;
  std::int64_t due_ns_ = 0;
  std::int64_t trouble_due_ns_ = 0;
};

// Runs the loop in a thread of its own until a stop or its failure, which is rethrown. Returns the last
// report.
PlantReport run_loop(const std::function<void(const std::atomic<bool>&)>& loop, SimulatedVehicle& vehicle,
                     Reporter& reporter, runtime::StopSignal& stop) {
  std::atomic<bool> ends{false};
  std::exception_ptr failure;
  std::thread thread([&] {
    try {
      loop(ends);
    } catch (...) {
      failure = std::current_exception();
      stop.request();
    }
  });
  PlantReport last;
  do {
    vehicle.reports().take(last);
    reporter.publish_due(last);
  } while (!stop.wait_for(20ms));
  ends = true;
  thread.join();
  if (failure) std::rethrow_exception(failure);
  vehicle.reports().take(last);
  reporter.publish_due(last);
  return last;
}

void run(const Options& options) {
  const plant::Vehicle vehicle =
      runtime::load_vehicle(runtime::configuration_file(runtime::kinds::kVehicle, options.vehicle));
  plant::SimulationSettings settings = runtime::load_simulation_settings(
      runtime::configuration_file(runtime::kinds::kSimulation, options.simulation));
  if (options.imu_rate != 0) settings.imu.rate_hz = options.imu_rate;
  for (const plant::Violation& violation : plant::validate(settings)) {
    throw std::invalid_argument("--imu-rate: " + violation.key + " " + violation.message);
  }
  for (const plant::Violation& violation : plant::validate_faults(settings.faults, vehicle)) {
    throw std::invalid_argument(options.simulation + ": " + violation.key + ": " + violation.message);
  }

  check(options);

  runtime::StopSignal stop;
  const runtime::Logging logging("plant", options.process.log);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, options.clock);

  comms::NodeSettings node_settings = options.node;
  node_settings.name = "plant";
  node_settings.announcement_period = comms::kFixturePeriod;
  node_settings.deadlines = options.clock == runtime::Clock::kRealtime;
  node_settings.source_of = comms::topics::kImu.name;
  comms::Node node(node_settings);
  comms::log_peers(node);
  const comms::SoleSource source(node, [&stop] { stop.request(); });
  Reporter reporter(node, vehicle, settings);
  plant::VehicleState initial;
  initial.position_ned.head<2>() = Eigen::Vector2d(options.start[0], options.start[1]);
  SimulatedVehicle simulated(vehicle, settings, options.seed, initial, node);
  spdlog::info("ready: {}, vehicle {}, domain {}, clock {}, IMU at {:g} Hz, seed {}", vehicle.name,
               node_settings.vehicle, node_settings.domain, runtime::to_string(options.clock),
               settings.imu.rate_hz, options.seed);

  std::optional<RealtimeLoop> realtime_loop;
  std::optional<LockstepLoop> lockstep_loop;
  if (options.clock == runtime::Clock::kRealtime) {
    const double speed = options.speed > 0.0 ? options.speed : 1.0;
    realtime_loop.emplace(simulated, settings, speed, node, realtime);
  } else {
    LockstepSettings lockstep = options.lockstep;
    lockstep.speed = options.speed;
    lockstep_loop.emplace(simulated, settings, options.seed, lockstep, vehicle.rotor_count(), node);
  }
  const PlantReport last = run_loop(
      [&](const std::atomic<bool>& ends) {
        if (realtime_loop) realtime_loop->run(ends);
        if (lockstep_loop) lockstep_loop->run(ends);
      },
      simulated, reporter, stop);
  source.check();

  spdlog::info(
      "ended after {:.1f} s of simulated time: {} commands obeyed, {} refused; sense to actuate p50 {:.0f} "
      "us, "
      "p99 {:.0f} us, max {:.0f} us over {} samples, {} unanswered; behind real time {} times, {:.1f} ms",
      static_cast<double>(last.stamp_ns) * 1e-9, last.commands, last.refused_commands,
      static_cast<double>(last.answer_p50_ns) * 1e-3, static_cast<double>(last.answer_p99_ns) * 1e-3,
      static_cast<double>(last.answer_max_ns) * 1e-3, last.answered, last.unanswered, last.slips,
      static_cast<double>(last.slipped_ns) * 1e-6);
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"swiftlet-plant",
       "Simulates a quadrotor on the network: publishes sensor samples, obeys actuator commands.",
       "--vehicle config/vehicles/kaylion.yaml --seed 7 --localhost-only", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
