#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/compression_option.hpp"
#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/record/recorder/flight_recorder.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

constexpr auto kShownStep = 50ms;
constexpr auto kLookPeriod = 250ms;

struct RecordOptions {
  dds::NodeSettings network;
  bool all = false;
  std::string output;
  bool replace = false;
  std::optional<double> duration_s;
  record::RecorderSettings recorder;
  int queue_mb = 64;
  bool json = false;
};

void require_free(const RecordOptions& options) {
  const std::filesystem::path file = options.output;
  if (!std::filesystem::exists(file)) return;
  if (!std::filesystem::is_regular_file(file))
    throw io::InputError("--output " + options.output + ": is not a file");
  if (!options.replace)
    throw io::InputError("--output " + options.output +
                         ": exists; choose another name, or add --replace to overwrite it");
}

// The vehicles that are recorded: those named, or all that appear.
class RecordedVehicles {
 public:
  RecordedVehicles(const RecordOptions& options, const Context& context, record::FlightRecorder& recorder)
      : context_(context), recorder_(recorder), all_(options.all) {
    if (all_) return;
    for (const std::string& name : messages::vehicles_of_list(options.network.vehicle)) add(name);
  }

  void look() {
    if (!all_ || Steady::now() < next_look_) return;
    next_look_ = Steady::now() + kLookPeriod;
    for (const std::string& name : context_.discovered_vehicles()) add(name);
  }

 private:
  void add(const std::string& name) {
    if (names_.insert(name).second) recorder_.add_vehicle(name);
  }

  const Context& context_;
  record::FlightRecorder& recorder_;
  const bool all_;
  std::set<std::string> names_;
  Steady::time_point next_look_{};
};

std::string losses(const record::RecorderTotals& totals) {
  return fmt::format("{} dropped, {} lost", totals.dropped, totals.lost);
}

void print(const RecordOptions& options, const record::RecorderTotals& totals, double time_s,
           const std::optional<std::string>& fault) {
  if (options.json) {
    nlohmann::ordered_json json = {
        {"file", options.output},     {"messages", totals.received - totals.dropped},
        {"topics", totals.topics},    {"duration_s", time_s},
        {"bytes", totals.file_bytes}, {"dropped", totals.dropped},
        {"lost", totals.lost}};
    if (fault) json["reason"] = *fault;
    std::printf("%s\n", io::json_text(json).c_str());
    return;
  }
  std::printf("record: %s\n",
              fmt::format("{}: {} messages of {} topics in {:.1f} s, {:.1f} MB; {}", options.output,
                          totals.received - totals.dropped, totals.topics, time_s,
                          static_cast<double>(totals.file_bytes) / 1e6, losses(totals))
                  .c_str());
}

int record(const RecordOptions& options) {
  require_free(options);
  const Interrupts interrupts;
  const Context context(options.network);
  record::RecorderSettings settings = options.recorder;
  settings.queue_bytes = static_cast<std::size_t>(options.queue_mb) << 20U;
  record::FlightRecorder recorder(context.participant(), options.output, settings);
  RecordedVehicles vehicles(options, context, recorder);
  io::ProgressLine progress;
  progress.say("recording to " + options.output + "; end with Ctrl-C");
  const auto start = Steady::now();
  const auto time_s = [&] { return std::chrono::duration<double>(Steady::now() - start).count(); };
  std::optional<std::string> fault;
  while (interrupts.count() == 0 && !fault && !(options.duration_s && time_s() >= *options.duration_s)) {
    vehicles.look();
    std::this_thread::sleep_for(kShownStep);
    const record::RecorderTotals totals = recorder.totals();
    progress.update(
        0, fmt::format("{:.0f} s  {} messages of {} topics, {:.1f} MB, {}", time_s(), totals.received,
                       totals.topics, static_cast<double>(totals.file_bytes) / 1e6, losses(totals)));
    fault = recorder.fault();
  }
  const double recorded_s = time_s();
  recorder.stop();
  progress.close();
  const record::RecorderTotals totals = recorder.totals();
  fault = recorder.fault();
  if (!fault && totals.received == 0)
    fault = "no message was received in domain " + std::to_string(options.network.domain) +
            dds::search_text(options.network) + "; " +
            dds::search_advice(options.network, context.participant().refused_keys());
  print(options, totals, recorded_s, fault);
  if (fault) std::fprintf(stderr, "swiftlet: record: %s\n", fault->c_str());
  return fault ? io::kFailed : io::kDone;
}

}  // namespace

io::Command add_record_command(runtime::CommandLine root, const std::string& version) {
  const auto options = std::make_shared<RecordOptions>();
  options->recorder.file.library = version;
  const runtime::CommandLine app = root.add_subcommand(
      "record", "Record every message of one or more vehicles as an MCAP file, until Ctrl-C");
  add_network_options(app, options->network, Vehicles::kSeveral);
  app.add_flag("--all", options->all, "record all vehicles of the domain, also those that appear later")
      .excludes(app.option("--vehicle-name"));
  app.add_option("-o,--output", options->output, "the file to write").type_name("FILE").required();
  app.add_flag("--replace", options->replace, "overwrite the file");
  app.add_option("--duration", options->duration_s, "end after this time, s").range(0.1, 1e6);
  add_compression_option(app, options->recorder.file.compression);
  app.add_choice(
         "--time", options->recorder.clock,
         {{"wall", record::RecordClock::kWall}, {"vehicle", record::RecordClock::kVehicle}},
         "times in the file: wall, when a message arrived; vehicle, the stamps of the vehicle's clock, "
         "for simulated time")
      .show_default("wall");
  app.add_flag(
      "--no-standard-messages", [options] { options->recorder.standard_messages = false; },
      "write only what was received, and no poses, transforms, IMU and battery as standard types of ROS 2");
  app.add_option("--queue", options->queue_mb,
                 "memory for messages that wait for the disk, MB; what does not fit is dropped and counted")
      .range(1, 4096)
      .show_default();
  app.add_flag("--json", options->json, "print the result as JSON");
  app.footer(
      "The file holds the payloads as they came, with ROS 2 message definitions. If the disk is full, "
      "recording "
      "ends with an error and what was written is readable; so it is if the process is killed, up to its "
      "last "
      "second.\n\nexample: swiftlet record --vehicle-name kl1,kl2 -o flight.mcap\nexample: swiftlet record "
      "--all "
      "-o all.mcap --duration 60");
  return {app, [options] { return record(*options); }};
}

}  // namespace swiftlet::ground
