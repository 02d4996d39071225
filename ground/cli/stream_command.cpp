#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flight_csv.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/missions/flight_table.hpp"
#include "swiftlet/io/missions/setpoint_rows.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

using control::Mode;
using namespace std::chrono_literals;

constexpr double kLeastRate_hz = 2.0;
constexpr double kRateTolerance = 1e-6;
constexpr auto kSendStep = 2ms;
constexpr double kSlack_s = 1.5;  // vehicle clock: longest time until its status says setpoint
constexpr auto kSilence = 3s;
constexpr auto kManoeuvreTimeout = 60s;
constexpr double kThere_m = 0.02;  // from the reference to the first position of a stream

struct StreamOptions : CommandOptions {
  std::string file;
  std::optional<double> rate_hz;
  std::optional<io::MissionFrame> frame;
  bool land = false;
};

// What was sent, and whether it failed.
struct StreamResult {
  std::uint64_t sent = 0;
  double duration_s = 0.0;
  SetpointTally tally;  // of this stream alone
  std::string fault;    // a sentence; empty if the whole stream was sent
};

void require_rate(const std::vector<io::TimedSetpoint>& rows, const std::string& file) {
  if (rows.size() < 2)
    throw io::ConfigError(file, 0, "", "has " + std::to_string(rows.size()) + " rows, must have at least 2");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double gap_s = rows[i].time_s - rows[i - 1].time_s;
    if (gap_s <= (1.0 + kRateTolerance) / kLeastRate_hz) continue;
    throw io::InputError(
        file + ": " +
        fmt::format("the row after t = {:.3f} s is {:.3f} s later, limit {:.1f} s; --rate interpolates "
                    "between the rows",
                    rows[i - 1].time_s, gap_s, 1.0 / kLeastRate_hz));
  }
}

io::SetpointSource each_of(std::vector<io::TimedSetpoint> rows) {
  return [rows = std::move(rows), next = std::size_t{0}]() mutable -> std::optional<io::TimedSetpoint> {
    if (next == rows.size()) return std::nullopt;
    return rows[next++];
  };
}

io::SetpointSource piped_lines(std::shared_ptr<io::SetpointRows> reader) {
  return [reader = std::move(reader)]() -> std::optional<io::TimedSetpoint> {
    for (std::string line; std::getline(std::cin, line);) {
      if (auto row = reader->read(line)) return row;
    }
    return std::nullopt;
  };
}

std::string rest_of(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

void say(const std::string& name, const std::string& assumption) {
  std::fprintf(stderr, "%s: %s\n", name.c_str(), assumption.c_str());
}

io::SetpointSource at_rate(io::SetpointSource source, const std::optional<double>& rate_hz) {
  if (!rate_hz) return source;
  return io::resampled(std::move(source), *rate_hz);
}

// Reads a whole file, so that nothing is flown of one with an error further down.
io::SetpointSource open(const StreamOptions& options) {
  const bool piped = options.file == "-";
  const std::string name = piped ? "standard input" : options.file;
  std::string text;
  if (piped) {
    std::getline(std::cin, text);
  } else {
    text = io::read_text_file(options.file);
  }
  const std::vector<std::string> header = io::first_csv_line(text, name);
  if (header.empty()) throw io::ConfigError(name, 0, "", "is empty, must hold setpoints such as t,x,y,z");
  std::vector<io::TimedSetpoint> rows;
  if (io::is_flight_csv(header)) {
    if (piped) text += "\n" + rest_of(std::cin);
    const io::Table reference = io::reference_of_flight(text, name);
    say(name, io::extent_of(reference));
    rows = io::setpoints_of(reference, options.frame);
  } else {
    auto reader = std::make_shared<io::SetpointRows>(header, name, options.frame);
    if (reader->assumption()) say(name, *reader->assumption());
    if (piped) return at_rate(piped_lines(std::move(reader)), options.rate_hz);
    const std::vector<io::CsvLine> lines = io::csv_lines(text, name);
    for (std::size_t i = 1; i < lines.size(); ++i) rows.push_back(reader->read(lines[i]));
  }
  if (!options.rate_hz) require_rate(rows, name);
  return at_rate(each_of(std::move(rows)), options.rate_hz);
}

// Flies to the first setpoint of a stream of positions. Returns a sentence if that fails.
std::optional<std::string> go_to_start(Vehicle& vehicle, const control::Setpoint& first,
                                       const StreamOptions& options, const Interrupts& interrupts) {
  if (first.kind != control::SetpointKind::kPosition) return std::nullopt;
  const VehicleState state = vehicle.state();
  if (state.mode != Mode::kHolding ||
      (state.reference_position_ned_m - first.position_ned).norm() <= kThere_m)
    return std::nullopt;
  std::fprintf(stderr, "stream: flying to the first setpoint\n");
  Vehicle::Target place;
  place.position_ned_m = first.position_ned;
  if (!first.yaw_free) place.yaw_rad = first.yaw_rad;
  const ActionHandle going = vehicle.go_to(place, options.timeout());
  const double limit_s = std::chrono::duration<double>(kManoeuvreTimeout).count();
  const ActionResult ending =
      await_actions({{&vehicle, going}}, "stream", OnInterrupt::kHold, interrupts, limit_s).front();
  if (ending.done()) return std::nullopt;
  return "the first setpoint was not reached: " + ending.reason;
}

class Streamer {
 public:
  Streamer(Vehicle& vehicle, const Interrupts& interrupts)
      : vehicle_(vehicle), interrupts_(interrupts), before_(vehicle.state().setpoints) {}

  StreamResult run(const io::TimedSetpoint& first, const io::SetpointSource& source) {
    begin_s_ = vehicle_.clock_s();
    for (std::optional<io::TimedSetpoint> next = first; next; next = source()) {
      if (!wait_for(next->time_s - first.time_s)) break;
      if (!vehicle_.send(next->setpoint)) {
        result_.fault = "connection to the control service lost";
        break;
      }
      ++result_.sent;
    }
    result_.duration_s = vehicle_.clock_s() - begin_s_;
    // A status sent later than the last setpoint counts all of them.
    const double last_s = vehicle_.clock_s();
    vehicle_.wait_until(
        [&](const VehicleState& state) { return 1e-9 * static_cast<double>(state.stamp_ns) > last_s + 0.25; },
        kSilence);
    result_.tally = vehicle_.state().setpoints.since(before_);
    if (result_.tally.refused > 0) {
      result_.fault = with_refusal();
    } else if (result_.fault.empty() && result_.tally.accepted == 0) {
      result_.fault = "no setpoint was accepted";
    }
    return result_;
  }

 private:
  // Waits until the stream's time is t_s. Returns false if the stream ends before.
  bool wait_for(double t_s) {
    auto moved = std::chrono::steady_clock::now();
    double last_s = vehicle_.clock_s();
    while (last_s - begin_s_ < t_s) {
      if (!goes_on()) return false;
      std::this_thread::sleep_for(kSendStep);
      const double now_s = vehicle_.clock_s();
      const auto now = std::chrono::steady_clock::now();
      if (now_s > last_s) moved = now;
      last_s = now_s;
      if (now - moved > kSilence) {
        result_.fault = "no data from the vehicle for 3 s";
        return false;
      }
    }
    return goes_on();
  }

  bool goes_on() {
    if (interrupts_.count() > 0) {
      result_.fault = "interrupted";
      return false;
    }
    const VehicleState state = vehicle_.state();
    const double since_s = vehicle_.clock_s() - begin_s_;
    followed_ = followed_ || state.mode == Mode::kSetpoint;
    if (state.mode == Mode::kSetpoint || (!followed_ && since_s < kSlack_s)) return true;
    result_.fault =
        fmt::format("stopped after {:.1f} s: the vehicle is {}", since_s, control::to_string(state.mode));
    starved_ = followed_ && state.mode_reason == control::to_string(control::Reason::kSetpointsStopped);
    if (followed_) result_.fault += ": " + state.mode_reason;
    return false;
  }

  // The fault of a stream with refused setpoints. A vehicle that holds because the setpoints stopped does so
  // because of the refusals.
  std::string with_refusal() const {
    const SetpointTally& tally = result_.tally;
    const std::string refused =
        fmt::format("{} of {} setpoints refused: {}", tally.refused, result_.sent, tally.refusal);
    if (starved_) return fmt::format("stopped after {:.1f} s: ", result_.duration_s) + refused;
    return result_.fault.empty() ? refused : result_.fault + "; " + refused;
  }

  Vehicle& vehicle_;
  const Interrupts& interrupts_;
  SetpointTally before_;
  double begin_s_ = 0.0;
  bool followed_ = false;
  bool starved_ = false;  // the vehicle holds, because the setpoints stopped
  StreamResult result_;
};

// Waits until the vehicle holds, or lands it. Returns a sentence if that fails.
std::optional<std::string> come_to_rest(Vehicle& vehicle, const StreamOptions& options) {
  if (options.land) {
    const ActionResult landed = vehicle.land(0.4, options.timeout()).wait(kManoeuvreTimeout);
    return landed.done() ? std::nullopt : std::optional("the vehicle did not land: " + landed.reason);
  }
  const bool rests =
      vehicle.wait_until([](const VehicleState& state) { return state.mode != Mode::kSetpoint; }, 10s);
  return rests ? std::nullopt
               : std::optional<std::string>("the vehicle still follows setpoints, sent by another program");
}

void print(const StreamResult& result, const VehicleState& end, bool json) {
  if (json) {
    nlohmann::ordered_json text = {{"sent", result.sent},
                                   {"accepted", result.tally.accepted},
                                   {"refused", result.tally.refused},
                                   {"duration_s", result.duration_s},
                                   {"mode", control::to_string(end.mode)}};
    if (!result.fault.empty()) text["reason"] = result.fault;
    std::printf("%s\n", io::json_text(text).c_str());
  } else {
    std::printf(
        "stream: %llu setpoints in %.1f s, %llu accepted and %llu refused; now %s at (%.2f, %.2f, "
        "%.2f) m\n",
        static_cast<unsigned long long>(result.sent), result.duration_s,
        static_cast<unsigned long long>(result.tally.accepted),
        static_cast<unsigned long long>(result.tally.refused), control::to_string(end.mode),
        end.position_ned_m.x(), end.position_ned_m.y(), end.position_ned_m.z());
  }
  if (!result.fault.empty()) std::fprintf(stderr, "swiftlet: stream: %s\n", result.fault.c_str());
}

int stream(const StreamOptions& options) {
  io::SetpointSource source = open(options);
  const Interrupts interrupts;
  Vehicle vehicle(options.network);
  vehicle.cancel_when([&] { return interrupts.count() > 0; });
  const Result there = vehicle.connect(options.timeout());
  if (!there.accepted()) {
    std::fprintf(stderr, "swiftlet: stream: %s\n", there.reason.c_str());
    return io::kFailed;
  }
  log_connection(vehicle, "stream");
  vehicle.wait_until(
      [](const VehicleState& state) {
        return state.reference_position_ned_m.allFinite() && state.position_ned_m.allFinite();
      },
      options.timeout());
  const std::optional<io::TimedSetpoint> first = source();
  if (!first) throw io::InputError(options.file + ": has no rows");
  StreamResult result;
  if (const auto fault = go_to_start(vehicle, first->setpoint, options, interrupts)) {
    result.fault = *fault;
  } else {
    vehicle.cancel_when({});  // the streamer ends with an interrupt, and the vehicle may still land
    result = Streamer(vehicle, interrupts).run(*first, source);
    const auto left = come_to_rest(vehicle, options);
    if (result.fault.empty() && left) result.fault = *left;
  }
  print(result, vehicle.state(), options.json);
  return result.fault.empty() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_stream_command(runtime::CommandLine root) {
  const auto options = std::make_shared<StreamOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      root, "stream", "Stream setpoints from a CSV file, timed by the vehicle's clock",
      "swiftlet stream circle.csv --rate 50    (header: t [s],x_ned [m],y_ned [m],z_ned [m])", options);
  app.footer(
      "Setpoints are positions, velocities, accelerations, attitudes and thrust, or body rates and "
      "thrust.\nThe "
      "vehicle must hold. It holds again at the end, or lands with --land.\n\n" +
      app.footer());
  app.add_option("file", options->file,
                 "CSV file whose header names the columns with frame and unit, or is "
                 "t,x,y,z[,vx,vy,vz[,ax,ay,az]][,yaw] (ENU); or that of a flight, by `swiftlet log csv`; - "
                 "streams from "
                 "standard input")
      .required();
  add_frame_option(app, options->frame);
  app.add_option("--rate", options->rate_hz,
                 "interpolate between the rows and send at this rate, Hz; default: send each row at its time")
      .range(kLeastRate_hz, 1000.0);
  app.add_flag("--land", options->land, "land at the end, also if the stream ends early");
  return {app, [options] { return stream(*options); }};
}

}  // namespace swiftlet::ground
