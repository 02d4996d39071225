#include "tests/soak/address_change.hpp"

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <utility>

#include "tests/support/eventually.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"
#include "tests/support/refusals.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 60s;
constexpr int kCentre = tests::HostNetwork::kCentre;
constexpr const char* kMulticast = "ip route add 224.0.0.0/4 dev eth0";
constexpr const char* kSecondCable =
    "ip link add cable type veth peer name wlan0 netns $vehicle && ip link set cable master switch && ip "
    "link set cable up";
constexpr const char* kAlone = "this host has no IPv4 address but that of the loopback interface now";

class Hosts {
 public:
  Hosts(const AddressChange& change, std::filesystem::path folder)
      : change_(change), folder_(std::move(folder)), network_(tests::HostNetwork::Layout::kSwitch, 2) {
    ::setenv("SWIFTLET_OPEN_NETWORK", "1", 1);  // of the programs that it starts
    make(change.before);
  }

  ChangeResult run() {
    ChangeResult result;
    try {
      start();
      heal(result);
      land_and_stop();
    } catch (const std::runtime_error& error) {
      result.fault = error.what();
    }
    const bool said = tests::eventually([&] { return tests::contains(log(), change_.says); });
    result.log = log();
    if (result.fault.empty() && !said) result.fault = std::string("nobody says '") + change_.says + "'";
    if (result.fault.empty() && tests::refused_datagrams(result.log) > 0)
      result.fault = "datagrams were refused";
    if (result.fault.empty() && tests::contains(result.log, "no actuator command"))
      result.fault = "the vehicle had no commands for 0.5 s";
    return result;
  }

 private:
  void start() {
    plant_ = program(0, "swiftlet-plant");
    mocap_ = program(0, "swiftlet-mocap");
    control_ = program(change_.control, "swiftlet-control");
    for (const tests::Program* const process : {plant_.get(), mocap_.get(), control_.get()}) {
      if (!tests::eventually([&] { return tests::contains(process->errors(), "ready: "); }))
        throw std::runtime_error("a process does not get ready");
    }
    if (!change_.flies) return;
    require(0, {"arm", "--wait", "60"});
    require(0, {"takeoff", "--wait", "60"});
  }

  void heal(ChangeResult& result) {
    const auto begin = Clock::now();
    make(change_.change);
    const int ground = change_.flies ? 0 : change_.control;
    change_.flies ? require(ground, {"status"}) : arm(ground);
    if (!tests::eventually([&] { return tests::contains(plant_->errors(), "rotors started"); }, kPatience,
                           10ms))
      throw std::runtime_error("the vehicle does not hear control");
    result.healed_s = std::chrono::duration<double>(Clock::now() - begin).count();
  }

  void land_and_stop() {
    if (change_.flies) {
      require(0, {"land", "--wait", "60"});
      arm(0);
    }
    require(0, {"stop", "--yes", "--wait", "60"});
  }

  std::string log() const {
    std::string all;
    for (const auto& program : {plant_.get(), mocap_.get(), control_.get()}) {
      if (program != nullptr) all += program->errors();
    }
    return all;
  }

  using Words = std::vector<std::string>;

  std::unique_ptr<tests::Program> program(int host, const char* name, const Words& words = {}) const {
    const tests::HostNetwork::Inside inside(network_, host);
    return std::make_unique<tests::Program>(name, words, folder_);
  }
  bool succeeds(int host, const Words& words, std::string& why) const {
    const std::unique_ptr<tests::Program> tool = program(host, "swiftlet", words);
    const bool good = tool->wait(kPatience) == 0;
    if (!good) why = words.front() + ": " + tool->errors();
    return good;
  }
  void require(int host, const Words& words) const {
    std::string why;
    if (!succeeds(host, words, why)) throw std::runtime_error(why);
  }
  // Tries until arming succeeds: it is refused until motion capture is heard, and while the rotors run down.
  void arm(int host) const {
    std::string why;
    if (!tests::eventually([&] { return succeeds(host, {"arm"}, why); })) throw std::runtime_error(why);
  }
  void make(const std::vector<AddressChange::Command>& commands) const {
    for (const auto& [host, text] : commands)
      network_.run(host, "vehicle=" + network_.namespace_name(0) + "; " + text);
  }

  const AddressChange& change_;
  const std::filesystem::path folder_;
  const tests::HostNetwork network_;
  std::unique_ptr<tests::Program> plant_, mocap_, control_;
};

}  // namespace

const std::vector<AddressChange>& address_changes() {
  static const std::vector<AddressChange> all{
      {"started before the network is up",
       1,
       {{0, "ip address flush dev eth0"}, {0, "ip link set eth0 down"}},
       {{0, "ip address add 10.77.0.1/24 dev eth0"}, {0, "ip link set eth0 up"}, {0, kMulticast}},
       "the addresses of this host are 10.77.0.1 of eth0 now, and announced"},
      {"another address of the vehicle's host",
       1,
       {},
       {{0, "ip address flush dev eth0"}, {0, "ip address add 10.77.0.99/24 dev eth0"}, {0, kMulticast}},
       "what is for 10.77.0.1 is sent to 10.77.0.99 now"},
      {"another address of control's host",
       1,
       {},
       {{1, "ip address flush dev eth0"}, {1, "ip address add 10.77.0.99/24 dev eth0"}, {1, kMulticast}},
       "what is for 10.77.0.2 is sent to 10.77.0.99 now"},
      {"address removed in flight", 0, {}, {{0, "ip address flush dev eth0"}}, kAlone, true},
      {"cable pulled in flight",
       0,
       {},
       {{0, "ip address flush dev eth0"}, {0, "ip link set eth0 down"}},
       kAlone,
       true},
      {"interface added in flight",
       0,
       {},
       {{kCentre, kSecondCable}, {0, "ip address add 10.88.0.1/24 dev wlan0"}, {0, "ip link set wlan0 up"}},
       "10.77.0.1 of eth0, 10.88.0.1 of wlan0 now, and announced",
       true},
      {"another interface in place of the first",
       1,
       {{kCentre, kSecondCable}},
       {{0, "ip address flush dev eth0"},
        {0, "ip address add 10.77.0.98/24 dev wlan0"},
        {0, "ip link set wlan0 up"},
        {0, "ip route add 224.0.0.0/4 dev wlan0"}},
       "what is for 10.77.0.1 is sent to 10.77.0.98 now"},
      {"a VPN that leads nowhere comes first",
       1,
       {{kCentre, kSecondCable},
        {kCentre, "ip link set port0 nomaster"},
        {0, "ip address flush dev eth0"},
        {0, "ip address add 10.99.0.1/24 dev eth0"},
        {0, "ip address add 10.77.0.98/24 dev wlan0"},
        {0, "ip link set wlan0 up"}},
       {},
       "ready: "},
      {"IPv6 only at the start",
       1,
       {{0, "ip address flush dev eth0"}, {0, "ip -6 address add fd00::1/64 dev eth0"}},
       {{0, "ip address add 10.77.0.1/24 dev eth0"}, {0, kMulticast}},
       "IPv6 is not used"},
  };
  return all;
}

ChangeResult change_addresses(const AddressChange& change, const std::filesystem::path& folder) {
  return Hosts(change, folder).run();
}

}  // namespace swiftlet::soak
