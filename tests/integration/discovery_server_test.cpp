// A discovery server that ends, and one that is killed with the process that starts it again.
#include <arpa/inet.h>
#include <chrono>
#include <csignal>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/sockets.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"
#include "tests/support/rtps_message.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using Words = std::vector<std::string>;

constexpr std::uint16_t kPort = 11811;
constexpr std::uint32_t kLease_s = 300;

// A participant that a test speaks for. It sends what a client of Fast DDS sends to a server, and acknowledges nothing.
class Client {
 public:
  enum class Kind { kClient, kSuperClient };  // of its topics, or of all participants

  Client(int number, std::string server, Kind kind = Kind::kClient)
      : server_(std::move(server)), kind_(kind), socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    prefix_[10] = static_cast<std::uint8_t>(number >> 8);
    prefix_[11] = static_cast<std::uint8_t>(number);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // Announces a change: user data that it did not have before.
  void change() {
    ++changes_;
    announce();
  }
  void announce() const {
    ByteWriter list = participant_parameters(prefix_, kLease_s);
    list.parameter(0x0058, ByteWriter().u32(0x0c3f));  // built-in endpoints
    const ByteWriter locator = ByteWriter().u32(1).u32(kPort + 1).zeros(12).bytes(Bytes{127, 0, 0, 1});
    list.parameter(0x0032, locator).parameter(0x0031, locator);
    list.parameter(0x0059, ByteWriter()
                               .u32(1)
                               .string("PARTICIPANT_TYPE")
                               .string(kind_ == Kind::kClient ? "CLIENT" : "SUPER_CLIENT"));
    list.parameter(0x002c, ByteWriter().u32(4).u32(changes_)).sentinel();
    ByteWriter body = about_itself(changes_);
    send(0x15, 2 | 4, body.sentinel().bytes(list.take()));
  }

 private:
  // DATA about the participant, with the identity of the sample that clients send to servers.
  ByteWriter about_itself(std::uint32_t number) const {
    ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, number);
    return body.parameter(0x800f, ByteWriter(guid(prefix_, kSpdpWriter)).number(0, number));
  }
  void send(unsigned kind, unsigned flags, const ByteWriter& body) const {
    const sockaddr_in to = io::socket_address(server_, kPort);
    const Bytes message = RtpsMessage(prefix_).add(kind, flags, body).bytes();
    ::sendto(socket_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  const std::string server_;
  const Kind kind_;
  const int socket_;
  rtps::GuidPrefix prefix_ = kAlice;
  std::uint32_t changes_ = 0;
};

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

// All on one host.
class DiscoveryServers : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
    host_ = std::make_unique<HostNetwork>(HostNetwork::Layout::kSwitch, 1);
    inside_ = std::make_unique<HostNetwork::Inside>(*host_, 0);
    start_server();
  }

  void start_server() {
    server_ = start("swiftlet", {"discovery-server", "--open-network"});
    ASSERT_TRUE(eventually([&] { return server_->output().find("listens on") != std::string::npos; }))
        << server_->errors();
  }
  std::unique_ptr<Program> start(const std::string& program, Words words) const {
    return std::make_unique<Program>(program, std::move(words), folder_.path());
  }
  std::string address() const { return host_->address(0); }
  std::unique_ptr<Client> client(Client::Kind kind = Client::Kind::kClient) {
    return std::make_unique<Client>(++clients_, address(), kind);
  }
  bool server_says(const std::string& word, std::size_t times) const {
    return eventually(
               [&] { return count(server_->output(), word) >= times || !is_running(server_->pid()); }) &&
           is_running(server_->pid());
  }
  // The client announces itself until it has joined, as clients do: a burst may overflow the server's socket.
  bool joins(Client& newcomer, std::size_t joined) const {
    return eventually(
               [&, looks = 0]() mutable {
                 if (count(server_->output(), " joined;") >= joined) return true;
                 if (looks++ % 100 == 0) newcomer.change();
                 return !is_running(server_->pid());
               },
               kStuck, std::chrono::milliseconds(5)) &&
           is_running(server_->pid());
  }

  TemporaryFolder folder_;
  std::unique_ptr<HostNetwork> host_;
  std::unique_ptr<HostNetwork::Inside> inside_;
  std::unique_ptr<Program> server_;
  int clients_ = 0;
};

// An assertion of Fast DDS, for example, which participants provoke that change twice at once.
TEST_F(DiscoveryServers, AreStartedAgainWhenTheyEnd) {
  const std::unique_ptr<Client> first = client(Client::Kind::kSuperClient);
  ASSERT_TRUE(joins(*first, 1)) << server_->errors();
  for (std::size_t ended = 1; ended <= 2; ++ended) {
    const std::vector<pid_t> servers = children_of(server_->pid());
    ASSERT_EQ(servers.size(), 1U);
    ::kill(servers.front(), SIGABRT);
    EXPECT_TRUE(eventually([&] { return count(server_->output(), "listens on") == ended + 1; }))
        << server_->output() << server_->errors();
    EXPECT_EQ(count(server_->errors(), "was ended by signal 6 (Aborted) and is started again"), ended);
    const std::unique_ptr<Client> newcomer = client(Client::Kind::kSuperClient);
    EXPECT_TRUE(joins(*newcomer, ended + 1)) << server_->output() << server_->errors();
  }
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->wait(kStuck), 0) << server_->errors();
  EXPECT_NE(server_->output().find("remain and keep what they know of each other"), std::string::npos);
}

// GIVEN a vehicle in flight WHEN the server is killed and started again at once THEN newcomers find the vehicle, and land it.
// In lockstep, so that a busy machine slows the flight down.
TEST_F(DiscoveryServers, IntroduceNewcomersAfterAKillInFlight) {
  const Words client = {"--open-network", "--discovery-server", address()};
  const auto start_client = [&](const std::string& program, Words words) {
    words.insert(words.end(), client.begin(), client.end());
    return start(program, std::move(words));
  };
  const auto plant = start_client("swiftlet-plant", {"--clock", "lockstep", "--speed", "2"});
  const auto mocap = start_client("swiftlet-mocap", {"--clock", "lockstep"});
  const auto control = start_client("swiftlet-control", {"--clock", "lockstep"});
  const auto request = [&](const std::string& name) {
    const auto program = start_client("swiftlet", {name, "--wait", "60"});
    EXPECT_EQ(program->wait(kStuck), 0)
        << name << ": " << program->errors() << control->errors() << plant->errors() << server_->output();
  };
  ASSERT_TRUE(eventually([&] { return control->errors().find("mocap available") != std::string::npos; }))
      << control->errors();
  request("arm");
  request("takeoff");
  server_->signal(SIGKILL);
  server_->wait(kStuck);
  start_server();
  EXPECT_TRUE(server_says("control (process " + std::to_string(control->pid()), 1)) << server_->output();
  request("land");
  for (Program* const program : {plant.get(), mocap.get(), control.get()})
    EXPECT_TRUE(is_running(program->pid())) << program->errors();
}

}  // namespace
}  // namespace swiftlet::tests
