// Hosts on a switch, and behind routers that forward no multicast: who reaches whom.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <netinet/in.h>
#include <set>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"
#include "tests/support/rtps_message.hpp"
#include "tests/support/security_keys.hpp"
#include "tests/support/shifted_clock.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using nlohmann::json;
using Layout = HostNetwork::Layout;
using Words = std::vector<std::string>;

constexpr std::uint16_t kFirstDiscoveryPort = 7410;

// Plant and motion capture on host 0, control on host 1, and the ground tools on host 2. In lockstep, so that a busy
// machine slows the flight down instead of failing it.
class Networks : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  }

  void connect(Layout layout) { hosts_ = std::make_unique<HostNetwork>(layout, 3); }
  void start_all(const std::vector<Words>& options_of_hosts) {
    options_ = options_of_hosts;
    plant_ = start(0, "swiftlet-plant", {"--clock", "lockstep", "--speed", "16"});
    mocap_ = start(0, "swiftlet-mocap", {"--clock", "lockstep"});
    control_ = start(1, "swiftlet-control", {"--clock", "lockstep"});
  }
  // The other hosts, as peers.
  std::vector<Words> all_peers() const {
    const std::string a = hosts_->address(0);
    const std::string b = hosts_->address(1);
    const std::string c = hosts_->address(2);
    return {{"--peer", b, "--peer", c}, {"--peer", a, "--peer", c}, {"--peer", a, "--peer", b}};
  }

  std::unique_ptr<Program> start(int host, const std::string& program, Words words) const {
    const Words& options = options_.at(static_cast<std::size_t>(host));
    words.insert(words.end(), options.begin(), options.end());
    if (reach_ != nullptr) words.emplace_back(reach_);
    const HostNetwork::Inside inside(*hosts_, host);
    return std::make_unique<Program>(program, std::move(words), folder_.path());
  }
  ProgramResult swiftlet(int host, Words words) const {
    const std::unique_ptr<Program> program = start(host, "swiftlet", std::move(words));
    const int exit_code = program->wait(kStuck);
    return {exit_code, program->output(), program->errors()};
  }
  bool finds_the_vehicle(int host) const {
    return eventually([&] {
      const ProgramResult result = swiftlet(host, {"list", "--json"});
      if (result.exit_code != 0) return false;
      const json list = json::parse(result.output);
      return list.size() == 1 && list[0].at("mode") == "disarmed" && list[0].at("model") == "kaylion" &&
             list[0].at("controllers") == 1 && list[0].at("mocap_hz") > 20.0;
    });
  }
  // Whether the tools that show one vehicle do so.
  void expect_shows_the_vehicle(int host) const {
    const ProgramResult status = swiftlet(host, {"status", "--json", "--watch", "0.1"});
    EXPECT_EQ(status.exit_code, 0) << status.errors;
    Words words = options_.at(static_cast<std::size_t>(host));
    words.insert(words.begin(), "watch");
    words.emplace_back(reach_);
    const HostNetwork::Inside inside(*hosts_, host);
    Terminal watch("swiftlet", words, 100, 40);
    EXPECT_TRUE(eventually([&] { return watch.text().find("disarmed") != std::string::npos; }))
        << watch.text();
    watch.type("q");
    EXPECT_EQ(watch.wait(kStuck), 0);
  }
  void expect_flies(const Words& mission) const {
    Words words = {"fly"};
    words.insert(words.end(), mission.begin(), mission.end());
    words.insert(words.end(), {"--attach", "--json", "--record", (folder_.path() / "record").string()});
    const ProgramResult flight = swiftlet(2, words);
    ASSERT_EQ(flight.exit_code, 0) << flight.errors << logs();
    EXPECT_LT(json::parse(flight.output).at("rms_3d_m"), 0.05);
  }
  std::string logs() const { return plant_->errors() + mocap_->errors() + control_->errors(); }

  const char* reach_ = "--open-network";  // an option of all programs
  TemporaryFolder folder_;
  std::unique_ptr<HostNetwork> hosts_;
  std::vector<Words> options_;
  std::unique_ptr<Program> plant_, mocap_, control_;
};

// Control has its options from a file.
TEST_F(Networks, PeersFlyThroughRoutersWithoutMulticast) {
  connect(Layout::kRouter);
  std::vector<Words> options = all_peers();
  folder_.write(
      "profile.xml",
      "<dds><profiles><participant profile_name=\"lab\"><rtps>"
      "<listenSocketBufferSize>150000</listenSocketBufferSize></rtps></participant></profiles></dds>\n");
  options[1] = {"--network",
                folder_.write("network.yaml", "peers: [" + hosts_->address(0) + ", " + hosts_->address(2) +
                                                  "]\ninterfaces: [eth0]\ndds_profile: profile.xml\n")};
  start_all(options);
  ASSERT_TRUE(finds_the_vehicle(2)) << logs();
  expect_shows_the_vehicle(2);
  expect_flies({"square"});
  EXPECT_EQ(logs().find("rejoined"), std::string::npos) << logs();
}

TEST_F(Networks, FindNothingThroughRoutersWithoutPeers) {
  connect(Layout::kRouter);
  start_all({{}, {}, {}});
  ASSERT_TRUE(eventually([&] { return plant_->errors().find("mocap joined") != std::string::npos; }));
  const ProgramResult list = swiftlet(2, {"list", "--time", "1"});
  EXPECT_EQ(list.exit_code, 1) << list.output;
  options_[2] = {"--peer", hosts_->address(0), "--interface", "lo"};
  const ProgramResult elsewhere = swiftlet(2, {"list", "--time", "1"});
  EXPECT_EQ(elsewhere.exit_code, 1) << elsewhere.output;
  EXPECT_NE(elsewhere.errors.find(" at the peers " + hosts_->address(0) + " on lo; check"), std::string::npos)
      << elsewhere.errors;
  EXPECT_EQ(logs().find("control joined"), std::string::npos) << logs();
}

TEST_F(Networks, UseTheChosenInterfaceOnly) {
  connect(Layout::kSwitch);
  start_all({{"--interface", "eth0"}, {"--interface", hosts_->address(1)}, {"--interface", "eth0"}});
  EXPECT_TRUE(finds_the_vehicle(2)) << logs();
  options_[2] = {"--interface", "lo"};
  EXPECT_EQ(swiftlet(2, {"list", "--time", "1"}).exit_code, 1);
}

// GIVEN a discovery server on the host of control WHEN it ends in flight THEN the flight goes on. With --interface: Fast DDS
// fails an assertion where a client knows a server of its host by the address of the network.
TEST_F(Networks, ADiscoveryServerIntroducesTheHostsAndServesItsOwn) {
  connect(Layout::kRouter);
  const Words client = {"--discovery-server", hosts_->address(1)};
  options_ = {{}, {}, {}};
  const std::unique_ptr<Program> server = start(1, "swiftlet", {"discovery-server", "--interface", "eth0"});
  start_all({client, {"--discovery-server", hosts_->address(1), "--interface", "eth0"}, client});
  ASSERT_TRUE(finds_the_vehicle(2)) << logs() << server->output();
  const std::string begin =
      "discovery server 0 of domain 0 listens on UDP port 11811; start the others with --domain 0 "
      "--discovery-server " +
      hosts_->address(1) + ":11811\n";
  EXPECT_EQ(server->output().rfind(begin, 0), 0U) << server->output();
  EXPECT_NE(server->output().find("control (process " + std::to_string(control_->pid())), std::string::npos);

  options_[2] = {};
  setenv("ROS_DISCOVERY_SERVER", (hosts_->address(1) + ":11811").c_str(), 1);
  EXPECT_EQ(swiftlet(2, {"list", "--names"}).output, "kl1\n");
  unsetenv("ROS_DISCOVERY_SERVER");
  EXPECT_EQ(swiftlet(2, {"list", "--time", "1"}).exit_code, 1);

  options_[2] = client;
  expect_shows_the_vehicle(2);
  ASSERT_EQ(swiftlet(2, {"arm", "--wait", "60"}).exit_code, 0);
  const std::unique_ptr<Program> takeoff = start(2, "swiftlet", {"takeoff", "--wait", "60"});
  ASSERT_TRUE(eventually([&] { return control_->errors().find("taking off") != std::string::npos; }));
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(kStuck), 0) << server->errors();
  EXPECT_NE(server->output().find("remain and keep what they know of each other"), std::string::npos);
  EXPECT_EQ(takeoff->wait(kStuck), 0) << takeoff->errors();
  for (Program* const program : {plant_.get(), mocap_.get(), control_.get()}) {
    program->signal(SIGTERM);
    EXPECT_EQ(program->wait(kStuck), 0) << program->errors();
  }
}

// The server tells a plain client only of those with which it exchanges topics: a source is none.
TEST_F(Networks, ASecondPlantIsRefusedThroughADiscoveryServer) {
  connect(Layout::kRouter);
  options_ = {{}, {}, {}};
  const std::unique_ptr<Program> server = start(2, "swiftlet", {"discovery-server"});
  const Words client = {"--discovery-server", hosts_->address(2)};
  options_ = {client, client, client};
  const auto refused = [&](const Program& plant) {
    return plant.errors().find(" publishes its imu; choose another --vehicle-name or --domain") !=
           std::string::npos;
  };
  const std::unique_ptr<Program> first = start(0, "swiftlet-plant", {});
  const std::unique_ptr<Program> at_once = start(1, "swiftlet-plant", {});
  ASSERT_TRUE(eventually([&] { return refused(*first) || refused(*at_once); })) << first->errors();
  const bool first_remains = refused(*at_once);
  EXPECT_EQ((first_remains ? at_once : first)->wait(kStuck), 1);
  const std::unique_ptr<Program> third = start(2, "swiftlet-plant", {});
  EXPECT_EQ(third->wait(kStuck), 1) << third->errors();
  EXPECT_TRUE(refused(*third)) << third->errors();
  const std::unique_ptr<Program>& remaining = first_remains ? first : at_once;
  remaining->signal(SIGTERM);
  EXPECT_EQ(remaining->wait(kStuck), 0) << remaining->errors();
}

// Announces a participant of host `from` to the first process of a host, by the rules and without a key. Returns whether that
// process sends it anything within a second.
bool answers(const HostNetwork& network, int at, int from) {
  const HostNetwork::Inside inside(network, from);
  const int stranger = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own = io::socket_address(network.address(from), 0);
  socklen_t size = sizeof own;
  EXPECT_EQ(bind(stranger, reinterpret_cast<const sockaddr*>(&own), size), 0);
  getsockname(stranger, reinterpret_cast<sockaddr*>(&own), &size);
  const timeval patience{1, 0};
  setsockopt(stranger, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  Bytes address(4);
  std::memcpy(address.data(), &own.sin_addr, address.size());
  const ByteWriter locator = ByteWriter().u32(1).u32(ntohs(own.sin_port)).zeros(12).bytes(address);
  ByteWriter parameters = participant_parameters(kAlice);
  parameters.parameter(0x0032, locator)
      .parameter(0x0031, locator)
      .parameter(0x0058, ByteWriter().u32(0x0c3f));
  const Bytes datagram = announcement(kAlice, parameters).bytes();
  const sockaddr_in to = io::socket_address(network.address(at), kFirstDiscoveryPort);
  sendto(stranger, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  char byte = 0;
  const bool answered = recv(stranger, &byte, 1, MSG_TRUNC) > 0;
  close(stranger);
  return answered;
}

// The addresses, in hexadecimal digits, of the UDP sockets of a host.
std::set<std::string> listening_addresses(const HostNetwork& network, int host) {
  const HostNetwork::Inside inside(network, host);
  std::ifstream table("/proc/thread-self/net/udp");
  std::string line;
  std::getline(table, line);
  std::set<std::string> addresses;
  while (std::getline(table, line)) {
    const std::size_t colon = line.find(':');
    addresses.insert(line.substr(colon + 2, 8));
  }
  return addresses;
}

// WHEN neither a key, certificates nor --open-network is given THEN a process listens on the loopback interface only, and says
// so; tools of its host find it without options, those of others do not; a peer is refused.
TEST_F(Networks, AProcessWithoutOptionsStaysOnItsHost) {
  connect(Layout::kSwitch);
  options_ = {{}, {}, {}};
  reach_ = nullptr;
  const std::unique_ptr<Program> server = start(0, "swiftlet", {"discovery-server"});
  const std::unique_ptr<Program> plant = start(0, "swiftlet-plant", {});
  EXPECT_TRUE(eventually([&] {
    return server->output().find("listens on UDP port 11811 of this host only; ") != std::string::npos;
  })) << server->errors();
  EXPECT_TRUE(eventually([&] { return swiftlet(0, {"list", "--names", "--time", "1"}).output == "kl1\n"; }));
  EXPECT_NE(plant->errors().find("on this host only: --network-key FILE or --security DIR opens the network"),
            std::string::npos)
      << plant->errors();
  EXPECT_EQ(listening_addresses(*hosts_, 0), std::set<std::string>{"0100007F"});
  EXPECT_FALSE(answers(*hosts_, 0, 1));
  const ProgramResult peer = swiftlet(1, {"list", "--peer", hosts_->address(0)});
  EXPECT_EQ(peer.exit_code, 2) << peer.output;
  EXPECT_NE(peer.errors.find("a peer (--peer, ROS_STATIC_PEERS) is given, but the process stays on the "
                             "loopback interface without "
                             "--network-key FILE, --security DIR or --open-network"),
            std::string::npos)
      << peer.errors;
  const ProgramResult interface = swiftlet(1, {"discovery-server", "--interface", "eth0"});
  EXPECT_EQ(interface.exit_code, 2) << interface.output;
  EXPECT_NE(
      interface.errors.find("stays on the loopback interface without --network-key FILE or --open-network"),
      std::string::npos)
      << interface.errors;
  reach_ = "--open-network";
  EXPECT_EQ(swiftlet(1, {"list", "--time", "1"}).exit_code, 1);
  EXPECT_EQ(swiftlet(0, {"list", "--names", "--time", "2"}).output, "kl1\n") << "they share the host";
}

// A stranger that keeps to the rules of RTPS, but has no key.
TEST_F(Networks, WhoHasNoKeyIsNeitherParsedNorAnswered) {
  connect(Layout::kSwitch);
  options_ = {{}, {}, {}};
  reach_ = nullptr;
  const std::string key = (folder_.path() / "lab.key").string();
  ASSERT_EQ(swiftlet(0, {"keys", "network", key}).exit_code, 0);
  std::unique_ptr<Program> plant = start(0, "swiftlet-plant", {"--network-key", key});
  ASSERT_TRUE(eventually([&] {
    return swiftlet(1, {"list", "--names", "--time", "1", "--network-key", key}).output == "kl1\n";
  })) << plant->errors();
  EXPECT_FALSE(answers(*hosts_, 0, 1));
  EXPECT_TRUE(eventually([&] {
    return plant->errors().find(hosts_->address(1) + "; the last: not sealed with a network key") !=
           std::string::npos;
  })) << plant->errors();
  reach_ = "--open-network";
  EXPECT_EQ(swiftlet(1, {"list", "--time", "1"}).exit_code, 1);

  plant.reset();
  plant = start(0, "swiftlet-plant", {});
  EXPECT_TRUE(eventually([&] { return answers(*hosts_, 0, 1); })) << "without a key it is";
  EXPECT_TRUE(eventually([&] {
    return plant->errors().find("--open-network: who is in the network of ") != std::string::npos;
  })) << plant->errors();
}

// Fast DDS 2.9 mixes up who is discovered by two threads together (DatagramGuard::takes_turns()).
TEST_F(Networks, SecureProcessesThatStartTogetherAllMeet) {
  constexpr std::size_t kProcesses = 8;
  connect(Layout::kSwitch);
  dds::NodeSettings settings;
  settings.name = "ground";
  settings.security = make_security_keys(folder_.path() / "lab", "kl1");
  std::vector<std::unique_ptr<dds::Participant>> processes(kProcesses);
  std::vector<std::thread> starts;
  for (std::size_t i = 0; i < kProcesses; ++i) {
    starts.emplace_back([&, i] {
      const HostNetwork::Inside inside(*hosts_, static_cast<int>(i) % 3);
      processes[i] = std::make_unique<dds::Participant>(settings);
    });
  }
  for (std::thread& start : starts) start.join();
  for (const auto& process : processes)
    EXPECT_TRUE(eventually([&] { return process->processes_seen().size() == kProcesses - 1; }));
}

class Doctors : public Networks {
 protected:
  // Runs `swiftlet doctor network` on hosts 0 and 1 at the same time. Returns the report of host 0.
  json examine() const {
    const Words words = {"doctor", "network", "--time", time_s_, "--json"};
    const std::unique_ptr<Program> other = start_other(words);
    const ProgramResult own = swiftlet(0, words);
    EXPECT_NE(other->wait(kStuck), -1) << other->errors();
    json report = json::parse(own.output);
    EXPECT_EQ(own.exit_code, report.at("faults").empty() ? 0 : 1) << own.output << own.errors;
    return report;
  }
  std::unique_ptr<Program> start_other(const Words& words) const {
    const ShiftedClock clock(folder_.path() / "shift", clock_);
    return start(1, "swiftlet", words);
  }
  // The same until a report meets the predicate: on a busy machine one may end before the other begins.
  json examine_until(const std::function<bool(const json&)>& predicate) const {
    json report;
    EXPECT_TRUE(eventually([&] { return predicate(report = examine()); })) << report;
    return report;
  }
  bool has_measured(const json& report) const {
    const json& hosts = report.at("hosts");
    return hosts.size() == 1 && hosts[0].at("answered") > 0 && report.at("faults").empty();
  }
  void expect_plausible(const json& host) const {
    EXPECT_EQ(host.at("address"), hosts_->address(1));
    EXPECT_LE(host.at("answered"), host.at("sent"));
    const double shortest_ms = host.at("round_trip_min_ms");
    EXPECT_GT(shortest_ms, 0.0);
    EXPECT_LE(host.at("round_trip_min_ms"), host.at("round_trip_median_ms"));
    expect_offset(host, 0.0, 0.0);
  }
  void expect_offset(const json& host, double least_ms, double largest_ms) const {
    const double offset_ms = host.at("clock_offset_ms");
    const double uncertainty_ms = host.at("clock_uncertainty_ms");
    EXPECT_GE(offset_ms, least_ms - uncertainty_ms) << host;
    EXPECT_LE(offset_ms, largest_ms + uncertainty_ms) << host;
    EXPECT_GT(uncertainty_ms, 0.0);
  }

  std::string time_s_ = "1";
  ClockShift clock_{};  // of host 1
};

TEST_F(Doctors, MeasureMulticastAndTheClockOfAHostOverASwitch) {
  connect(Layout::kSwitch);
  options_ = {{}, {}, {}};
  const json report = examine_until([&](const json& it) { return has_measured(it); });
  ASSERT_EQ(report.at("interfaces").size(), 1U) << report;
  EXPECT_EQ(report.at("interfaces")[0].at("name"), "eth0");
  EXPECT_EQ(report.at("interfaces")[0].at("mtu_bytes"), 1500);
  EXPECT_EQ(report.at("interfaces")[0].at("own_multicast"), true);
  EXPECT_EQ(report.at("hosts")[0].at("multicast_from_there"), true);
  EXPECT_EQ(report.at("hosts")[0].at("multicast_to_there"), true);
  expect_plausible(report.at("hosts")[0]);

  clock_.shift_s = 3;
  clock_.drift_ppm = 1000.0;
  time_s_ = "3";  // in 1 s the filter's prior of 200 ppm pulls the drift by more than its uncertainty
  const json drifts = examine_until([&](const json& it) {
    if (!has_measured(it)) return false;
    const json& uncertainty_ppm = it.at("hosts")[0].at("clock_drift_uncertainty_ppm");
    return uncertainty_ppm.is_number() && uncertainty_ppm < 60.0;
  });
  EXPECT_NEAR(drifts.at("hosts")[0].at("clock_drift_ppm").get<double>(), 1000.0, 200.0) << drifts;
  expect_offset(drifts.at("hosts")[0], 3000.0, 3060.0);  // drifts for up to a minute
  EXPECT_EQ(drifts.at("hosts")[0].at("clock_steps"), 0);
  EXPECT_EQ(drifts.at("hints").back().get<std::string>().rfind("the clock of ", 0), 0U) << drifts;

  time_s_ = "1";
  clock_.drift_ppm = 0.0;
  clock_.step_s = 1.0;
  clock_.step_after_s = 0.6;
  const json steps = examine_until(
      [&](const json& it) { return has_measured(it) && it.at("hosts")[0].at("clock_steps") == 1; });
  expect_offset(steps.at("hosts")[0], 4000.0, 4000.0);
  EXPECT_NE(steps.at("hints").back().get<std::string>().find("stepped while it was measured"),
            std::string::npos)
      << steps;
}

TEST_F(Doctors, FindEachOtherThroughRoutersByPeersOnly) {
  connect(Layout::kRouter);
  options_ = {{}, {}, {}};
  const json alone = examine();
  EXPECT_EQ(alone.at("hosts"), json::array());
  ASSERT_EQ(alone.at("faults").size(), 1U) << alone;
  EXPECT_EQ(alone.at("faults")[0].get<std::string>().rfind("nobody answers in domain 0: ", 0), 0U) << alone;

  options_ = all_peers();
  const std::unique_ptr<Program> plant = start(2, "swiftlet-plant", {});
  const json report = examine_until([&](const json& it) {
    const json& processes = it.at("processes");
    return has_measured(it) && std::any_of(processes.begin(), processes.end(), [&](const json& process) {
             return process.at("name") == "plant" && process.at("process") == plant->pid();
           });
  });
  EXPECT_EQ(report.at("hosts")[0].at("multicast_from_there"), false);
  expect_plausible(report.at("hosts")[0]);
  const std::string silent = "peer " + hosts_->address(2) + " did not answer";  // no doctor there
  const json& hints = report.at("hints");
  EXPECT_TRUE(std::any_of(hints.begin(), hints.end(), [&](const json& hint) {
    return hint.get<std::string>().rfind(silent, 0) == 0;
  })) << report;
}

}  // namespace
}  // namespace swiftlet::tests
