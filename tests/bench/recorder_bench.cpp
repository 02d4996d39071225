// The load of the recorder: it records every topic of a fleet, whose messages another process publishes at the rates of a
// flight. With --hour: a flight of an hour in one process, recorded and read back.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/simulated_recorder.hpp"
#include "swiftlet/ground/replay/topic_publishers.hpp"
#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/io/temporary_folder.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/recorder/flight_recorder.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/bench/process_usage.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr double kMegabyte = 1e6;
constexpr double kFrom_s = 3.0;  // of the recorded flight, which is in the air then
constexpr double kTo_s = 33.0;

struct Options {
  int vehicles = 8;
  int imu_rate_hz = 1000;
  double seconds = 60.0;
  bool hour = false;
  bool json = false;
  std::string publish;  // the file whose messages this process is to publish; empty: it records
  int domain = 0;
};

dds::NodeSettings network(const char* name, int domain) {
  dds::NodeSettings settings;
  settings.name = name;
  settings.domain = domain;
  return settings;
}

std::vector<std::string> names(int vehicles) {
  std::vector<std::string> all;
  for (int i = 1; i <= vehicles; ++i) all.push_back("kl" + std::to_string(i));
  return all;
}

// Flies a mission in this process. Returns the file of its messages.
fs::path fly(const std::string& mission, int imu_rate_hz, const fs::path& folder) {
  ground::FlyOptions options;
  options.launch_mode = ground::LaunchMode::kInProcess;
  options.mission = mission;
  options.simulation = "ideal";  // an hour is longer than the battery lasts
  options.imu_rate_hz = imu_rate_hz;
  options.record = folder;
  const ground::LaunchConfiguration plan = ground::plan_flight(options);
  fs::create_directories(folder);
  simulation::ClosedLoop loop = ground::closed_loop(plan, {plan.vehicle, plan.simulation}, plan.seed);
  ground::SimulatedRecorder messages(loop, plan, "recorder_bench");
  record::Flight flight;
  const analysis::FlightReport report =
      ground::fly_in_process(loop, plan, plan.seed, flight, nullptr, {}, &messages);
  const std::string fault = messages.finish(flight.faults);
  if (!fault.empty()) throw std::runtime_error(fault);
  if (!report.completed) throw std::runtime_error("the flight failed: " + report.reason);
  return folder / record::kFlightFile;
}

struct Recorded {
  std::int64_t offset_ns = 0;
  std::string topic;
  mcap::Bytes payload;
};

std::vector<Recorded> messages_in(const std::string& path) {
  const mcap::Reader file(path);
  const std::string prefix = "/kl1/";
  mcap::Selection selection;
  selection.from_ns = static_cast<std::int64_t>(kFrom_s * 1e9);
  selection.to_ns = static_cast<std::int64_t>(kTo_s * 1e9);
  for (const auto& [id, channel] : file.channels()) {
    if (file.schema_of(channel)->name.rfind("swiftlet_msgs/", 0) == 0) selection.topics.insert(channel.topic);
  }
  std::vector<Recorded> all;
  mcap::Messages messages(file, selection);
  while (messages.next()) {
    const mcap::Message& message = messages.message();
    all.push_back({message.log_time_ns - selection.from_ns,
                   messages.channel().topic.substr(prefix.size()),
                   {message.payload.data, message.payload.data + message.payload.size}});
  }
  return all;
}

// Publishes the messages of the file as those of each vehicle, again and again.
void publish(const Options& options) {
  const std::vector<Recorded> messages = messages_in(options.publish);
  std::set<std::string> topics;
  for (const Recorded& message : messages) topics.insert(message.topic);
  const dds::Participant participant(network("plant", options.domain), names(options.vehicles));
  std::deque<dds::Node> nodes;
  std::deque<ground::TopicPublishers> vehicles;
  for (const std::string& name : names(options.vehicles))
    vehicles.emplace_back(nodes.emplace_back(participant, name), topics);
  const auto discovered = [&] {
    return std::all_of(vehicles.begin(), vehicles.end(),
                       [](const auto& vehicle) { return vehicle.matched(); });
  };
  if (!tests::eventually(discovered)) throw std::runtime_error("the recorder has not found the publisher");
  const auto begin = Steady::now();
  const auto end =
      begin + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(options.seconds));
  const auto lap = std::chrono::nanoseconds(static_cast<std::int64_t>((kTo_s - kFrom_s) * 1e9));
  double latest_s = 0.0;
  for (auto start = begin; start < end; start += lap) {
    for (const Recorded& message : messages) {
      const auto due = start + std::chrono::nanoseconds(message.offset_ns);
      if (due >= end) break;
      std::this_thread::sleep_until(due);
      latest_s = std::max(latest_s, std::chrono::duration<double>(Steady::now() - due).count());
      for (ground::TopicPublishers& vehicle : vehicles)
        vehicle.publish(message.topic, {message.payload.data(), message.payload.size()});
    }
  }
  for (ground::TopicPublishers& vehicle : vehicles) {
    for (const std::string& topic : topics) vehicle.wait_until_received(topic, 5s);
  }
  std::fprintf(stderr, "the publisher was at most %.1f ms late\n", latest_s * 1e3);
}

void record(const Options& options) {
  const auto folder = io::TemporaryFolder::of_the_system("swiftlet-recorder-bench");
  const fs::path log = fly("square", options.imu_rate_hz, folder.path() / "flight");
  const dds::DomainLock domain;
  const dds::Participant participant(network("ground", domain.domain()));
  record::FlightRecorder recorder(participant, folder.path() / "fleet.mcap", {});
  for (const std::string& name : names(options.vehicles)) recorder.add_vehicle(name);
  io::ChildProcess publisher(
      {"the publisher",
       fs::read_symlink("/proc/self/exe"),
       {"--publish", log, "--domain", std::to_string(domain.domain()), "--vehicles",
        std::to_string(options.vehicles), "--seconds", std::to_string(options.seconds)},
       folder.path() / "publisher.log"});
  tests::eventually([&] { return recorder.totals().received > 0 || publisher.poll(); });
  const Usage before = usage_of(::getpid());
  const auto begin = Steady::now();
  const std::optional<io::ProcessEnd> ended = publisher.wait(
      std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * (2.0 * options.seconds + 30.0))));
  const double time_s = std::chrono::duration<double>(Steady::now() - begin).count();
  const Usage after = usage_of(::getpid());
  recorder.stop();
  const record::RecorderTotals totals = recorder.totals();
  if (!ended || ended->code != 0 || ended->by_signal)
    throw std::runtime_error("the publisher " + (ended ? ended->to_string() : "does not end") + ": " +
                             publisher.last_log_line());
  const mcap::Reader file((folder.path() / "fleet.mcap").string(), mcap::Access::kScanned);
  std::uint64_t written = 0;
  for (const auto& [id, count] : file.statistics().messages_by_channel) {
    if (file.schema_of(file.channels().at(id))->name.rfind("swiftlet_msgs/", 0) == 0) written += count;
  }
  const double cpu = (after.cpu_s - before.cpu_s) / time_s;
  if (options.json) {
    std::printf("%s\n", nlohmann::ordered_json({{"vehicles", options.vehicles},
                                                {"imu_rate_hz", options.imu_rate_hz},
                                                {"time_s", time_s},
                                                {"received", totals.received},
                                                {"written", written},
                                                {"dropped", totals.dropped},
                                                {"lost", totals.lost},
                                                {"bytes", totals.file_bytes},
                                                {"cpu_cores", cpu},
                                                {"memory_mib", after.memory_mib}})
                            .dump()
                            .c_str());
  } else {
    std::printf(
        "%d vehicles at %d Hz for %.0f s: %llu messages received, %llu of them written, %llu dropped, %llu "
        "lost before they reached the recorder\n%.0f messages/s, %.1f MB, %.0f %% of a core, %.0f MiB; %s\n",
        options.vehicles, options.imu_rate_hz, time_s, static_cast<unsigned long long>(totals.received),
        static_cast<unsigned long long>(written), static_cast<unsigned long long>(totals.dropped),
        static_cast<unsigned long long>(totals.lost), static_cast<double>(totals.received) / time_s,
        static_cast<double>(totals.file_bytes) / kMegabyte, 1e2 * cpu, after.memory_mib,
        publisher.last_log_line().c_str());
  }
  if (totals.dropped > 0 || written != totals.received || !file.damages().empty())
    throw std::runtime_error("the recorder has lost messages that it received");
}

// Flies an hour, and checks that each IMU sample and its command are in the file.
void fly_an_hour(const Options& options) {
  const auto folder = io::TemporaryFolder::of_the_system("swiftlet-recorder-bench");
  const fs::path mission = folder.path() / "hour.yaml";
  {
    std::ofstream text(mission);
    text << "name: hour\nframe: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 1.0, speed_m_s: "
            "0.5}\n";
    for (int i = 0; i < 6; ++i)
      text << "  - {kind: waypoint, position_m: [" << i % 2 << ", 0, -1], speed_m_s: 0.5, hold_s: 590}\n";
    text << "  - {kind: land, speed_m_s: 0.5}\n";
  }
  const auto begin = Steady::now();
  const fs::path log = fly(mission, 500, folder.path() / "flight");
  const double wall_s = std::chrono::duration<double>(Steady::now() - begin).count();
  const mcap::Reader file(log.string(), mcap::Access::kScanned);
  mcap::Selection selection;
  selection.topics = {"/kl1/imu", "/kl1/actuator_command"};
  mcap::Messages messages(file, selection);
  std::map<std::string, std::uint32_t> counts;
  while (messages.next()) {
    std::uint32_t& count = counts[messages.channel().topic];
    if (messages.message().sequence != ++count)
      throw std::runtime_error(messages.channel().topic + ": a message is missing");
  }
  const double flown_s = static_cast<double>(file.statistics().end_ns) * 1e-9;
  const Usage usage = usage_of(::getpid());
  if (!file.finished() || !file.damages().empty() || flown_s < 3540.0 ||
      counts["/kl1/imu"] != counts["/kl1/actuator_command"] ||
      static_cast<double>(counts["/kl1/imu"]) < flown_s * 500.0)
    throw std::runtime_error("the file is not complete");
  if (options.json) {
    std::printf("%s\n", nlohmann::ordered_json({{"flown_s", flown_s},
                                                {"wall_s", wall_s},
                                                {"messages", file.statistics().message_count},
                                                {"imu_samples", counts["/kl1/imu"]},
                                                {"bytes", file.file_bytes()},
                                                {"memory_mib", usage.memory_mib}})
                            .dump()
                            .c_str());
    return;
  }
  std::printf(
      "%.0f s flown and recorded in %.0f s: %llu messages, %u IMU samples with their commands, %.0f MB\n",
      flown_s, wall_s, static_cast<unsigned long long>(file.statistics().message_count), counts["/kl1/imu"],
      static_cast<double>(file.file_bytes()) / kMegabyte);
}

void run(const Options& options) {
  if (!options.publish.empty()) return publish(options);
  return options.hour ? fly_an_hour(options) : record(options);
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  return runtime::run_process(
      {"recorder_bench", "Measures the recorder of messages.", "--vehicles 8 --seconds 60"}, argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--vehicles", options.vehicles, "number of vehicles").range(1, 40).show_default();
        app.add_option("--imu-rate", options.imu_rate_hz, "IMU rate, Hz").range(100, 2000).show_default();
        app.add_option("--seconds", options.seconds, "how long to record").range(1.0, 36000.0).show_default();
        app.add_flag("--hour", options.hour, "fly an hour in one process, and read its messages back");
        app.add_flag("--json", options.json, "print JSON");
        app.add_option("--publish", options.publish, "publish the messages of this file").hidden();
        app.add_option("--domain", options.domain, "DDS domain of --publish").hidden();
      },
      [&] { run(options); });
}
