#include <algorithm>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/terminal/progress_line.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/setpoint_rows.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using namespace std::chrono_literals;

constexpr double kLeastRate_hz = 2.0;
constexpr double kRateTolerance = 1e-6;
constexpr auto kStep = 2ms;
constexpr double kSlack_s = 1.5;  // by the vehicle's clock, within which it follows, and its status says so
constexpr auto kSilence = 3s;
constexpr auto kManoeuvreTimeout = 60s;
constexpr double kThere_m = 0.02;  // from the reference to where a stream of positions begins

struct Options : RequestOptions {
  std::string file;
  std::optional<double> rate_hz;
  bool land = false;
};

// What was sent, and how it ended.
struct ReplayOptions {
  std::uint64_t sent = 0;
  double duration_s = 0.0;
  SetpointTally tally;  // of these setpoints
  std::string fault;    // a sentence; empty: all of it was streamed
};

// The whole of a file, so that nothing is flown of one with a fault further down.
std::vector<TimedSetpoint> rows_of(SetpointRows& reader, std::istream& in) {
  std::vector<TimedSetpoint> rows;
  for (std::string line; std::getline(in, line);) {
    if (const auto row = reader.read(line)) rows.push_back(*row);
  }
  return rows;
}

void require_rate(const std::vector<TimedSetpoint>& rows, const std::string& file) {
  if (rows.size() < 2)
    throw runtime::ConfigError(file, 0, "", "has " + std::to_string(rows.size()) + " rows, must have 2");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double gap_s = rows[i].time_s - rows[i - 1].time_s;
    if (gap_s <= (1.0 + kRateTolerance) / kLeastRate_hz) continue;
    throw InputError(
        file + ": " +
        fmt::format("at t = {:.3f} s the next row is {:.3f} s away, must be {:.1f} s at most: with --rate "
                    "the rows are filled in",
                    rows[i - 1].time_s, gap_s, 1.0 / kLeastRate_hz));
  }
}

SetpointSource each_of(std::vector<TimedSetpoint> rows) {
  return [rows = std::move(rows), next = std::size_t{0}]() mutable -> std::optional<TimedSetpoint> {
    if (next == rows.size()) return std::nullopt;
    return rows[next++];
  };
}

SetpointSource lines_of(std::shared_ptr<SetpointRows> reader, std::istream& in) {
  return [reader = std::move(reader), &in]() -> std::optional<TimedSetpoint> {
    for (std::string line; std::getline(in, line);) {
      if (auto row = reader->read(line)) return row;
    }
    return std::nullopt;
  };
}

SetpointSource open(const Options& options) {
  const bool piped = options.file == "-";
  const std::string name = piped ? "standard input" : options.file;
  auto file = std::make_shared<std::istringstream>(piped ? "" : runtime::read_text_file(options.file));
  std::istream& in = piped ? std::cin : *file;
  std::string header;
  std::getline(in, header);
  auto reader = std::make_shared<SetpointRows>(header, name);
  if (reader->assumption()) std::fprintf(stderr, "%s: %s\n", name.c_str(), reader->assumption()->c_str());
  SetpointSource source;
  if (piped) {
    source = lines_of(std::move(reader), in);
  } else {
    std::vector<TimedSetpoint> rows = rows_of(*reader, in);
    if (!options.rate_hz) require_rate(rows, name);
    source = each_of(std::move(rows));
  }
  if (!options.rate_hz) return source;
  return resampled(std::move(source), *options.rate_hz);
}

// Streams of positions begin where the vehicle is.
std::optional<std::string> go_to_start(Vehicle& vehicle, const control::Setpoint& first,
                                       const Options& options) {
  if (first.kind != control::SetpointKind::kPosition) return std::nullopt;
  const VehicleState state = vehicle.state();
  if (state.mode != Mode::kHolding ||
      (state.reference_position_ned_m - first.position_ned).norm() <= kThere_m)
    return std::nullopt;
  std::fprintf(stderr, "stream: going to where it begins\n");
  Vehicle::Target place;
  place.position_ned_m = first.position_ned;
  if (!first.yaw_free) place.yaw_rad = first.yaw_rad;
  const ActionHandle going = vehicle.go_to(place, options.timeout());
  const ActionResult ending = going.wait(kManoeuvreTimeout);
  if (ending.done()) return std::nullopt;
  return "where it begins was not reached: " + ending.reason;
}

class Streamer {
 public:
  Streamer(Vehicle& vehicle, const Interrupts& interrupts)
      : vehicle_(vehicle), interrupts_(interrupts), before_(vehicle.state().setpoints) {}

  ReplayOptions run(const TimedSetpoint& first, const SetpointSource& source) {
    begin_s_ = vehicle_.clock_s();
    for (std::optional<TimedSetpoint> next = first; next; next = source()) {
      if (!wait_for(next->time_s - first.time_s)) break;
      if (!vehicle_.send(next->setpoint)) {
        course_.fault = "the control service is gone";
        break;
      }
      ++course_.sent;
    }
    course_.duration_s = vehicle_.clock_s() - begin_s_;
    // What the last ones came to is told with the next status.
    const double last_s = vehicle_.clock_s();
    vehicle_.wait_until(
        [&](const VehicleState& state) { return 1e-9 * static_cast<double>(state.stamp_ns) > last_s + 0.25; },
        kSilence);
    const SetpointTally tally = vehicle_.state().setpoints;
    course_.tally = {tally.taken - before_.taken, tally.refused - before_.refused, tally.refusal};
    if (course_.fault.empty() && course_.tally.taken == 0) course_.fault = "no setpoint was followed";
    if (!course_.fault.empty() && course_.tally.refused > 0) course_.fault += "; " + course_.tally.refusal;
    return course_;
  }

 private:
  // Until the stream's time has come to t_s; false if it has ended before.
  bool wait_for(double t_s) {
    auto moved = std::chrono::steady_clock::now();
    double last_s = vehicle_.clock_s();
    while (last_s - begin_s_ < t_s) {
      if (!goes_on()) return false;
      std::this_thread::sleep_for(kStep);
      const double now_s = vehicle_.clock_s();
      const auto now = std::chrono::steady_clock::now();
      if (now_s > last_s) moved = now;
      last_s = now_s;
      if (now - moved > kSilence) {
        course_.fault = "the vehicle has said nothing for 3 s";
        return false;
      }
    }
    return goes_on();
  }

  bool goes_on() {
    if (interrupts_.count() > 0) {
      course_.fault = "interrupted";
      return false;
    }
    const VehicleState state = vehicle_.state();
    const double since_s = vehicle_.clock_s() - begin_s_;
    followed_ = followed_ || state.mode == Mode::kSetpoint;
    if (state.mode == Mode::kSetpoint || (!followed_ && since_s < kSlack_s)) return true;
    course_.fault = fmt::format("after {:.1f} s the vehicle is {}", since_s, control::to_string(state.mode));
    if (followed_) course_.fault += ": " + state.mode_reason;
    return false;
  }

  Vehicle& vehicle_;
  const Interrupts& interrupts_;
  SetpointTally before_;
  double begin_s_ = 0.0;
  bool followed_ = false;
  ReplayOptions course_;
};

// Into hold, or down.
std::optional<std::string> come_to_rest(Vehicle& vehicle, const Options& options) {
  if (options.land) {
    const ActionResult landed = vehicle.land(0.4, options.timeout()).wait(kManoeuvreTimeout);
    return landed.done() ? std::nullopt : std::optional("it did not land: " + landed.reason);
  }
  const bool rests =
      vehicle.wait_until([](const VehicleState& state) { return state.mode != Mode::kSetpoint; }, 10s);
  return rests ? std::nullopt
               : std::optional<std::string>("the vehicle still follows setpoints, of somebody else");
}

void print(const ReplayOptions& course, const VehicleState& end, bool json) {
  if (json) {
    nlohmann::ordered_json text = {{"sent", course.sent},
                                   {"taken", course.tally.taken},
                                   {"refused", course.tally.refused},
                                   {"duration_s", course.duration_s},
                                   {"mode", control::to_string(end.mode)}};
    if (!course.fault.empty()) text["reason"] = course.fault;
    std::printf("%s\n", text.dump().c_str());
  } else {
    std::printf(
        "stream: %llu setpoints in %.1f s, of which %llu were taken and %llu refused; now %s at (%.2f, %.2f, "
        "%.2f) m\n",
        static_cast<unsigned long long>(course.sent), course.duration_s,
        static_cast<unsigned long long>(course.tally.taken),
        static_cast<unsigned long long>(course.tally.refused), control::to_string(end.mode),
        end.position_ned_m.x(), end.position_ned_m.y(), end.position_ned_m.z());
  }
  if (!course.fault.empty()) std::fprintf(stderr, "swiftlet: stream: %s\n", course.fault.c_str());
}

int stream(const Options& options) {
  SetpointSource source = open(options);
  const Interrupts interrupts;
  Vehicle vehicle(options.network);
  const Result there = vehicle.connect(options.timeout());
  if (!there.accepted()) {
    std::fprintf(stderr, "swiftlet: stream: %s\n", there.reason.c_str());
    return kFailed;
  }
  log_connection(vehicle, "stream");
  vehicle.wait_until(
      [](const VehicleState& state) {
        return state.reference_position_ned_m.allFinite() && state.position_ned_m.allFinite();
      },
      options.timeout());
  const std::optional<TimedSetpoint> first = source();
  if (!first) throw InputError(options.file + ": has no rows");
  ReplayOptions course;
  if (const auto fault = go_to_start(vehicle, first->setpoint, options)) {
    course.fault = *fault;
  } else {
    course = Streamer(vehicle, interrupts).run(*first, source);
    const auto left = come_to_rest(vehicle, options);
    if (course.fault.empty() && left) course.fault = *left;
  }
  print(course, vehicle.state(), options.json);
  return course.fault.empty() ? kDone : kFailed;
}

}  // namespace

Command add_stream_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_request_subcommand(
      root, "stream",
      "Stream setpoints from a CSV file, by the vehicle's own clock: positions, velocities, accelerations, "
      "attitudes "
      "and thrust, or body rates and thrust. The vehicle must hold; afterwards it holds again, or lands",
      "swiftlet stream circle.csv --rate 50    (header: t [s],x [m],y [m],z [m])", options);
  app.add_option("file", options->file,
                 "CSV whose header names the columns with their units (NED), or "
                 "t,x,y,z[,vx,vy,vz[,ax,ay,az]][,yaw] (ENU); "
                 "- reads standard input as it comes")
      .required();
  app.add_option("--rate", options->rate_hz,
                 "send so many a second, between the rows, Hz; else each row at its time")
      .range(kLeastRate_hz, 1000.0);
  app.add_flag("--land", options->land, "land at the end, also where the stream ended early");
  return {app, [options] { return stream(*options); }};
}

}  // namespace swiftlet::ground
