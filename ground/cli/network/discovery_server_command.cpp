#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/discovery/discovery_server.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // at the server, whether it has ended

// "10.0.0.1:11811", as other hosts name the server; from its number on with ';' before it.
std::string option_value(const dds::DiscoveryServerSettings& settings) {
  std::string address = "127.0.0.1";
  for (const io::Interface& it : io::interfaces_up()) {
    if (!settings.on_loopback() && !it.is_loopback) address = it.address;
  }
  if (!settings.interfaces.empty()) address = io::addresses_of_interfaces(settings.interfaces).front();
  const std::string list = std::string(static_cast<std::size_t>(settings.number), ';') + address + ":" +
                           std::to_string(settings.port);
  return settings.number == 0 ? list : "'" + list + "'";
}

// Counts the processes and prints a line for each event. Thread-safe: the events come from another thread.
class Register {
 public:
  void on(const dds::DiscoveryServerEvent& event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    present_ += event.alive ? 1 : -1;
    joined_ += event.alive ? 1 : 0;
    const char* const what = event.alive ? "joined" : event.said_goodbye ? "left" : "died or was cut off";
    print(event.process + " " + what + "; " + std::to_string(present_) + " in the domain\n");
  }
  // Prints this line first, also before events that came already.
  void begin(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    began_ = true;
    print(line + "\n" + std::exchange(waiting_, {}));
  }
  std::string summary() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return "ended: " + std::to_string(joined_) + " processes joined, " + std::to_string(present_) +
           " remain and keep what they know of each other";
  }

 private:
  void print(const std::string& text) {
    if (!began_) {
      waiting_ += text;
      return;
    }
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

  mutable std::mutex mutex_;
  bool began_ = false;
  std::string waiting_;
  int joined_ = 0;
  int present_ = 0;
};

int serve(const dds::DiscoveryServerSettings& settings) {
  runtime::StopSignal stop;
  Register processes;
  dds::DiscoveryServer server(settings, [&](const dds::DiscoveryServerEvent& event) { processes.on(event); });
  if (stop.wait_for(dds::DiscoveryServer::kStartTime)) return io::kDone;
  server.serve();
  processes.begin(fmt::format(
      "discovery server {} of domain {} listens on UDP port {}{}; start the others with --domain {} "
      "--discovery-server {}",
      settings.number, settings.domain, settings.port, settings.on_loopback() ? " of this host only" : "",
      settings.domain, option_value(settings)));
  stop.wait();
  std::printf("%s\n", processes.summary().c_str());
  return io::kDone;
}

// Runs the server in a child process, and another one when an assertion of Fast DDS has ended it (participant_session.hpp). Called
// before this process has another thread.
int keep_serving(const dds::DiscoveryServerSettings& settings) {
  runtime::StopSignal stop;
  const pid_t own = ::getpid();
  while (true) {
    const pid_t child = ::fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
    if (child == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      return ::getppid() == own ? serve(settings) : io::kFailed;
    }
    int status = 0;
    while (::waitpid(child, &status, WNOHANG) == 0) {
      if (!stop.wait_for(kLook)) continue;
      ::kill(child, SIGTERM);
      ::waitpid(child, &status, 0);
      break;
    }
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    if (stop.requested()) return io::kFailed;
    std::fprintf(stderr,
                 "swiftlet: discovery-server: the server was ended by signal %d (%s) and is started again; "
                 "flights go on, "
                 "but nobody joins for some seconds\n",
                 WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  }
}

}  // namespace

io::Command add_discovery_server_command(runtime::CommandLine root) {
  const auto settings = std::make_shared<dds::DiscoveryServerSettings>();
  settings->port = io::kDiscoveryServerPort;
  const runtime::CommandLine app =
      root.add_subcommand("discovery-server", io::purpose_of("discovery-server"));
  app.add_option("--domain", settings->domain, "DDS domain")
      .environment("ROS_DOMAIN_ID")
      .range(0, 232)
      .show_default();
  app.add_option("--port", settings->port, "UDP port").range(1, 65535).show_default();
  app.add_option("--number", settings->number,
                 "place of this server in the list of --discovery-server, from 0, if there are several")
      .range(0, io::kMaxDiscoveryServers - 1)
      .show_default();
  app.add_option("--interface", settings->interfaces,
                 "listen on this network interface only; may be repeated")
      .repeated()
      .check(io::fault_of_interface, "NAME|ADDRESS");
  dds::add_network_key_option(app, settings->network_key_file);
  app.add_flag("--open-network", settings->open_network,
               "serve other hosts without --network-key too; default: this host only");
  app.footer(
      "It prints a line for each process that joins or leaves, until Ctrl-C. It carries no samples: a flight "
      "goes "
      "on without it, but nobody joins.\nA server serves one domain: two domains need two, on two ports. "
      "Servers "
      "of ROS 2 (`fastdds discovery`) serve as well.\nexample: swiftlet discovery-server --port 11811");
  return {app, [settings] { return keep_serving(*settings); }};
}

}  // namespace swiftlet::ground
