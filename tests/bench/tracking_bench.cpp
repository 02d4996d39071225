// Tracking error of five common paths, flown in one process: 3-D error against ground truth, with perfect
// state feedback and with all sensor models; and of two of them at two and three times the speed, beside what the rotors
// can do. Figures of other projects were measured on such a machine with
// their own vehicles and gains and perfect state feedback.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/ground/mission/pace.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/bench/rough_air.hpp"
#include "tests/bench/tracking_paths.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet {
namespace {

using bench::Path;
using Eigen::Vector3d;

constexpr double kHover = 5.0;  // s before a path
constexpr double kJoin = 0.5;   // s, join to a trajectory that starts at the current position
constexpr double kJump = 1e-4;  // m, step between segments with rounded coefficients

struct Options {
  std::string figure_of_eight = tests::in_source("tests/data/crazyswarm_figure8.csv");
  std::uint64_t seed = 1;
  std::vector<std::string> logs;
  bool json = false;
  bool rough = false;
  int flights = 200;
};

struct Score {
  double rms_m = 0.0;
  double peak_m = 0.0;
};

control::Request request(control::RequestKind kind) {
  control::Request out;
  out.kind = kind;
  return out;
}

void send_request(simulation::ClosedLoop& loop, const control::Request& request) {
  const control::Outcome outcome = loop.controller.request(request);
  if (!outcome.accepted) throw std::runtime_error(outcome.reason);
}

Score fly(const Path& path, const plant::SimulationSettings& simulation,
          const control::ControlSettings& settings, std::uint64_t seed) {
  const control::Outcome checked = control::check(path.trajectory, settings.limits);
  if (!checked.accepted) throw std::runtime_error(path.name + ": " + checked.reason);
  simulation::ClosedLoop loop(io::load_vehicle(io::find_config("vehicles/kaylion.yaml")), simulation,
                              settings, seed);
  loop.step_until([&] { return loop.time_s() >= 1.0; }, 2.0);
  send_request(loop, request(control::RequestKind::kArm));
  control::Request takeoff = request(control::RequestKind::kTakeoff);
  takeoff.position_ned.z() = -bench::kHeight;
  send_request(loop, takeoff);
  if (!loop.step_until([&] { return loop.controller.status().mode == control::Mode::kHolding; }, 20.0))
    throw std::runtime_error("did not take off");
  const double hover_end = loop.time_s() + kHover;
  loop.step_until([&] { return loop.time_s() >= hover_end; }, 2.0 * kHover);

  control::Request follow = request(control::RequestKind::kTrajectory);
  follow.trajectory = &path.trajectory;
  send_request(loop, follow);
  const double start_s = loop.time_s() + kJoin;
  Score score;
  double sum = 0.0;
  int samples = 0;
  while (loop.time_s() < start_s + path.score_to_s) {
    loop.step();
    const double t = loop.time_s() - start_s;
    if (t < path.score_from_s) continue;
    const Vector3d commanded = bench::reference_at(path.trajectory, t);
    if ((loop.controller.reference().position_ned - commanded).norm() > kJump)
      throw std::runtime_error(path.name + ": the controller does not follow the trajectory of this time");
    const Vector3d desired = path.position_ned ? path.position_ned(t) : commanded;
    const double error = (loop.plant.state().position_ned - desired).norm();
    sum += error * error;
    score.peak_m = std::max(score.peak_m, error);
    ++samples;
  }
  score.rms_m = std::sqrt(sum / samples);
  return score;
}

struct Peer {
  const char* name;
  std::array<double, 5> rms_m;
};

constexpr Peer kPeers[] = {
    {"kr SO3 (100 Hz, 1 kHz)", {0.0137, 0.030, 0.0001, 0.0025, 0.0010}},
    {"flightlib + rpg (100 Hz)", {0.0144, 0.030, 0.0001, 0.0070, 0.0011}},
    {"RotorPy SE3, Crazyflie, 500 Hz", {0.018, 0.037, 0.009, 0.023, 0.031}},
    {"Crazyflie Mellinger, mass matched", {0.020, 0.033, 0.014, 0.020, 0.019}},
    {"the same, stock mass", {0.055, 0.061, 0.053, 0.063, 0.061}},
    {"mrs position + feed-forward", {0.034, 0.070, 0.005, 0.135, 0.060}},
    {"PX4 with feed-forward", {0.100, 0.200, 0.114, 0.236, 0.515}},
    {"Crazyflie PID", {0.109, 0.218, 0.132, 0.394, 0.648}},
};

// A path at a multiple of its speed, by the vehicle's model and in flight.
struct FastFlight {
  std::string path;
  double speed = 1.0;                         // times that of the path
  std::vector<control::WorstDemand> demands;  // indexed by control::Demand
  std::optional<Score> perfect, sensors;      // none: not flown to the end
  std::string failure;                        // why

  const control::WorstDemand& of(control::Demand demand) const {
    return demands[static_cast<std::size_t>(demand)];
  }
  double rotor_use() const {  // share of the way from the middle of the range to the closer limit
    using control::Demand;
    const double middle_n = 0.5 * (of(Demand::kRotorLeast).limit + of(Demand::kRotorMost).limit);
    return std::max((of(Demand::kRotorMost).value - middle_n) / (of(Demand::kRotorMost).limit - middle_n),
                    (middle_n - of(Demand::kRotorLeast).value) / (middle_n - of(Demand::kRotorLeast).limit));
  }
};

// The limits of speed and acceleration of the control settings out of the way of those of the vehicle.
control::ControlSettings agile(control::ControlSettings settings) {
  settings.limits.max_speed = 20.0;
  settings.limits.max_acceleration = 50.0;
  return settings;
}

FastFlight fly_fast(const Path& path, double speed, const plant::SimulationSettings& perfect,
                    const plant::SimulationSettings& real, const control::ControlSettings& settings,
                    std::uint64_t seed) {
  const plant::Vehicle vehicle = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  const Path fast = bench::faster(path, speed);
  FastFlight out{path.name, speed, {}, {}, {}, ""};
  out.demands = control::worst_demands(vehicle, settings.limits, settings.failsafe.low_battery_voltage,
                                       fast.trajectory.segments);
  try {
    out.perfect = fly(fast, perfect, settings, seed);
    out.sensors = fly(fast, real, settings, seed);
  } catch (const std::runtime_error& failure) {
    out.failure = failure.what();
  }
  return out;
}

nlohmann::ordered_json json_of(const FastFlight& flight) {
  using control::Demand;
  nlohmann::ordered_json json{{"name", fmt::format("{} at {:g} times the speed", flight.path, flight.speed)},
                              {"speed_m_s", flight.of(Demand::kSpeed).value},
                              {"acceleration_m_s2", flight.of(Demand::kAcceleration).value},
                              {"tilt_rad", flight.of(Demand::kTilt).value},
                              {"rotor_use", flight.rotor_use()}};
  if (flight.perfect)
    json["perfect"] = {{"rms_m", flight.perfect->rms_m}, {"peak_m", flight.perfect->peak_m}};
  if (flight.sensors)
    json["sensors"] = {{"rms_m", flight.sensors->rms_m}, {"peak_m", flight.sensors->peak_m}};
  if (!flight.failure.empty()) json["failure"] = flight.failure;
  return json;
}

void print_fast(const std::vector<FastFlight>& flights) {
  using control::Demand;
  std::printf("\n%-12s%8s%8s%8s%10s   %-22s%s\n", "path, times", "m/s", "m/s^2", "deg", "rotors %",
              "perfect: RMS, peak mm", "sensors: RMS, peak mm");
  const auto text = [](const std::optional<Score>& score) {
    return score ? fmt::format("{:.2f}, {:.2f}", score->rms_m * 1e3, score->peak_m * 1e3) : std::string("-");
  };
  for (const FastFlight& flight : flights) {
    std::printf("%-6s%6.0f%8.2f%8.2f%8.1f%10.0f   %-22s%s%s\n", flight.path.c_str(), flight.speed,
                flight.of(Demand::kSpeed).value, flight.of(Demand::kAcceleration).value,
                flight.of(Demand::kTilt).value * 180.0 / M_PI, 100.0 * flight.rotor_use(),
                text(flight.perfect).c_str(), text(flight.sensors).c_str(),
                flight.failure.empty() ? "" : ("  " + flight.failure).c_str());
  }
  std::printf(
      "The limits of speed and acceleration of the control settings are set aside; that of tilt is %.1f deg. "
      "Rotors: share of the way from the middle of their range of thrust, with a battery at its low "
      "threshold.\n",
      flights.front().of(Demand::kTilt).limit * 180.0 / M_PI);
}

// How many times as fast the vehicle can fly a path with a reserve, and what it meets then.
std::string limit_of(const Path& path, const control::ControlSettings& settings) {
  const plant::Vehicle vehicle = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  const io::TrajectoryFile file{path.trajectory.segments, {}};
  ground::CheckConditions conditions = ground::at_start_of(file);
  conditions.reserve = 0.1;
  const ground::Pace pace =
      ground::fastest_pace(ground::mission_of(path.name, file, settings), vehicle, settings, conditions);
  return fmt::format("{}: {:.2f} times as fast with a reserve of 10 %; faster, {}", path.name,
                     1.0 / pace.time_scale, pace.limit);
}

using Scores = std::array<Score, 5>;

void print_scores(const std::vector<Path>& paths, const Scores& with_perfect, const Scores& with_sensors) {
  std::printf("%-42s", "3-D error against truth, RMS in mm");
  for (const Path& path : paths) std::printf("%8s", path.name.c_str());
  std::printf("\n");
  const auto print = [](const char* name, const auto& values) {
    std::printf("%-42s", name);
    for (const double value : values) std::printf("%8.2f", value * 1e3);
    std::printf("\n");
  };
  const auto of = [](const Scores& scores, double Score::*what) {
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = scores[i].*what;
    return values;
  };
  print("Swiftlet, perfect state feedback, 1 kHz", of(with_perfect, &Score::rms_m));
  print("  peak", of(with_perfect, &Score::peak_m));
  print("Swiftlet, all sensor models, 500 Hz", of(with_sensors, &Score::rms_m));
  print("  peak", of(with_sensors, &Score::peak_m));
  for (const Peer& peer : kPeers) print(peer.name, peer.rms_m);
  std::printf(
      "\nsq2: 2 m square at 1 m, 4 s hold, sides of 8 s at constant speed, 4 s hold; sq4: 4 m; sq2j: "
      "minimum-jerk sides;\n"
      "fig8: 5 laps of crazyswarm's figure8.csv; lem: x = 2 sin(wt), y = sin(2wt), 10 s a lap, from the "
      "second lap.\n"
      "Swiftlet is commanded sq2 and sq4 with corners that polynomials round off; scored against the path "
      "with its corners.\n"
      "All sensor models: IMU noise and bias, mocap at 100 Hz with 0.1 mm and 10 ms of latency, the battery "
      "sagging.\n");
}

void run(const Options& options) {
  control::ControlSettings settings = io::load_control_settings(io::find_config("control/motor_lag.yaml"));
  settings.limits.fence_min_ned = {-5.0, -5.0, -2.5};  // sq4 exceeds the default fence
  settings.limits.fence_max_ned = {5.0, 5.0, 0.2};
  plant::SimulationSettings perfect = io::load_simulation_settings(io::find_config("simulation/ideal.yaml"));
  perfect.imu.rate_hz = perfect.mocap.rate_hz = perfect.rotor_speed_rate_hz = 1000.0;
  const plant::SimulationSettings real =
      io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  const std::vector<Path> paths = {bench::square("sq2", 2.0), bench::square("sq4", 4.0),
                                   bench::minimum_jerk_square(),
                                   bench::figure_of_eight(options.figure_of_eight, 5), bench::lemniscate()};

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto add = [&](const std::string& name, const plant::SimulationSettings& simulation) {
    nlohmann::ordered_json row{{"name", name}};
    Scores scores;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      scores[i] = fly(paths[i], simulation, settings, options.seed);
      row[paths[i].name] = {{"rms_m", scores[i].rms_m}, {"peak_m", scores[i].peak_m}};
    }
    rows.push_back(row);
    return scores;
  };
  const auto with_perfect = add("Swiftlet, perfect state feedback, 1 kHz", perfect);
  const auto with_sensors = add("Swiftlet, all sensor models, 500 Hz", real);
  std::vector<FastFlight> fast;
  const control::ControlSettings up_to_the_rotors = agile(settings);
  for (const std::size_t path : {std::size_t{3}, std::size_t{4}}) {
    for (const double speed : {1.0, 2.0, 3.0})
      fast.push_back(fly_fast(paths[path], speed, perfect, real, up_to_the_rotors, options.seed));
  }
  if (options.json) {
    for (const FastFlight& flight : fast) rows.push_back(json_of(flight));
    std::printf("%s\n", rows.dump().c_str());
    return;
  }
  print_scores(paths, with_perfect, with_sensors);
  print_fast(fast);
  for (const std::size_t path : {std::size_t{3}, std::size_t{4}})
    std::printf("%s\n", limit_of(paths[path], up_to_the_rotors).c_str());
}

// The errors of recorded flights, from the messages in their files.
void score_logs(const Options& options) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::string& log : options.logs) {
    const mcap::Reader file(log);
    for (const auto& [vehicle, flight] : record::read_flights(file)) {
      const record::Evaluation flown = record::evaluate(flight);
      if (flown.errors.matched == 0)
        throw io::ConfigError(log, 0, "/" + vehicle, "has no ground truth and reference of a mission");
      rows.push_back({{"name", log + " " + vehicle},
                      {"rms_m", flown.errors.rms_3d_m},
                      {"peak_m", flown.errors.peak_3d_m},
                      {"samples", flown.errors.matched}});
    }
  }
  if (options.json) {
    std::printf("%s\n", rows.dump().c_str());
    return;
  }
  std::printf("%-42s%8s%8s%10s\n", "3-D error against truth, mm", "RMS", "peak", "samples");
  for (const auto& row : rows) {
    std::printf("%-42s%8.2f%8.2f%10zu\n", row["name"].get<std::string>().c_str(),
                row["rms_m"].get<double>() * 1e3, row["peak_m"].get<double>() * 1e3,
                row["samples"].get<std::size_t>());
  }
}

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("log", options.logs,
                 "MCAP files of recorded flights: print their errors in place of those of the paths")
      .type_name("LOG...");
  app.add_option("--figure-of-eight", options.figure_of_eight, "Crazyswarm trajectory file").show_default();
  app.add_option("--seed", options.seed, "seed of the sensor errors").show_default();
  const runtime::Option rough =
      app.add_flag("--rough", options.rough, "fly the square in rough air instead, by several control laws");
  app.add_option("--flights", options.flights, "with --rough: flights in gusts by each law")
      .range(1, 10'000)
      .needs(rough)
      .show_default();
  app.add_flag("--json", options.json, "print JSON instead of the table");
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  return runtime::run_process(
      {"tracking_bench", "Tracking errors of five paths, beside those of other projects.", "--json"}, argc,
      argv, [&](runtime::CommandLine app) { add_options(app, options); },
      [&] {
        if (options.rough) return bench::fly_rough_air({options.flights, options.json});
        options.logs.empty() ? run(options) : score_logs(options);
      });
}
