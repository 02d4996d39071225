#include "tests/support/network/network_namespace.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sched.h>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <unistd.h>

#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNames = "swiftlet-net-";
constexpr const char* kFolder = "/run/netns";

std::string output_of(const std::string& command) {
  std::FILE* const pipe = popen(("{ " + command + "; } 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::system_error(errno, std::generic_category(), command);
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  if (pclose(pipe) != 0) throw std::runtime_error(command + ": " + output);
  return output;
}

void shell(const std::string& command) { output_of(command); }

void remove_namespace(const std::string& name) {
  try {
    shell("ip netns delete " + name);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
}

// Removes the namespaces of processes that have ended.
void remove_stale_namespaces() {
  std::error_code none;
  std::vector<std::string> stale;
  for (const auto& entry : fs::directory_iterator(kFolder, none)) {
    const std::string name = entry.path().filename();
    if (name.rfind(kNames, 0) != 0) continue;
    if (!is_running(std::atoi(name.c_str() + std::strlen(kNames)))) stale.push_back(name);
  }
  for (const std::string& name : stale) {
    std::error_code gone;
    if (fs::exists(fs::path(kFolder) / name, gone)) remove_namespace(name);
  }
}

int open_namespace(const std::string& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), file);
  return descriptor;
}

void enter(int descriptor) {
  if (setns(descriptor, CLONE_NEWNET) != 0) throw std::system_error(errno, std::generic_category(), "setns");
}

}  // namespace

std::string HostNetwork::why_unavailable() {
  int error = 0;
  // In a thread of its own, which ends in its namespace.
  std::thread([&error] { error = unshare(CLONE_NEWNET | CLONE_FS | CLONE_NEWNS) == 0 ? 0 : errno; }).join();
  if (error == 0) return {};
  return std::string("this machine may not make network namespaces: ") + std::strerror(error);
}

HostNetwork::HostNetwork(Layout layout, int hosts) {
  static std::atomic<int> count{0};
  remove_stale_namespaces();
  prefix_ = kNames + std::to_string(getpid()) + "-" + std::to_string(++count) + "-";
  centre_ = prefix_ + (layout == Layout::kSwitch ? "switch" : "router");
  for (int host = 0; host < hosts; ++host) {
    hosts_.push_back(prefix_ + "host" + std::to_string(host));
    addresses_.push_back(layout == Layout::kSwitch ? "10.77.0." + std::to_string(host + 1)
                                                   : "10.77." + std::to_string(host + 1) + ".1");
  }
  try {
    connect(layout);
  } catch (...) {
    for (const std::string& name : hosts_) remove_namespace(name);
    remove_namespace(centre_);
    throw;
  }
}

void HostNetwork::connect(Layout layout) {
  shell("ip netns add " + centre_);
  std::string of_centre = "link set lo up\n";
  if (layout == Layout::kSwitch) of_centre += "link add switch type bridge\nlink set switch up\n";
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    shell("ip netns add " + hosts_[host]);
    const std::string port = "port" + std::to_string(host);
    of_centre += "link add " + port + " type veth peer name eth0 netns " + hosts_[host] + "\n";
    if (layout == Layout::kSwitch) {
      of_centre += "link set " + port + " master switch\n";
    } else {
      of_centre += "address add 10.77." + std::to_string(host + 1) + ".254/24 dev " + port + "\n";
    }
    of_centre += "link set " + port + " up\n";
  }
  shell("printf '" + of_centre + "' | ip -n " + centre_ + " -batch -");
  if (layout == Layout::kRouter) shell("ip netns exec " + centre_ + " sysctl -q net.ipv4.ip_forward=1");

  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    std::string of_host =
        "link set lo up\naddress add " + addresses_[host] + "/24 dev eth0\nlink set eth0 up\n";
    of_host += layout == Layout::kSwitch
                   ? "route add 224.0.0.0/4 dev eth0\n"
                   : "route add default via 10.77." + std::to_string(host + 1) + ".254\n";
    shell("printf '" + of_host + "' | ip -n " + hosts_[host] + " -batch -");
  }
  // Until the kernel reports the link, within a second, programs take it for unplugged.
  for (const std::string& host : hosts_) {
    if (!eventually([&] {
          return output_of("ip -n " + host + " link show eth0").find("state UP") != std::string::npos;
        }))
      throw std::runtime_error(host + ": eth0 does not come up");
  }
}

HostNetwork::~HostNetwork() {
  for (const std::string& name : hosts_) remove_namespace(name);
  remove_namespace(centre_);
}

std::string HostNetwork::address(int host) const { return addresses_.at(static_cast<std::size_t>(host)); }

std::string HostNetwork::namespace_name(int host) const {
  return host == kCentre ? centre_ : hosts_.at(static_cast<std::size_t>(host));
}

void HostNetwork::run(int host, const std::string& command) const {
  const Inside inside(*this, host);
  shell(command);
}

HostNetwork::Inside::Inside(const HostNetwork& network, int host)
    : outside_(open_namespace("/proc/thread-self/ns/net")) {
  const int descriptor = open_namespace(std::string(kFolder) + "/" + network.namespace_name(host));
  enter(descriptor);
  close(descriptor);
}

HostNetwork::Inside::~Inside() {
  if (setns(outside_, CLONE_NEWNET) != 0) std::abort();  // what follows would be on the wrong host
  close(outside_);
}

}  // namespace swiftlet::tests
