#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/analysis/log/control_replay.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/replay/log_replay.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

struct LogReplayOptions {
  std::string file;
  dds::NodeSettings network;
  std::string vehicle_names;
  std::vector<std::string> topics;
  TimeRange range;
  double speed = 1.0;
  bool into_control = false;
  std::string vehicle;
  std::string control;
  double tolerance = 1e-6;
  bool json = false;
};

// By the vehicles of the file: the names under which they are published.
std::map<std::string, std::string> names_of(const LogReplayOptions& options, const mcap::Reader& file) {
  const std::vector<std::string> recorded = record::recorded_vehicles(file);
  if (recorded.empty()) (void)record::recorded_vehicle(file, "");  // says so
  const std::vector<std::string> names =
      options.vehicle_names.empty() ? recorded : messages::vehicles_of_list(options.vehicle_names);
  if (names.size() != recorded.size())
    throw io::InputError(fmt::format("--vehicle-name {}: has {} names, {} has {} vehicles",
                                     options.vehicle_names, names.size(), options.file, recorded.size()));
  std::map<std::string, std::string> by_vehicle;
  for (std::size_t i = 0; i < recorded.size(); ++i) by_vehicle[recorded[i]] = names[i];
  return by_vehicle;
}

int publish(const LogReplayOptions& options, const mcap::Reader& file) {
  ReplaySettings settings;
  settings.names = names_of(options, file);
  settings.speed = options.speed;
  settings.selection = selection_of(options.range, file);
  settings.selection.topics = {options.topics.begin(), options.topics.end()};
  for (const std::string& topic : options.topics) {
    if (std::none_of(file.channels().begin(), file.channels().end(),
                     [&](const auto& channel) { return channel.second.topic == topic; }))
      throw io::InputError("--topic " + topic + ": is not in " + options.file);
  }
  std::vector<std::string> published;
  for (const auto& [recorded, name] : settings.names) published.push_back(name);
  const Interrupts interrupts;
  const dds::FlightReservation reservation(options.network, published);
  dds::NodeSettings network = options.network;
  network.name = "replay";
  const dds::Participant participant(network, published);
  io::ProgressLine progress;
  const ReplayTotals totals = replay(file, participant, settings, [&](const ReplayTotals& now) {
    progress.update(0, fmt::format("{:.1f} s  {} messages", now.time_s, now.published));
    return interrupts.count() == 0;
  });
  progress.close();
  std::string incomplete;
  if (totals.refused > 0)
    incomplete =
        fmt::format("{} messages are of other types or versions than this program's", totals.refused);
  if (totals.published == 0) incomplete = "no message was published";
  if (interrupts.count() > 0) incomplete = "interrupted";
  if (options.json) {
    std::printf("%s\n", io::json_text(nlohmann::ordered_json({{"file", options.file},
                                                              {"complete", incomplete.empty()},
                                                              {"reason", incomplete},
                                                              {"published", totals.published},
                                                              {"refused", totals.refused},
                                                              {"time_s", totals.time_s},
                                                              {"largest_delay_s", totals.largest_delay_s}}))
                            .c_str());
  } else {
    fmt::print("replay: {}: {} messages of {:.1f} s published, {} refused; the latest was {:.1f} ms late\n",
               options.file, totals.published, totals.time_s, totals.refused, totals.largest_delay_s * 1e3);
  }
  if (!incomplete.empty()) std::fprintf(stderr, "swiftlet: replay: incomplete: %s\n", incomplete.c_str());
  return incomplete.empty() ? io::kDone : io::kFailed;
}

void print(const LogReplayOptions& options, const ControlReplay& replay, const std::string& difference) {
  fmt::print("replay: {}: {} IMU samples and {} requests into swiftlet-control (vehicle {}, control {})\n",
             options.file, replay.imu_samples, replay.requests, replay.vehicle_file, replay.control_file);
  fmt::print("  {} of {} recorded commands compared, {} requests answered otherwise\n",
             replay.commands.compared, replay.commands.messages_a, replay.other_answers);
  for (const analysis::SignalDifference& signal : replay.commands.signals)
    fmt::print("  {:<24} RMS {:>10.3g}, max {:>10.3g} at {:.3f} s\n", signal.name, signal.rms, signal.max,
               signal.max_at_s);
  fmt::print("  {}\n", difference.empty()
                           ? fmt::format("the controller does the same, within {:g}", options.tolerance)
                           : fmt::format("the controller does not do the same within {:g}: {}",
                                         options.tolerance, difference));
}

nlohmann::ordered_json to_json(const LogReplayOptions& options, const ControlReplay& replay,
                               const std::string& difference) {
  nlohmann::ordered_json json = {{"file", options.file},
                                 {"same", difference.empty()},
                                 {"reason", difference},
                                 {"tolerance", options.tolerance},
                                 {"vehicle", replay.vehicle_file},
                                 {"control", replay.control_file},
                                 {"imu_samples", replay.imu_samples},
                                 {"requests", replay.requests},
                                 {"other_answers", replay.other_answers},
                                 {"recorded", replay.commands.messages_a},
                                 {"compared", replay.commands.compared},
                                 {"signals", nlohmann::ordered_json::object()}};
  for (const analysis::SignalDifference& signal : replay.commands.signals)
    json["signals"][signal.name] = {{"rms", signal.rms}, {"max", signal.max}, {"max_at_s", signal.max_at_s}};
  return json;
}

int into_control(const LogReplayOptions& options, const mcap::Reader& file) {
  ControlReplaySettings settings;
  settings.vehicle = record::recorded_vehicle(file, options.vehicle_names);
  if (!options.vehicle.empty())
    settings.vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  if (!options.control.empty())
    settings.control_file = io::configuration_file(io::kinds::kControl, options.control);
  const Interrupts interrupts;
  io::ProgressLine progress;
  const ControlReplay replay = replay_into_control(file, settings, [&](double share) {
    progress.update(0, fmt::format("replaying {:.0f} %", 1e2 * share));
    return interrupts.count() == 0;
  });
  progress.close();
  const std::string difference = difference_of(replay, options.tolerance);
  if (options.json) {
    std::printf("%s\n", io::json_text(to_json(options, replay, difference), 2).c_str());
  } else {
    print(options, replay, difference);
  }
  return difference.empty() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_log_replay_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogReplayOptions>();
  const runtime::CommandLine app = log.add_subcommand(
      "replay", "Publish a recorded file with its timing, or fly its sensors into a controller again");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  add_network_options(app, options->network);
  app.remove_option("--vehicle-name");  // added below with another meaning
  app.add_option("--vehicle-name", options->vehicle_names,
                 "names under which the vehicles of the file are published, in the order of their own; "
                 "default: their own. With --into-control: which vehicle of the file")
      .check([](const std::string& names) { return messages::fault_of_vehicle_list(names); }, "NAMES");
  add_time_range_options(app, options->range);
  app.add_option("--topic", options->topics, "only this topic; may be repeated").repeated();
  app.add_option("--speed", options->speed, "times as fast as recorded").range(0.01, 1000.0).show_default();
  runtime::Option into =
      app.add_flag("--into-control", options->into_control,
                   "start swiftlet-control alone, send it the recorded sensors and requests in lockstep, and "
                   "compare its commands with the recorded ones; exit code 1 if they differ");
  app.add_option("--vehicle", options->vehicle,
                 "vehicle file of the controller, or the name of one; default: that of the recording, else "
                 "kaylion")
      .type_name(io::kinds::kVehicle.value)
      .needs(into);
  app.add_option("--control", options->control,
                 "control settings of the controller, or the name of one; default: those of the recording, "
                 "else motor_lag")
      .type_name(io::kinds::kControl.value)
      .needs(into);
  app.add_option("--tolerance", options->tolerance,
                 "largest difference of a command that counts as the same: of throttles, 1 is full")
      .range(0.0, 10.0)
      .show_default()
      .needs(into);
  app.add_flag("--json", options->json, "print the result as JSON");
  for (const char* of_publishing : {"--topic", "--speed", "--from", "--to"})
    into.excludes(app.option(of_publishing));
  app.footer(
      "Only topics of Swiftlet are published, and only under names that no vehicle of the domain has. The "
      "requests are among them:\na running controller of that name would obey them.\n\nexample: swiftlet log "
      "replay flight.mcap --speed 2 --vehicle-name old\nexample: swiftlet log replay flight.mcap "
      "--into-control --control mine.yaml\nExit codes: 0 all messages were published, or the controller does "
      "the same; 1 not "
      "so; 2 the file is invalid.");
  return {app, [options] {
            const mcap::Reader file(options->file);
            return options->into_control ? into_control(*options, file) : publish(*options, file);
          }};
}

}  // namespace swiftlet::ground
