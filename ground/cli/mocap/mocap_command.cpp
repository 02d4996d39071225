// `swiftlet mocap`: shows what a motion capture sends, without any vehicle, and calibrates its bodies.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/mocap/body_statistics.hpp"
#include "swiftlet/ground/cli/mocap/mocap_commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/mocap/sources/source_options.hpp"

namespace swiftlet::ground {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kReceiveTime{20};

struct MocapOptions {
  mocap::SourceOptions source;
  double time_s = 0.0;  // 0: until interrupted
  double period_s = 1.0;
  bool json = false;
};

std::chrono::nanoseconds duration_of(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
}

// Receives for this time, or until a signal comes; returns how long it was, s.
double receive(mocap::Source& source, BodyStatisticsList& statistics, double time_s,
               runtime::StopSignal& stop) {
  const auto begin = Clock::now();
  const auto end = begin + duration_of(time_s);
  mocap::SourceFrame frame;
  while (Clock::now() < end && !is_interrupted(stop) && !source.has_ended()) {
    if (source.receive(frame, kReceiveTime)) statistics.take(frame, source);
  }
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

nlohmann::ordered_json json_of(const mocap::Body& body, const BodyStatistics& seen, double time_s) {
  nlohmann::ordered_json json = {{"body", io::printable(body.name)},
                                 {"id", body.id},
                                 {"rate_hz", static_cast<double>(seen.frames) / time_s},
                                 {"tracked", seen.frames > 0 && seen.last.tracked},
                                 {"untracked", seen.untracked},
                                 {"markers", seen.last.markers},
                                 {"lost_markers", seen.last.lost_markers},
                                 {"latency_s", nullptr},
                                 {"latency_max_s", nullptr},
                                 {"longest_gap_s", seen.longest_gap_s},
                                 {"position_m", nullptr}};
  if (seen.latencies > 0) json["latency_s"] = seen.mean_latency_s();
  if (seen.latencies > 0) json["latency_max_s"] = seen.latency_max_s;
  const Eigen::Vector3d& p = seen.last.position;
  if (seen.frames > 0 && seen.last.tracked) json["position_m"] = {p.x(), p.y(), p.z()};
  return json;
}

nlohmann::ordered_json json_of(const mocap::Source& source, const BodyStatisticsList& statistics,
                               double time_s) {
  const mocap::SourceStatistics& all = source.statistics();
  nlohmann::ordered_json json = {{"server", source.description()},
                                 {"frames", all.frames},
                                 {"lost", all.lost},
                                 {"late", all.late},
                                 {"refused", all.refused},
                                 {"other_servers", all.strangers},
                                 {"restarts", all.restarts},
                                 {"bodies", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < source.bodies().size(); ++i) {
    const BodyStatistics seen = i < statistics.bodies().size() ? statistics.bodies()[i] : BodyStatistics{};
    json["bodies"].push_back(json_of(source.bodies()[i], seen, time_s));
  }
  return json;
}

std::string line_of(const mocap::Body& body, const BodyStatistics& seen, double time_s) {
  std::string line = fmt::format("{:<20} {:>6} {:>8.1f}", io::printable(body.name), body.id,
                                 static_cast<double>(seen.frames) / time_s);
  line += seen.latencies == 0
              ? fmt::format(" {:>8} {:>8}", "-", "-")
              : fmt::format(" {:>8.1f} {:>8.1f}", 1e3 * seen.mean_latency_s(), 1e3 * seen.latency_max_s);
  line += fmt::format(" {:>8.0f} {:>9}", 1e3 * seen.longest_gap_s, seen.untracked);
  line += seen.last.markers == 0
              ? fmt::format(" {:>7}", "-")
              : fmt::format(" {:>3}/{:<3}", seen.last.markers - seen.last.lost_markers, seen.last.markers);
  if (seen.frames == 0) return line + "  no frame";
  if (!seen.last.tracked) return line + "  not tracked";
  const Eigen::Vector3d& p = seen.last.position;
  return line + fmt::format("  {:.3f} {:.3f} {:.3f}", p.x(), p.y(), p.z());
}

void print(const mocap::Source& source, const BodyStatisticsList& statistics, double time_s, bool as_json) {
  if (as_json) {
    std::printf("%s\n", io::json_text(json_of(source, statistics, time_s)).c_str());
    std::fflush(stdout);
    return;
  }
  const mocap::SourceStatistics& all = source.statistics();
  std::printf("%s: %llu frames, %llu lost, %llu late, %llu refused, %llu of other servers, %llu restarts\n",
              source.description().c_str(), static_cast<unsigned long long>(all.frames),
              static_cast<unsigned long long>(all.lost), static_cast<unsigned long long>(all.late),
              static_cast<unsigned long long>(all.refused), static_cast<unsigned long long>(all.strangers),
              static_cast<unsigned long long>(all.restarts));
  std::printf("%-20s %6s %8s %8s %8s %8s %9s %7s  %s\n", "body", "id", "Hz", "ms", "max ms", "gap ms",
              "untracked", "markers", "x y z of the motion capture, m");
  for (std::size_t i = 0; i < source.bodies().size(); ++i) {
    const BodyStatistics seen = i < statistics.bodies().size() ? statistics.bodies()[i] : BodyStatistics{};
    std::printf("%s\n", line_of(source.bodies()[i], seen, time_s).c_str());
  }
  std::fflush(stdout);
}

int list_bodies(const MocapOptions& options) {
  runtime::StopSignal stop;
  const std::unique_ptr<mocap::Source> source = open_mocap_source(options.source, {});
  BodyStatisticsList statistics;
  const double time_s = receive(*source, statistics, options.time_s, stop);
  print(*source, statistics, time_s, options.json);
  if (!source->bodies().empty()) return io::kDone;
  std::fprintf(stderr, "swiftlet: mocap list: no body within %g s: %s\n", options.time_s,
               source->description().c_str());
  return io::kFailed;
}

int watch_bodies(const MocapOptions& options) {
  runtime::StopSignal stop;
  const std::unique_ptr<mocap::Source> source = open_mocap_source(options.source, {});
  BodyStatisticsList statistics;
  const auto begin = Clock::now();
  const auto is_over = [&] {
    return is_interrupted(stop) || source->has_ended() ||
           (options.time_s > 0.0 && Clock::now() - begin >= duration_of(options.time_s));
  };
  while (!is_over()) {
    const double time_s = receive(*source, statistics, options.period_s, stop);
    print(*source, statistics, time_s, options.json);
    statistics.clear();
  }
  if (source->statistics().frames > 0) return io::kDone;
  std::fprintf(stderr, "swiftlet: mocap watch: no frame arrived: %s\n", source->description().c_str());
  return io::kFailed;
}

io::Command add_list(const runtime::CommandLine& mocap) {
  const auto options = std::make_shared<MocapOptions>();
  options->time_s = 2.0;
  const runtime::CommandLine app =
      mocap.add_subcommand("list", "List the bodies that a motion capture sends");
  app.footer("example: swiftlet mocap list --source natnet");
  mocap::add_source_options(app, options->source);
  app.add_option("--time", options->time_s, "How long to listen, s").range(0.1, 600.0).show_default();
  app.add_flag("--json", options->json, "Print JSON");
  return {app, [options] { return list_bodies(*options); }};
}

io::Command add_watch(const runtime::CommandLine& mocap) {
  const auto options = std::make_shared<MocapOptions>();
  const runtime::CommandLine app =
      mocap.add_subcommand("watch", "Show the rate, latency and losses of each body, until interrupted");
  app.footer("example: swiftlet mocap watch --source vrpn --server 192.168.10.1");
  mocap::add_source_options(app, options->source);
  app.add_option("--time", options->time_s, "End after this time, s; 0: when interrupted")
      .range(0.0, 1e6)
      .show_default();
  app.add_option("--period", options->period_s, "Time between two tables, s")
      .range(0.1, 600.0)
      .show_default();
  app.add_flag("--json", options->json, "Print one line of JSON for each table");
  return {app, [options] { return watch_bodies(*options); }};
}

}  // namespace

bool is_interrupted(runtime::StopSignal& stop) { return stop.wait_for(std::chrono::milliseconds(0)); }

std::unique_ptr<mocap::Source> open_mocap_source(const mocap::SourceOptions& options,
                                                 const std::vector<std::string>& vehicles) {
  try {
    return mocap::open_source(mocap::room_of(options, vehicles));
  } catch (const std::invalid_argument& error) {
    throw io::InputError(error.what());
  }
}

io::Command add_mocap_command(runtime::CommandLine root) {
  const runtime::CommandLine mocap = root.add_subcommand("mocap", io::purpose_of("mocap"));
  mocap.require_subcommand(1, 1);
  mocap.footer(
      "Talks to the motion capture directly; neither vehicle nor DDS is needed (docs/swap-mocap.md).\n\n"
      "example: swiftlet mocap list --source natnet");
  const std::vector<io::Command> commands = {add_list(mocap), add_watch(mocap),
                                             add_mocap_calibrate_command(mocap)};
  return {mocap, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground
