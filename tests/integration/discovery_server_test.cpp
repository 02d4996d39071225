// A discovery server among participants that change faster than it takes them in, and one that is killed.
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

// A participant that a test speaks for. It sends what a client of Fast DDS sends to a server, but keeps no time between its
// changes, and acknowledges nothing.
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
  void say_goodbye() {
    ByteWriter body = about_itself(++changes_);
    body.parameter(0x0070, guid(prefix_, comms::kParticipantEntity));
    body.u16(0x0071).u16(4).bytes(Bytes{0, 0, 0, 3});  // disposed and unregistered
    send(0x15, 2, body.sentinel());
  }
  void announce_writer() const {
    ByteWriter body = data_fields(kSedpReader, kSedpWriter, 1);
    body.u16(0x0300).u16(0);
    body.parameter(0x005a, guid(prefix_, kUserWriter)).parameter(0x0005, ByteWriter().string("topic"));
    body.parameter(0x0007, ByteWriter().string("Type"));
    send(0x15, 4, body.sentinel());
  }

 private:
  // DATA about the participant, with the identity of the sample that clients send to servers.
  ByteWriter about_itself(std::uint32_t number) const {
    ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, number);
    return body.parameter(0x800f, ByteWriter(guid(prefix_, kSpdpWriter)).number(0, number));
  }
  void send(unsigned kind, unsigned flags, const ByteWriter& body) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(kPort);
    to.sin_addr.s_addr = inet_addr(server_.c_str());
    const Bytes message = RtpsMessage(prefix_).add(kind, flags, body).bytes();
    ::sendto(socket_, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  const std::string server_;
  const Kind kind_;
  const int socket_;
  comms::GuidPrefix prefix_ = kAlice;
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

// Without a time between the changes that it takes in, the server of Fast DDS ends with failed assertions, such as
// "min_seq <= last_seq", when a participant joins after others have changed several times.
TEST_F(DiscoveryServers, OutliveParticipantsThatChangeAtOnceAndLeave) {
  constexpr int kRounds = 24;
  constexpr std::size_t kAtATime = 8;
  constexpr int kChanges = 12;
  const std::unique_ptr<Client> hears_all = client(Client::Kind::kSuperClient);
  std::size_t joined = 1;
  ASSERT_TRUE(joins(*hears_all, joined)) << server_->errors();
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::unique_ptr<Client>> clients;
    for (std::size_t i = 0; i < kAtATime; ++i) {
      clients.push_back(client());
      ASSERT_TRUE(joins(*clients.back(), ++joined)) << server_->errors();
      clients.back()->announce_writer();
    }
    const std::unique_ptr<Client> newcomer = client(Client::Kind::kSuperClient);
    server_->signal(SIGSTOP);
    for (const auto& it : clients) {
      for (int change = 0; change < kChanges; ++change) it->change();
      it->say_goodbye();
    }
    newcomer->change();
    server_->signal(SIGCONT);
    ASSERT_TRUE(joins(*newcomer, ++joined)) << "round " << round << ": " << server_->errors();
  }
}

// A server that waits 0.1 s before it takes in each of the changes needs 15 s, on any machine.
TEST_F(DiscoveryServers, TakeInANewcomerBehindAFloodOfChanges) {
  constexpr int kChanges = 150;
  constexpr std::chrono::seconds kSoon{10};
  const std::unique_ptr<Client> flood = client();
  const std::unique_ptr<Client> newcomer = client();
  server_->signal(SIGSTOP);
  for (int change = 0; change < kChanges; ++change) flood->change();
  newcomer->change();
  server_->signal(SIGCONT);
  EXPECT_TRUE(eventually([&] { return count(server_->output(), " joined;") == 2; }, kSoon))
      << server_->output() << server_->errors();
}

// The lease of the participant would end after 300 s.
TEST_F(DiscoveryServers, HearGoodbyesThatComeTooEarly) {
  const std::unique_ptr<Client> leaves = client();
  const std::unique_ptr<Client> stays = client();
  stays->change();
  server_->signal(SIGSTOP);
  leaves->change();
  leaves->change();
  leaves->say_goodbye();
  server_->signal(SIGCONT);
  EXPECT_TRUE(eventually([&] {
    stays->announce();
    return count(server_->output(), " left;") == 1;
  })) << server_->output();
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
