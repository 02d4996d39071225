// Time and traffic until the processes of a fleet have discovered each other, on one host with --localhost-only, on several
// by multicast, or through a discovery server, and the CPU load and traffic afterwards. Two of every four processes
// announce themselves as plant and motion capture do. As root, in network namespaces of its own, so that no other traffic
// is counted.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/select.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/services/dds/discovery/discovery_server.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/bench/discovery_hosts.hpp"
#include "tests/bench/process_usage.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet {
namespace {

using bench::Hosts;
using bench::Traffic;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kJoins = 9;
constexpr int kProcessesOfVehicle = 4;
constexpr int kLookPeriod_ms = 10;
constexpr std::chrono::seconds kFirstAnnouncements{2};  // duration of the faster initial announcements

struct Options {
  std::vector<int> processes{4, 40, 80};
  int hosts = 1;
  double seconds = 5.0;
  double patience_s = 120.0;
  bool server = false;
  bool json = false;
};

struct Network {
  Hosts& hosts;
  int domain = 0;
  bool server = false;  // or multicast
};

// A discovery server in a process of its own. Ends with its input.
class ServerProcess {
 public:
  explicit ServerProcess(const Network& network) {
    if (!network.server) return;
    std::array<int, 2> ready{};
    if (::pipe(input_.data()) != 0 || ::pipe(ready.data()) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::close(input_[1]);
      network.hosts.enter(0);
      dds::DiscoveryServerSettings settings;
      settings.domain = network.domain;
      settings.open_network = true;
      settings.port = io::kDiscoveryServerPort;
      dds::DiscoveryServer server(settings, [](const dds::DiscoveryServerEvent&) {});
      pollfd input{input_[0], POLLIN, 0};
      ::poll(&input, 1, std::chrono::milliseconds(dds::DiscoveryServer::kStartTime).count());
      server.serve();
      char byte = 'r';
      if (::write(ready[1], &byte, 1) != 1) std::_Exit(1);
      while (::read(input_[0], &byte, 1) > 0) {
      }
      std::_Exit(0);
    }
    ::close(input_[0]);
    ::close(ready[1]);
    char byte = 0;
    if (::read(ready[0], &byte, 1) != 1) throw std::runtime_error("the discovery server does not start");
    ::close(ready[0]);
  }
  ~ServerProcess() {
    if (pid_ == 0) return;
    ::close(input_[1]);
    ::waitpid(pid_, nullptr, 0);
  }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

 private:
  std::array<int, 2> input_{};
  pid_t pid_ = 0;
};

dds::NodeSettings settings_of(const std::string& name, const std::string& vehicle, const Network& network) {
  dds::NodeSettings settings;
  settings.name = name;
  settings.vehicle = vehicle;
  settings.domain = network.domain;
  settings.localhost_only = !network.server && network.hosts.count() == 1;
  settings.open_network = !settings.localhost_only;
  if (network.server) settings.network.discovery_servers = network.hosts.server_address();
  return settings;
}

void write_known(int output) {
  if (::write(output, "k", 1) != 1) std::_Exit(1);
}

// Ends the process without goodbye messages.
[[noreturn]] void exit_when_closed(int input) {
  char byte = 0;
  while (::read(input, &byte, 1) > 0) {
  }
  std::_Exit(0);
}

// Ends the process when the input is closed before the condition holds.
template <class Condition>
void wait_until(const Condition& holds, int input) {
  pollfd closed{input, POLLIN, 0};
  while (!holds()) {
    if (::poll(&closed, 1, kLookPeriod_ms) > 0) std::_Exit(0);
  }
}

// The four processes of a vehicle, with the topics over which they find each other.
void run_plant(const dds::NodeSettings& settings, int input, int output) {
  dds::Node node(settings);
  const auto imu = node.publish(messages::topics::kImu);
  const auto rotors = node.publish(messages::topics::kRotorSpeeds);
  const auto truth = node.publish(messages::topics::kGroundTruth);
  const auto info = node.publish(messages::topics::kVehicleInfo);
  const auto commands =
      node.subscribe<messages::msg::ActuatorCommand>(messages::topics::kActuatorCommand, [](const auto&) {});
  wait_until(
      [&] {
        return imu.matched() == 1 && rotors.matched() == 1 && truth.matched() == 1 && info.matched() == 2 &&
               commands.matched() == 1;
      },
      input);
  write_known(output);
  exit_when_closed(input);
}
void run_motion_capture(const dds::NodeSettings& settings, int input, int output) {
  dds::Node node(settings);
  const auto poses = node.publish(messages::topics::kMocapPose);
  const auto truth =
      node.subscribe<messages::msg::GroundTruth>(messages::topics::kGroundTruth, [](const auto&) {});
  wait_until([&] { return poses.matched() == 2 && truth.matched() == 1; }, input);
  write_known(output);
  exit_when_closed(input);
}
void run_control(const dds::NodeSettings& settings, int input, int output) {
  dds::Node node(settings);
  const auto actuators = node.publish(messages::topics::kActuatorCommand);
  const auto status = node.publish(messages::topics::kControlStatus);
  const auto state = node.publish(messages::topics::kControllerState);
  const auto imu = node.subscribe<messages::msg::Imu>(messages::topics::kImu, [](const auto&) {});
  const auto rotors =
      node.subscribe<messages::msg::RotorSpeeds>(messages::topics::kRotorSpeeds, [](const auto&) {});
  const auto poses =
      node.subscribe<messages::msg::MocapPose>(messages::topics::kMocapPose, [](const auto&) {});
  const auto info =
      node.subscribe<messages::msg::VehicleInfo>(messages::topics::kVehicleInfo, [](const auto&) {});
  const auto requests =
      node.subscribe<messages::msg::Command>(messages::topics::kCommand, [](const auto&) {});
  wait_until(
      [&] {
        return actuators.matched() == 1 && status.matched() == 1 && state.matched() == 1 &&
               imu.matched() == 1 && rotors.matched() == 1 && poses.matched() == 1 && info.matched() == 1 &&
               requests.matched() == 1;
      },
      input);
  write_known(output);
  exit_when_closed(input);
}
void run_ground(const dds::NodeSettings& settings, int input, int output) {
  dds::Node node(settings);
  const auto requests = node.publish(messages::topics::kCommand);
  const auto status =
      node.subscribe<messages::msg::ControlStatus>(messages::topics::kControlStatus, [](const auto&) {});
  const auto state =
      node.subscribe<messages::msg::ControllerState>(messages::topics::kControllerState, [](const auto&) {});
  const auto poses =
      node.subscribe<messages::msg::MocapPose>(messages::topics::kMocapPose, [](const auto&) {});
  const auto info =
      node.subscribe<messages::msg::VehicleInfo>(messages::topics::kVehicleInfo, [](const auto&) {});
  wait_until(
      [&] {
        return requests.matched() == 1 && status.matched() == 1 && state.matched() == 1 &&
               poses.matched() == 1 && info.matched() == 1;
      },
      input);
  write_known(output);
  exit_when_closed(input);
}

// Writes a byte once it exchanges all topics with the others of its vehicle.
void run_process_of_fleet(int number, const Network& network, int input, int output) {
  network.hosts.enter(number % network.hosts.count());
  constexpr std::array kNames = {"plant", "mocap", "control", "ground"};
  constexpr std::array<void (*)(const dds::NodeSettings&, int, int), kProcessesOfVehicle> kRoles = {
      run_plant, run_motion_capture, run_control, run_ground};
  const int role = number % kProcessesOfVehicle;
  dds::NodeSettings settings =
      settings_of(kNames[role], "kl" + std::to_string(number / kProcessesOfVehicle), network);
  settings.hears_of_all = false;
  if (role < 2) settings.announcement_period = messages::kFixturePeriod;
  kRoles[role](settings, input, output);
}

// A tool that looks at the domain, as `swiftlet list` does: writes a byte once it knows all processes.
void run_tool(int count, const Network& network, int input, int output) {
  network.hosts.enter(0);
  const dds::Participant participant(settings_of("tool", "", network));
  // Clients of a discovery server see it as one more.
  const std::size_t all = static_cast<std::size_t>(count) + (network.server ? 1 : 0);
  wait_until([&] { return participant.processes_seen().size() >= all; }, input);
  write_known(output);
  exit_when_closed(input);
}

// Returns false if the deadline passes or the other end is closed before a byte comes.
bool wait_for_byte(int input, std::chrono::time_point<Clock, std::chrono::duration<double>> deadline) {
  while (Clock::now() < deadline) {
    fd_set waiting;
    FD_ZERO(&waiting);
    FD_SET(input, &waiting);
    timeval second{1, 0};
    char byte = 0;
    if (::select(input + 1, &waiting, nullptr, nullptr, &second) > 0) return ::read(input, &byte, 1) == 1;
  }
  return false;
}

class Fleet {
 public:
  Fleet(int count, const Network& network) {
    if (::pipe(input_.data()) != 0 || ::pipe(output_.data()) != 0) throw std::runtime_error("no pipe");
    for (int i = 0; i < count; ++i) {
      const pid_t pid = ::fork();
      if (pid == 0) {
        ::close(input_[1]);
        run_process_of_fleet(i, network, input_[0], output_[1]);
      }
      processes_.push_back(pid);
    }
    ::close(input_[0]);
    ::close(output_[1]);
  }
  ~Fleet() {
    ::close(input_[1]);
    for (const pid_t pid : processes_) ::waitpid(pid, nullptr, 0);
    ::close(output_[0]);
  }
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  // Waits until all processes know all others or the time is over; returns how many do.
  int wait_until_known(std::chrono::duration<double> patience) const {
    const auto deadline = Clock::now() + patience;
    int known = 0;
    while (known < static_cast<int>(processes_.size()) && wait_for_byte(output_[0], deadline)) ++known;
    return known;
  }

  // Time that a tool needs to hear of all processes; infinity if it is over before.
  double join_s(const Network& network, std::chrono::duration<double> patience) const {
    std::array<int, 2> input{}, output{};
    if (::pipe(input.data()) != 0 || ::pipe(output.data()) != 0) throw std::runtime_error("no pipe");
    const auto start = Clock::now();
    const auto count = static_cast<int>(processes_.size());
    const pid_t pid = ::fork();
    if (pid == 0) {
      ::close(input[1]);
      run_tool(count, network, input[0], output[1]);
    }
    ::close(output[1]);
    const bool known = wait_for_byte(output[0], start + patience);
    const double time_s = std::chrono::duration<double>(Clock::now() - start).count();
    ::kill(pid, SIGKILL);
    for (const int end : {input[0], input[1], output[0]}) ::close(end);
    ::waitpid(pid, nullptr, 0);
    return known ? time_s : INFINITY;
  }

  // Lets the time pass. Throws if a process ends meanwhile.
  void wait_while_running(std::chrono::milliseconds duration) const {
    const auto one_has_ended = [this] {
      return std::any_of(processes_.begin(), processes_.end(), [](pid_t pid) {
        siginfo_t ended{};
        return ::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
               ended.si_pid == pid;
      });
    };
    if (tests::eventually(one_has_ended, duration, std::chrono::milliseconds(20)))
      throw std::runtime_error("a process ended while the fleet was measured");
  }

  // CPU time of all processes so far.
  double time_s() const {
    double all_s = 0.0;
    for (const pid_t pid : processes_) all_s += usage_of(pid).cpu_s;
    return all_s;
  }

 private:
  std::array<int, 2> input_{}, output_{};
  std::vector<pid_t> processes_;
};

nlohmann::ordered_json measure(int count, Hosts& hosts, const Options& options) {
  const std::chrono::duration<double> patience(options.patience_s);
  const dds::DomainLock lock;
  const Network network{hosts, lock.domain(), options.server};
  const ServerProcess server(network);
  const auto start = Clock::now();
  const Traffic at_start = hosts.traffic();
  const Fleet fleet(count, network);
  const int known = fleet.wait_until_known(patience);
  const double found_s = std::chrono::duration<double>(Clock::now() - start).count();
  const double finding_s = fleet.time_s();
  const Traffic when_found = hosts.traffic();
  fleet.wait_while_running(kFirstAnnouncements);
  const double before_s = fleet.time_s();
  const Traffic before = hosts.traffic();
  const auto rest = Clock::now();
  fleet.wait_while_running(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(options.seconds)));
  const double rest_s = std::chrono::duration<double>(Clock::now() - rest).count();
  const double cpu_s = fleet.time_s() - before_s;
  const Traffic after = hosts.traffic();
  std::vector<double> joins_s;
  // The first one that fails is the last.
  while (known == count && joins_s.size() < kJoins && (joins_s.empty() || std::isfinite(joins_s.back())))
    joins_s.push_back(fleet.join_s(network, patience));
  std::sort(joins_s.begin(), joins_s.end());
  return {{"processes", count},
          {"hosts", hosts.count()},
          {"know_all", known},
          {"until_s", found_s},
          {"cpu_until_s", finding_s},
          {"megabytes_until", 1e-6 * (when_found.bytes - at_start.bytes)},
          {"datagrams_until", when_found.packets - at_start.packets},
          {"kilobytes_per_s_at_rest", 1e-3 * (after.bytes - before.bytes) / rest_s},
          {"cpu_at_rest_percent", 100.0 * cpu_s / rest_s},
          {"join_median_s", joins_s.empty() ? NAN : joins_s[joins_s.size() / 2]},
          {"join_max_s", joins_s.empty() ? NAN : joins_s.back()}};
}

void run(const Options& options) {
  runtime::log_to_stderr("bench");
  Hosts hosts(options.hosts);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!options.json) {
    std::printf("%9s %9s %8s %14s %13s %22s %13s %20s\n", "processes", "know all", "after, s",
                "CPU by then, s", "MB by then", "CPU then, % of a core", "kB/s then", "one more, s (worst)");
  }
  for (const int count : options.processes) {
    const nlohmann::ordered_json row = measure(count, hosts, options);
    rows.push_back(row);
    if (options.json) continue;
    std::printf("%9d %9d %8.2f %14.2f %13.2f %22.1f %13.1f %12.3f (%.3f)\n", count,
                row["know_all"].get<int>(), row["until_s"].get<double>(), row["cpu_until_s"].get<double>(),
                row["megabytes_until"].get<double>(), row["cpu_at_rest_percent"].get<double>(),
                row["kilobytes_per_s_at_rest"].get<double>(), row["join_median_s"].get<double>(),
                row["join_max_s"].get<double>());
    std::fflush(stdout);
  }
  if (options.json) std::printf("%s\n", rows.dump().c_str());
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  return runtime::run_process(
      {"discovery_bench", "Measures the discovery time of the processes of a fleet, and its CPU load.",
       "--processes 4 --processes 40 --discovery-server"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--processes", options.processes,
                       "number of processes; may be repeated; a host has ports for 120 of a domain")
            .range(2, 200);
        app.add_option("--hosts", options.hosts, "hosts on a switch that share the processes; as root")
            .range(1, 8);
        app.add_flag("--discovery-server", options.server,
                     "through a discovery server, whose traffic counts too");
        app.add_option("--seconds", options.seconds, "duration of the CPU measurement, s").range(1.0, 60.0);
        app.add_option("--patience", options.patience_s, "timeout of discovery, s").range(1.0, 600.0);
        app.add_flag("--json", options.json, "print JSON");
      },
      [&] { run(options); });
}
