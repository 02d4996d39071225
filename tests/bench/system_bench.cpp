// Figures of the whole system beside their limits, measured in the same run: latency, jitter, lockstep, step
// times, load, the number of vehicles on this machine, and the throughput of batches.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/bench/built_programs.hpp"
#include "tests/bench/hovering_fleet.hpp"
#include "tests/bench/longest_steps.hpp"
#include "tests/bench/process_usage.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/stall_witness.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
namespace msg = messages::msg;
using bench::Fleet;
using bench::FleetFigures;
using bench::kProcesses;
using bench::Table;
using bench::VehicleFigures;
using nlohmann::json;

struct Options {
  double seconds = 5.0;
  std::vector<std::string> only;  // sections; empty: all
  std::vector<int> vehicles{1, 2, 4, 8, 16, 32};
  bool json = false;
};

// ---- load

// Loads every core during its lifetime with two processes of arithmetic, memory accesses and system calls.
class CpuLoad {
 public:
  CpuLoad() {
    for (unsigned i = 0; i < 2 * std::thread::hardware_concurrency(); ++i) {
      const pid_t child = ::fork();
      if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        work();
      }
      children_.push_back(child);
    }
  }
  ~CpuLoad() {
    for (const pid_t child : children_) ::kill(child, SIGKILL);
    for (const pid_t child : children_) ::waitpid(child, nullptr, 0);
  }
  CpuLoad(const CpuLoad&) = delete;
  CpuLoad& operator=(const CpuLoad&) = delete;

 private:
  [[noreturn]] static void work() {
    std::vector<double> memory(1 << 20, 1.0);
    volatile double sum = 0.0;
    while (true) {
      for (double& value : memory) value = value * 1.0000001 + 1e-9;
      for (const double value : memory) sum = sum + value;
      for (int i = 0; i < 1000; ++i) ::getppid();
    }
  }
  std::vector<pid_t> children_;
};

constexpr std::chrono::milliseconds kLook{100};  // period of checks on the processes

// Figures of vehicles that hover side by side; counters cover the last `seconds`. witness: measure the stalls.
FleetFigures hover(int vehicles, int rate_hz, bool realtime, double seconds, bool loaded = false,
                   bool with_witness = false, int rotor_speed_rate_hz = 500) {
  const tests::TemporaryFolder folder;
  Fleet fleet(vehicles, rate_hz, realtime, folder.path(), rotor_speed_rate_hz);
  std::optional<CpuLoad> load;
  if (loaded) load.emplace();
  fleet.take_off();
  fleet.begin();
  const auto start = ground::Clock::now();
  const std::array<Usage, 3> before = fleet.usage();
  std::optional<tests::StallWitness> witness;
  if (with_witness) witness.emplace(1'000'000'000 / rate_hz);
  const auto window = std::chrono::milliseconds(std::lround(1e3 * seconds));
  if (tests::eventually([&] { return fleet.has_ended(); }, window, kLook))
    throw std::runtime_error("a process ended while its vehicles were measured");
  FleetFigures figures;
  if (witness) figures.stalls_percent = witness->lost_percent();
  witness.reset();
  const std::array<Usage, 3> after = fleet.usage();
  const double measured_s = std::chrono::duration<double>(ground::Clock::now() - start).count();
  figures.vehicles = fleet.end();
  figures.refused = fleet.refused();
  for (std::size_t k = 0; k < kProcesses.size(); ++k) {
    figures.cpu_percent[k] = 100.0 * (after[k].cpu_s - before[k].cpu_s) / measured_s;
    figures.memory_mib[k] = after[k].memory_mib;
    figures.threads += after[k].threads;
    figures.switches_per_s += (after[k].switches - before[k].switches) / measured_s;
  }
  return figures;
}

// ---- the sections

void latency_and_load(Table& table, const Options& options) {
  std::vector<std::pair<int, FleetFigures>> flown;
  table.section("(a) sense to actuate over DDS, IMU written to command received by the plant");
  for (const int rate_hz : {500, 1000}) {
    const FleetFigures hovered = hover(1, rate_hz, true, options.seconds);
    const VehicleFigures& figures = hovered.vehicles.front();
    flown.emplace_back(rate_hz, hovered);
    const json limits = json::parse(output_of(
        program("ping_pong_bench").string() + " --json --seconds " + std::to_string(options.seconds) +
        " --rate " + std::to_string(rate_hz) + " --transport udp --transport unix-socket"));
    const std::string at = std::to_string(rate_hz) + " Hz, ";
    const msg::VehicleInfo& own = figures.vehicle;
    const auto row = [&](const char* name, double value, const char* key, const char* target) {
      table.add({at + name, value, "us", "bare Fast DDS ping-pong", limits[0].at(key).get<double>(), target});
      table.add({at + name, value, "us", "Unix socket ping-pong", limits[1].at(key).get<double>(), ""});
    };
    row("p50", own.sense_to_actuate_p50_us(), "p50_us", "at most 1.25");
    row("p99", own.sense_to_actuate_p99_us(), "p99_us", "at most 1.5");
    row("p99.9", own.sense_to_actuate_p999_us(), "p999_us", "");
    row("max", own.sense_to_actuate_max_us(), "max_us", "");
  }
  table.section("(b) load of one vehicle that hovers");
  for (const auto& [rate_hz, figures] : flown) {
    for (std::size_t i = 0; i < kProcesses.size(); ++i) {
      const std::string name = std::to_string(rate_hz) + " Hz, swiftlet-" + kProcesses[i];
      table.add({name, figures.cpu_percent[i], "% core", "", 0.0, ""});
      table.add({name, figures.memory_mib[i], "MiB", "", 0.0, ""});
    }
  }
}

void jitter(Table& table, const Options& options) {
  table.section("(c) jitter of the control period of 2 ms");
  for (const bool loaded : {false, true}) {
    for (const bool realtime : {true, false}) {
      const VehicleFigures figures = hover(1, 500, realtime, options.seconds, loaded).vehicles.front();
      const bool granted = figures.control.realtime_scheduling();
      const std::string name = std::string(loaded ? "loaded" : "idle") + ", " +
                               (granted ? "SCHED_FIFO" : "SCHED_OTHER") +
                               (realtime && !granted ? " (FIFO refused)" : "");
      table.add({name + ", p50", figures.control.period_jitter_p50_us(), "us", "the period", 2000.0, ""});
      table.add({name + ", p99", figures.control.period_jitter_p99_us(), "us", "the period", 2000.0, ""});
      table.add({name + ", max", figures.control.period_jitter_max_us(), "us", "the period", 2000.0, ""});
    }
  }
}

// The time of a step, from a longer and a shorter flight: without start and end, which take a second together.
void lockstep_steps(Table& table, const fs::path& folder) {
  int flights = 0;
  const auto fly = [&](int hover_s) {
    const fs::path record = folder / ("hover" + std::to_string(++flights));
    const fs::path mission = folder / ("hover" + std::to_string(hover_s) + ".yaml");
    std::ofstream(mission) << "name: hover\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                              "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: "
                           << hover_s << "}\n  - {kind: land, speed_m_s: 0.5}\n";
    return json::parse(output_of(program("swiftlet").string() + " fly " + mission.string() +
                                 " --clock lockstep --json --record " + record.string()));
  };
  std::vector<double> steps_us;
  std::vector<double> bare_us;
  for (int i = 0; i < 3; ++i) {
    const json shorter = fly(10);
    const json longer = fly(170);
    steps_us.push_back(1e6 * (longer.at("wall_s").get<double>() - shorter.at("wall_s").get<double>()) /
                       (longer.at("cycles").get<double>() - shorter.at("cycles").get<double>()));
    const json bare = json::parse(output_of(program("ping_pong_bench").string() +
                                            " --json --no-realtime --seconds 1 --rate 0 --transport udp"));
    bare_us.push_back(bare[0].at("p50_us").get<double>());
  }
  std::sort(steps_us.begin(), steps_us.end());
  std::sort(bare_us.begin(), bare_us.end());
  table.add({"a step, median of 3", steps_us[1], "us", "bare Fast DDS ping-pong, back to back", bare_us[1],
             "at most 1.25"});
  table.add({"simulated over wall time, without start and end", 2000.0 / steps_us[1], "x", "", 0.0, ""});
}

void simulated_time(Table& table) {
  const json plant = benchmarks("plant_step_bench", ".*");
  const json inner = benchmarks("inner_loop_bench", ".*");
  const json loop = benchmarks("closed_loop_bench", ".*");
  const double plant_ns = cpu_ns(plant.at("simulation_step"));
  const double inner_ns = cpu_ns(inner.at("inner_loop_step/motor_lag"));

  const tests::TemporaryFolder folder;
  std::vector<double> factors;
  for (int i = 0; i < 3; ++i) {
    const json flown =
        json::parse(output_of(program("swiftlet").string() + " fly square --clock lockstep --json --record " +
                              (folder.path() / std::to_string(i)).string()));
    factors.push_back(flown.at("real_time_factor"));
  }
  std::sort(factors.begin(), factors.end());
  table.section("(d) lockstep, separate processes, 500 Hz control");
  table.add({"square, simulated over wall time, median of 3", factors[1], "x",
             "plant and controller steps alone", 2e6 / (2.0 * plant_ns + inner_ns), "at least 20"});
  lockstep_steps(table, folder.path());

  table.section("(e) closed loop in one process, 1 kHz control, all sensor models");
  for (const auto& [name, entry] : loop.items()) {
    if (!entry.contains("real_time_factor")) continue;
    const double factor = entry.at("real_time_factor").get<double>();
    table.add({name, factor, "x", "the plant of the same flight alone",
               factor / entry.at("plant_alone").get<double>(), "at least 1000"});
  }

  table.section("(f) steps, CPU time, median of 5");
  for (const auto& [name, entry] : plant.items()) {
    table.add(
        {name, cpu_ns(entry), "ns", "the target", 300.0, name == "simulation_step" ? "with sensors" : ""});
  }
  for (const auto& [name, entry] : inner.items())
    table.add({name, cpu_ns(entry), "ns", "the target", 2000.0, ""});
  const json datagram = benchmarks("datagram_bench", ".*");
  const char* const hop = "datagram_hop_with_key";
  table.add({hop, cpu_ns(datagram.at(hop)), "ns", "the target", 3000.0, "at most 1"});
}

// Runs of the square with sampled vehicles per second, on one core and on 2, 4 ... of them.
void batches(Table& table, const Options& options) {
  table.section("(j) a batch of squares with sampled vehicles, in one process");
  const tests::TemporaryFolder folder;
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  double alone = 0.0;
  for (unsigned jobs = 1;; jobs = std::min(2 * jobs, cores)) {
    constexpr double kRunsPerSecond = 40.0;  // roughly, of one core
    const auto runs = static_cast<std::size_t>(kRunsPerSecond * options.seconds * jobs);
    const std::string out = (folder.path() / std::to_string(jobs)).string();
    const json flown = json::parse(
        output_of(program("swiftlet").string() + " sim batch square --dispersion kaylion --json --runs " +
                  std::to_string(runs) + " --jobs " + std::to_string(jobs) + " --out " + out));
    const double rate = static_cast<double>(runs) / flown.at("wall_s").get<double>();
    if (jobs == 1) alone = rate;
    table.add({std::to_string(jobs) + (jobs == 1 ? " core" : " cores"), rate, "runs/s",
               "cores times one core", alone * jobs, ""});
    if (jobs >= cores) return;
  }
}

void missions(Table& table) {
  constexpr std::size_t kWaypoints = 1000;
  table.section("(h) a mission of 1,000 waypoints, to a vehicle that hovers");
  const tests::TemporaryFolder folder;
  Fleet fleet(1, 500, true, folder.path());
  fleet.take_off();
  const Fleet::MissionStart took = fleet.start_mission(kWaypoints);
  table.add({"until its upload is answered", 1e3 * took.uploaded_s, "ms", "", 0.0, ""});
  table.add(
      {"until the vehicle says that it flies it", 1e3 * took.started_s, "ms", "the target", 1000.0, ""});
}

void planning(Table& table) {
  table.section(
      "(g) a step of plant and controller that evaluates a request or setpoint in motion, CPU time");
  for (const tests::StepTimes& times : tests::longest_steps()) {
    table.add({times.what + ": median", times.median_us, "us", "", 0.0, ""});
    table.add(
        {times.what + ": longest", times.longest_us, "us", "half a control period of 2 ms", 1000.0, ""});
  }
}

constexpr double kFleetShare = 4.0;  // times longer, since the counts are small
// With real-time priority, more vehicles than the cores can serve stop the computer for minutes.
constexpr int kRealtimeVehiclesPerCore = 8;
constexpr int kFleetRotorSpeedRateHz = 100;  // five times what the observer of the controller follows

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 100.0;
}

void fleet(Table& table, const Options& options, int vehicles, bool realtime, const std::string& name) {
  const double seconds = kFleetShare * options.seconds;
  const FleetFigures flown = hover(vehicles, 500, realtime, seconds, false, true, kFleetRotorSpeedRateHz);
  const json bare = json::parse(output_of(program("fleet_bench").string() + " --json --vehicles " +
                                          std::to_string(vehicles) + " --seconds " + std::to_string(seconds) +
                                          (realtime ? "" : " --no-realtime")));
  double worst_overdue = 0.0;
  double worst_late = 0.0;
  for (const VehicleFigures& one : flown.vehicles) {
    worst_overdue = std::max(worst_overdue, percent(one.overdue, one.answered));
    worst_late = std::max(worst_late, percent(one.late_steps, one.cycles));
  }
  double cpu = 0.0;
  for (const double process : flown.cpu_percent) cpu += process;
  table.add({name + ": answers after a period, worst", worst_overdue, "%",
             "cores that stood still for longer", flown.stalls_percent,
             vehicles <= 16 ? "at most 0.1 above" : ""});
  table.add({name + ": answers after a period, worst", worst_overdue, "%", "the messages alone",
             bare.at("overdue_percent").get<double>(), ""});
  table.add({name + ": steps late by half a period, worst", worst_late, "%", "", 0.0, ""});
  table.add({name + ": datagrams refused", static_cast<double>(flown.refused), "", "", 0.0, "none"});
  table.add({name + ": CPU of all processes", cpu, "% core", "the messages alone",
             bare.at("cpu_percent").get<double>(), ""});
  table.add({name + ": threads", static_cast<double>(flown.threads), "", "the messages alone",
             bare.at("threads").get<double>(), ""});
  table.add({name + ": context switches", flown.switches_per_s, "/s", "the messages alone",
             bare.at("switches_per_s").get<double>(), ""});
}

void fleets(Table& table, const Options& options) {
  table.section(
      "(i) vehicles in one domain of this computer, 500 Hz each, rotor speeds at 100 Hz, one process of each "
      "role");
  const int most_realtime =
      kRealtimeVehiclesPerCore * static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (const int vehicles : options.vehicles) {
    const bool realtime = vehicles <= most_realtime;
    const std::string name = std::to_string(vehicles) + (vehicles == 1 ? " vehicle" : " vehicles") +
                             (realtime ? "" : ", no real-time priority");
    try {
      fleet(table, options, vehicles, realtime, name);
    } catch (const std::runtime_error& error) {
      if (realtime) throw;  // else they may be more than the computer carries
      table.add({name + ": flown", 0.0, "", "", 0.0, error.what()});
    }
  }
}

void run(const Options& options) {
  Table table(options.json);
  const auto wanted = [&](const char* section) {
    return options.only.empty() ||
           std::find(options.only.begin(), options.only.end(), section) != options.only.end();
  };
  if (wanted("latency")) latency_and_load(table, options);
  if (wanted("jitter")) jitter(table, options);
  if (wanted("simulation")) simulated_time(table);
  if (wanted("planning")) planning(table);
  if (wanted("missions")) missions(table);
  if (wanted("fleet")) fleets(table, options);
  if (wanted("batch")) batches(table, options);
  table.end();
}

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--seconds", options.seconds, "duration of each measurement in real time, s")
      .range(1.0, 3600.0);
  app.add_option("--only", options.only, "only these sections; may be repeated")
      .one_of({"latency", "jitter", "simulation", "planning", "missions", "fleet", "batch"});
  app.add_option("--vehicles", options.vehicles,
                 "numbers of vehicles of the section fleet; may be repeated; more than 8 for each core fly "
                 "without real-time priority")
      .range(1, 36);
  app.add_flag("--json", options.json, "print JSON");
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  return runtime::run_process(
      {"system_bench", "Measures the figures of the system, each beside its limit in the same run.",
       "--only latency --seconds 10"},
      argc, argv, [&](runtime::CommandLine app) { add_options(app, options); }, [&] { run(options); });
}
