// Other processes: peers that join, leave and crash, and their streams.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures::process_test {

using swiftlet::dds::DomainLock;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

// Runs dds_peer; the destructor kills it, and the end of the test.
class PeerProcess {
 public:
  explicit PeerProcess(std::string domain) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    std::string program = tests::in_build("tests/dds_peer");
    char* const arguments[] = {program.data(), domain.data(), nullptr};
    pid_ = ::fork();
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG,
              SIGKILL);  // a stopped one would outlive a test that ends early, and keep its output open
      ::dup2(ends[0], STDIN_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      ::execv(arguments[0], arguments);
      ::_exit(127);
    }
    ::close(ends[0]);
    input_ = ends[1];
  }
  ~PeerProcess() {
    if (pid_ > 0) crash();
  }
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  pid_t pid() const { return pid_; }
  void stop() const { ::kill(pid_, SIGSTOP); }
  void resume() const { ::kill(pid_, SIGCONT); }
  void crash() {
    ::kill(pid_, SIGKILL);
    finish();
  }
  int finish() {
    ::close(input_);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int input_ = -1;
};

class Peers : public testing::Test {
 protected:
  Peers() : node_(settings()) {
    node_.on_peer([this](const PeerEvent& event) {
      if (event.name == "peer") events_.put(event);
    });
  }

  NodeSettings settings() const {
    NodeSettings settings;
    settings.name = "observer";
    settings.domain = lock_.domain();
    return settings;
  }
  PeerProcess start() const { return PeerProcess(std::to_string(lock_.domain())); }

  DomainLock lock_;
  Inbox<PeerEvent> events_;
  Node node_;
};

TEST_F(Peers, AreReportedWithTheirStatusUntilTheyLeave) {
  PeerProcess peer = start();
  ASSERT_TRUE(events_.wait_for_count(1));
  EXPECT_TRUE(events_.items()[0].alive);

  Inbox<messages::msg::ControlStatus> states;
  const auto subscription = node_.subscribe<messages::msg::ControlStatus>(
      messages::topics::kControlStatus,
      [&](const messages::msg::ControlStatus& message) { states.put(message); });
  ASSERT_TRUE(states.wait_for_count(1)) << "to a late joiner";
  EXPECT_TRUE(states.items()[0] == messages::fixtures::example<messages::msg::ControlStatus>());

  EXPECT_EQ(peer.finish(), 0);

  ASSERT_TRUE(events_.wait_for_count(2));
  EXPECT_FALSE(events_.items()[1].alive);
  EXPECT_TRUE(events_.items()[1].said_goodbye);
}

TEST_F(Peers, AreReportedToALateListener) {
  const PeerProcess peer = start();
  ASSERT_TRUE(events_.wait_for_count(1));
  Inbox<PeerEvent> late;
  node_.on_peer([&](const PeerEvent& event) { late.put(event); });
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(late.items()[0].name, "peer");
  EXPECT_TRUE(late.items()[0].alive);
  node_.on_peer({});
}

// GIVEN one source of a topic WHEN it dies and another process takes its place THEN that is told before the first sample of this one.
TEST_F(Peers, TheNextSourceIsTold) {
  Inbox<std::string> told;
  const auto subscription = node_.subscribe<messages::msg::ActuatorCommand>(
      messages::topics::kActuatorCommand,
      [&](const messages::msg::ActuatorCommand&) {
        if (told.size() == 0 || told.items().back() != "sample") told.put("sample");
      },
      Delivery::kShared, OneSource{200ms, [&] { told.put("next"); }});
  PeerProcess first = start();
  ASSERT_TRUE(told.wait_for_count(1));
  first.crash();
  const PeerProcess second = start();
  ASSERT_TRUE(told.wait_for_count(3));
  EXPECT_EQ(told.items(), (std::vector<std::string>{"sample", "next", "sample"}));
}

// GIVEN a vehicle and a second process of its name, whose clock stands at 0 WHEN both answer THEN the clock stays the vehicle's.
TEST_F(Peers, DoNotSetTheClockThatTheVehicleToldFirst) {
  const auto own_ns = [] { return std::chrono::steady_clock::now().time_since_epoch() / 1ns; };
  constexpr std::int64_t kOffset_ns = 1'000'000'000'000;
  NodeSettings named = settings();
  named.name = "plant";
  Node vehicle(named);
  const clocks::ClockServer server(vehicle, [&] { return own_ns() + kOffset_ns; });
  clocks::ClockClient client(node_, own_ns);
  ASSERT_TRUE(eventually([&] {
    client.ask_if_due();
    return client.to_vehicle(0).has_value();
  }));
  std::atomic<int> zeros{0};
  const auto replies = node_.subscribe<messages::msg::ClockReply>(
      messages::topics::kClockReply,
      [&](const messages::msg::ClockReply& reply) { zeros += reply.received_ns() == 0; });
  const PeerProcess peer = start();
  std::int64_t furthest_ns = 0;
  ASSERT_TRUE(eventually([&] {
    client.ask_if_due();
    const std::int64_t stamp_ns = own_ns();
    if (const auto vehicle_ns = client.to_vehicle(stamp_ns))
      furthest_ns = std::max(furthest_ns, std::abs(*vehicle_ns - stamp_ns - kOffset_ns));
    return zeros > 20;
  }));
  EXPECT_LT(furthest_ns, clocks::kLongestExchangeNs);
  EXPECT_TRUE(client.to_vehicle(0).has_value()) << "it is not in doubt";
}

// GIVEN a peer WHEN it stands still for longer than its lease THEN it is received again for as long as it runs. WHEN it dies THEN
// that is reported within the lease.
TEST_F(Peers, AreReceivedAgainAfterASuspensionAndReportedDeadWithinTheLease) {
  Inbox<std::uint64_t> received;
  const auto subscription = node_.subscribe<messages::msg::ActuatorCommand>(
      messages::topics::kActuatorCommand,
      [&](const messages::msg::ActuatorCommand& command) { received.put(command.sequence_number()); });
  const auto of_peer = [](const std::vector<std::uint64_t>& numbers) {
    return std::count(numbers.begin(), numbers.end(), 9U);
  };
  PeerProcess peer = start();
  ASSERT_TRUE(received.wait_for_count(1));

  peer.stop();
  ASSERT_TRUE(events_.wait_for_count(2));
  ASSERT_FALSE(events_.items()[1].alive);
  const auto before = of_peer(received.items());
  peer.resume();
  EXPECT_TRUE(received.wait([&](const auto& numbers) { return of_peer(numbers) >= before + 1500; }))
      << of_peer(received.items()) - before << " received after it resumed";

  const std::size_t reported = events_.size();
  peer.crash();
  const auto crashed_at = std::chrono::steady_clock::now();
  ASSERT_TRUE(events_.wait_for_count(reported + 1));
  EXPECT_LT(std::chrono::steady_clock::now() - crashed_at, messages::kLivelinessLease + 1s);
  EXPECT_FALSE(events_.items()[reported].alive);
  EXPECT_FALSE(events_.items()[reported].said_goodbye);
}

// GIVEN requests that a peer does not acknowledge, because it is stopped WHEN their publishers are destroyed THEN they end,
// whatever heartbeats Fast DDS sends for them meanwhile. Many, since what it guards against is a matter of microseconds.
TEST_F(Peers, PublishersOfUnacknowledgedRequestsEnd) {
  constexpr int kNodes = 8;
  constexpr int kPublishers = 40;  // of each
  for (int round = 0; round < 5; ++round) {
    const PeerProcess peer = start();
    std::vector<std::unique_ptr<Node>> nodes;
    std::vector<std::vector<Publisher<messages::msg::Command>>> publishers(kNodes);
    for (auto& of_node : publishers) {
      nodes.push_back(std::make_unique<Node>(settings()));
      for (int i = 0; i < kPublishers; ++i)
        of_node.push_back(nodes.back()->publish(messages::topics::kCommand));
    }
    for (const auto& of_node : publishers) {
      for (const auto& publisher : of_node) ASSERT_TRUE(eventually([&] { return publisher.matched() == 1; }));
    }
    peer.stop();
    std::vector<std::future<void>> ended;
    for (auto& of_node : publishers) {
      ended.push_back(std::async(std::launch::async, [&of_node] {
        for (auto& publisher : of_node) {
          for (int i = 0; i < messages::kKeptRequests; ++i)
            publisher.publish(messages::fixtures::example<messages::msg::Command>());
        }
        of_node.clear();
      }));
    }
    for (const std::future<void>& end : ended) {
      if (end.wait_for(swiftlet::tests::kStuck) == std::future_status::ready) continue;
      std::fputs("the publishers of a node do not end\n", stderr);
      std::_Exit(EXIT_FAILURE);  // nor would the node
    }
  }
}

// GIVEN a reader that acknowledges nothing, because its process is stopped WHEN more requests are sent than are kept THEN all are
// sent before the lease of that process ends, and the other reader receives each.
TEST_F(Peers, AReaderThatAcknowledgesNothingHoldsUpNoRequest) {
  constexpr std::uint64_t kRequests = messages::kKeptRequests + 4;
  Inbox<std::uint64_t> received;
  const auto subscription = node_.subscribe<messages::msg::Command>(
      messages::topics::kCommand, [&](const messages::msg::Command& command) { received.put(command.id()); });
  NodeSettings client = settings();
  client.name = "client";
  Node ground(client);
  Publisher<messages::msg::Command> commands = ground.publish(messages::topics::kCommand);
  const PeerProcess peer = start();
  ASSERT_TRUE(eventually([&] { return commands.matched() == 2; }));
  peer.stop();
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t id = 1; id <= kRequests; ++id) {
    messages::msg::Command command = messages::fixtures::example<messages::msg::Command>();
    command.id(id);
    EXPECT_TRUE(commands.publish(command)) << id;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - began, messages::kLivelinessLease);
  ASSERT_TRUE(received.wait_for_count(kRequests)) << received.size();
  for (std::uint64_t id = 1; id <= kRequests; ++id) EXPECT_EQ(received.items()[id - 1], id);
}

TEST(Isolation, NodesDiscoverEachOtherInANewNetworkNamespace) {
  PeerProcess process("isolated");
  const int code = process.finish();
  if (code == 77) GTEST_SKIP() << "a new network namespace is not permitted";
  EXPECT_EQ(code, 0);
}

TEST(Domain, Holds32Participants) {
  const DomainLock lock;
  NodeSettings settings;
  settings.domain = lock.domain();
  settings.name = "first";
  Inbox<PeerEvent> events;
  Node first(settings);
  first.on_peer([&](const PeerEvent& event) { events.put(event); });
  settings.name = "other";
  std::vector<std::unique_ptr<Node>> others;
  for (int i = 1; i < 32; ++i) others.push_back(std::make_unique<Node>(settings));
  EXPECT_TRUE(events.wait_for_count(31));
}

}  // namespace swiftlet::dds::fixtures::process_test
