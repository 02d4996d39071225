// Hosts on a switch, and behind routers that forward no multicast: who reaches whom.
#include "tests/integration/networks.hpp"

#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <netinet/in.h>
#include <set>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/rtps_message.hpp"
#include "tests/support/security_keys.hpp"

namespace swiftlet::tests {
namespace {

constexpr std::uint16_t kFirstDiscoveryPort = 7410;

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
  EXPECT_NE(list.errors.find("in a network without multicast give --peer or --discovery-server"),
            std::string::npos)
      << list.errors;
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
  const std::string from = " from " + hosts_->address(0) + " are refused, ";
  const std::string give = "give this process the key of those there (--network-key, SWIFTLET_NETWORK_KEY)";
  const std::string other = (folder_.path() / "other.key").string();
  ASSERT_EQ(swiftlet(0, {"keys", "network", other}).exit_code, 0);
  expect_names_the_key({"--network-key", other}, from + "sealed with another network key; " + give);
  expect_names_the_key({"--open-network"},
                       from + "sealed with a network key, and this process has none; " + give);
  expect_names_the_key({}, "(on the network too with --network-key, --security or --open-network)");

  reach_ = "--open-network";
  plant.reset();
  plant = start(0, "swiftlet-plant", {});
  EXPECT_TRUE(eventually([&] { return answers(*hosts_, 0, 1); })) << "without a key it is";
  EXPECT_TRUE(eventually([&] {
    return plant->errors().find("--open-network: who is in the network of ") != std::string::npos;
  })) << plant->errors();
  reach_ = nullptr;
  expect_names_the_key({"--network-key", key},
                       from + "not sealed with a network key; start those there with ");
  EXPECT_TRUE(eventually([&] {
    return plant->errors().find(hosts_->address(1) +
                                "; the last: sealed with a network key, and this process has none") !=
           std::string::npos;
  })) << plant->errors();
}

// An announcement is neither encrypted nor sealed, but says that its sender has certificates.
TEST_F(Networks, WhoHasOtherCertificatesOrNoneIsToldSo) {
  connect(Layout::kSwitch);
  options_ = {{}, {}, {}};
  reach_ = nullptr;
  const std::string lab = make_security_keys(folder_.path() / "lab", "kl1");
  const std::string other = make_security_keys(folder_.path() / "other", "kl1");
  const std::unique_ptr<Program> plant = start(0, "swiftlet-plant", {"--security", lab});
  ASSERT_TRUE(eventually([&] {
    return swiftlet(1, {"list", "--names", "--time", "2", "--security", lab}).output == "kl1\n";
  })) << plant->errors();
  const std::string from = " from " + hosts_->address(0) + " are refused, ";
  expect_names_the_key({"--open-network"}, from +
                                               "security token, but security is off (DDS Security 7.2.4); "
                                               "give this process keys as those there have (--security, ");
  expect_names_the_key({"--security", other}, ") is refused: it has no keys of this --security; ");
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

}  // namespace
}  // namespace swiftlet::tests
