// Sense to actuate over DDS: one process publishes IMU samples as the plant does, another answers each with
// an actuator command as the control service does, without computing anything. Prints the round trip for each
// transport and rate.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "services/comms/domain_claim.hpp"
#include "services/comms/node.hpp"
#include "services/runtime/latency_histogram.hpp"
#include "services/runtime/periodic_timer.hpp"
#include "services/runtime/process.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
using comms::msg::ActuatorCommand;
using comms::msg::Imu;

struct Options {
  double seconds = 5.0;
  bool json = false;
  bool no_deadline = false;
  runtime::ProcessOptions process;
  int echo_domain = -1;  // of the process that answers
  int echo_transport = 0;
};

constexpr std::pair<const char*, comms::Transport> kTransports[] = {
    {"udp", comms::Transport::kUdp},
    {"shm", comms::Transport::kSharedMemory},
    {"data-sharing", comms::Transport::kDataSharing}};

comms::NodeSettings node_settings(const char* name, int domain, comms::Transport transport) {
  comms::NodeSettings settings;
  settings.name = name;
  settings.domain = domain;
  settings.transport = transport;
  settings.localhost_only = true;
  return settings;
}

template <class T>
comms::Topic<T> topic_for(comms::Topic<T> topic, const Options& options) {
  if (options.no_deadline) topic.deadline_ms = 0;
  return topic;
}

// Makes the thread that first comes here real-time, once.
class ThreadSetUp {
 public:
  explicit ThreadSetUp(const runtime::RealtimeSettings& settings) : settings_(settings) {}
  void operator()() {
    if (done_) return;
    done_ = true;
    if (settings_.enabled) runtime::make_this_thread_realtime(settings_);
  }

 private:
  runtime::RealtimeSettings settings_;
  bool done_ = false;
};

// The control-like process: lives until its standard input is closed.
void echo(const Options& options) {
  comms::Node node(
      node_settings("control", options.echo_domain, static_cast<comms::Transport>(options.echo_transport)));
  auto commands = node.publish(topic_for(comms::topics::kActuatorCommand, options));
  ThreadSetUp set_up(options.process.realtime);
  const auto subscription = node.subscribe<Imu>(
      topic_for(comms::topics::kImu, options),
      [&](const Imu& imu) {
        set_up();
        ActuatorCommand command;
        command.imu_sequence_number(imu.sequence_number());
        commands.publish(command);
      },
      {}, comms::Delivery::kOwnThread);
  char byte = 0;
  while (::read(STDIN_FILENO, &byte, 1) > 0) {
  }
}

// The other process, for as long as this lives.
class EchoProcess {
 public:
  EchoProcess(const Options& options, int domain, comms::Transport transport) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    std::vector<std::string> words{"dds_latency_bench",
                                   "--echo-domain",
                                   std::to_string(domain),
                                   "--echo-transport",
                                   std::to_string(static_cast<int>(transport)),
                                   "--priority",
                                   std::to_string(options.process.realtime.priority)};
    if (!options.process.realtime.enabled) words.emplace_back("--no-realtime");
    if (options.no_deadline) words.emplace_back("--no-deadline");
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(ends[0], STDIN_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      ::execv("/proc/self/exe", arguments.data());
      ::_exit(127);
    }
    ::close(ends[0]);
    input_ = ends[1];
  }
  ~EchoProcess() {
    ::close(input_);
    ::waitpid(child_, nullptr, 0);
  }
  EchoProcess(const EchoProcess&) = delete;
  EchoProcess& operator=(const EchoProcess&) = delete;

 private:
  pid_t child_ = -1;
  int input_ = -1;
};

struct Result {
  std::string transport;
  int rate_hz = 0;
  std::uint64_t sent = 0;
  std::uint64_t lost = 0;
  double p50_us = 0.0;
  double p99_us = 0.0;
  double max_us = 0.0;
};

Result measure(const Options& options, int domain, const char* name, comms::Transport transport,
               int rate_hz) {
  comms::Node node(node_settings("plant", domain, transport));
  auto samples = node.publish(topic_for(comms::topics::kImu, options));
  const auto count = static_cast<std::uint64_t>(options.seconds * rate_hz);
  std::vector<std::atomic<std::int64_t>> written(count + 1);
  std::atomic<bool> counting{false};
  runtime::LatencyHistogram round_trip;  // of the receiving thread until the subscription ends
  {
    ThreadSetUp set_up(options.process.realtime);
    const auto subscription = node.subscribe<ActuatorCommand>(
        topic_for(comms::topics::kActuatorCommand, options),
        [&](const ActuatorCommand& command) {
          set_up();
          const std::int64_t now_ns = runtime::monotonic_ns();
          if (counting && command.imu_sequence_number() <= count) {
            round_trip.record(now_ns - written[command.imu_sequence_number()].load());
          }
        },
        {}, comms::Delivery::kOwnThread);
    const EchoProcess process(options, domain, transport);
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (samples.matched() == 0 || subscription.matched() == 0) {
      if (std::chrono::steady_clock::now() > give_up)
        throw std::runtime_error("the other process was not found");
      std::this_thread::sleep_for(10ms);
    }

    std::thread([&] {
      if (options.process.realtime.enabled) runtime::make_this_thread_realtime(options.process.realtime);
      runtime::PeriodicTimer timer(1'000'000'000 / rate_hz, 1'000'000);
      Imu imu;
      for (int warm_up = 0; warm_up < rate_hz / 2; ++warm_up) {
        timer.wait();
        imu.sequence_number(count + 1);
        samples.publish(imu);
      }
      timer.wait();
      counting = true;
      for (std::uint64_t sequence = 1; sequence <= count; ++sequence) {
        timer.wait();
        imu.sequence_number(sequence);
        written[sequence] = runtime::monotonic_ns();
        samples.publish(imu);
      }
    }).join();
    std::this_thread::sleep_for(20ms);  // the last answers
  }
  return {name,
          rate_hz,
          count,
          count - round_trip.count(),
          static_cast<double>(round_trip.quantile_ns(0.5)) * 1e-3,
          static_cast<double>(round_trip.quantile_ns(0.99)) * 1e-3,
          static_cast<double>(round_trip.max_ns()) * 1e-3};
}

void run(const Options& options) {
  if (options.echo_domain >= 0) return echo(options);
  const comms::DomainClaim claim;
  nlohmann::json rows = nlohmann::json::array();
  if (!options.json) {
    std::printf("IMU out to command back, us\n%-14s %6s %8s %8s %8s %6s\n", "transport", "Hz", "p50", "p99",
                "max", "lost");
  }
  for (const auto& [name, transport] : kTransports) {
    for (const int rate_hz : {500, 1000}) {
      const Result result = measure(options, claim.domain(), name, transport, rate_hz);
      rows.push_back({{"transport", result.transport},
                      {"rate_hz", result.rate_hz},
                      {"sent", result.sent},
                      {"lost", result.lost},
                      {"p50_us", result.p50_us},
                      {"p99_us", result.p99_us},
                      {"max_us", result.max_us}});
      if (options.json) continue;
      std::printf("%-14s %6d %8.1f %8.1f %8.1f %6llu\n", name, rate_hz, result.p50_us, result.p99_us,
                  result.max_us, static_cast<unsigned long long>(result.lost));
      std::fflush(stdout);
    }
  }
  if (options.json) std::printf("%s\n", nlohmann::json{{"round_trip", rows}}.dump(2).c_str());
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--seconds", options.seconds, "Of each measurement")->check(CLI::Range(0.1, 3600.0));
  app.add_flag("--json", options.json, "Print JSON");
  app.add_flag("--no-deadline", options.no_deadline, "Leave out the streams' deadline QoS");
  app.add_option("--echo-domain", options.echo_domain)->group("");
  app.add_option("--echo-transport", options.echo_transport)->group("");
  runtime::add_process_options(app, options.process);
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"dds_latency_bench",
       "Round trip of an IMU sample and its actuator command between two processes, for each transport.",
       "--seconds 10 --json"},
      argc, argv, [&](CLI::App& app) { add_options(app, options); }, [&] { run(options); });
}
