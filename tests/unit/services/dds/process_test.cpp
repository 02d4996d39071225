// Other processes: peers that join, leave and crash, their streams and their shared memory.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/shared_memory.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/dds/steady_sender.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::comms::tests {
namespace {

using swiftlet::comms::DomainLock;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

// Runs dds_peer; the destructor kills it.
class PeerProcess {
 public:
  explicit PeerProcess(const std::vector<std::string>& words) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    std::vector<std::string> arguments{SWIFTLET_DDS_PEER};
    arguments.insert(arguments.end(), words.begin(), words.end());
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[0], STDIN_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      ::execv(pointers[0], pointers.data());
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

  // Files in /dev/shm that the process maps.
  std::vector<std::string> shared_memory() const {
    std::vector<std::string> files;
    std::ifstream maps("/proc/" + std::to_string(pid_) + "/maps");
    for (std::string line; std::getline(maps, line);) {
      const auto place = line.find("/dev/shm/");
      if (place != std::string::npos) files.push_back(line.substr(place));
    }
    return files;
  }

  // Files in /dev/shm of its own: it holds their locks. It maps those of others too, until it knows that they have ended.
  std::vector<std::string> own_shared_memory() const {
    constexpr std::string_view kLock = "_el";
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/fd")) {
      std::error_code closed;
      std::string file = std::filesystem::read_symlink(entry, closed);
      if (file.rfind("/dev/shm/", 0) != 0 || file.size() < kLock.size()) continue;
      file.resize(file.size() - kLock.size());
      files.push_back(file);
    }
    return files;
  }

 private:
  pid_t pid_ = -1;
  int input_ = -1;
};

class Peers : public testing::Test {
 protected:
  Peers() : node_(settings()) {
    node_.on_peer([this](const PeerEvent& event) { events_.put(event); });
  }

  NodeSettings settings() const {
    NodeSettings settings;
    settings.name = "observer";
    settings.domain = lock_.domain();
    settings.localhost_only = true;
    return settings;
  }
  PeerProcess start(const char* transport = "udp") const {
    return PeerProcess({std::to_string(lock_.domain()), transport});
  }

  DomainLock lock_;
  Inbox<PeerEvent> events_;
  Node node_;
};

TEST_F(Peers, AreReportedWhenTheyLeave) {
  PeerProcess peer = start();
  ASSERT_TRUE(events_.wait_for_count(1));
  EXPECT_EQ(events_.items()[0].name, "peer");
  EXPECT_TRUE(events_.items()[0].alive);

  EXPECT_EQ(peer.finish(), 0);

  ASSERT_TRUE(events_.wait_for_count(2));
  EXPECT_EQ(events_.items()[1].name, "peer");
  EXPECT_FALSE(events_.items()[1].alive);
  EXPECT_TRUE(events_.items()[1].said_goodbye);
}

// This and DeadControllersStream... measure real time and run alone (ALONE in CMakeLists.txt).
TEST_F(Peers, AreReportedDeadWithinTheLease) {
  PeerProcess peer = start();
  ASSERT_TRUE(events_.wait_for_count(1));

  peer.crash();
  const auto crashed_at = std::chrono::steady_clock::now();

  ASSERT_TRUE(events_.wait_for_count(2));
  EXPECT_LT(std::chrono::steady_clock::now() - crashed_at, kLivelinessLease + 1s);
  EXPECT_EQ(events_.items()[1].name, "peer");
  EXPECT_FALSE(events_.items()[1].alive);
  EXPECT_FALSE(events_.items()[1].said_goodbye);
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

TEST_F(Peers, StatusReachesALateJoiner) {
  const PeerProcess peer = start();
  ASSERT_TRUE(events_.wait_for_count(1));
  Inbox<msg::ControlStatus> states;
  const auto subscription = node_.subscribe<msg::ControlStatus>(
      topics::kControlStatus, [&](const msg::ControlStatus& message) { states.put(message); });
  ASSERT_TRUE(states.wait_for_count(1));
  EXPECT_TRUE(states.items()[0] == example<msg::ControlStatus>());
}

TEST_F(Peers, DeadControllersStreamIsTakenOverBeforeTheLeaseEnds) {
  Inbox<std::uint64_t> received;
  const auto subscription = node_.subscribe<msg::ActuatorCommand>(
      topics::kActuatorCommand,
      [&](const msg::ActuatorCommand& command) { received.put(command.sequence_number()); });
  NodeSettings standby_settings = settings();
  standby_settings.name = "standby";
  Node standby(standby_settings);
  auto commands = standby.publish(topics::kActuatorCommand, 1);
  const SteadySender sender(commands, 1);
  PeerProcess strong = start();
  const bool obeyed =
      received.wait([](const auto& numbers) { return !numbers.empty() && numbers.back() == 9; });

  strong.crash();
  const auto crashed_at = std::chrono::steady_clock::now();
  const bool taken_over = received.wait([](const auto& numbers) { return numbers.back() == 1; });
  const auto outage = std::chrono::steady_clock::now() - crashed_at;

  EXPECT_TRUE(obeyed);
  EXPECT_TRUE(taken_over);
  EXPECT_LT(outage, kLivelinessLease / 2);
}

TEST_F(Peers, AreReceivedAgainAfterASuspension) {
  Inbox<std::uint64_t> received;
  const auto subscription = node_.subscribe<msg::ActuatorCommand>(
      topics::kActuatorCommand,
      [&](const msg::ActuatorCommand& command) { received.put(command.sequence_number()); });
  const PeerProcess peer = start();
  ASSERT_TRUE(received.wait_for_count(1));

  peer.stop();
  ASSERT_TRUE(events_.wait_for_count(2));
  ASSERT_FALSE(events_.items()[1].alive);
  const std::size_t before = received.size();
  peer.resume();

  EXPECT_TRUE(received.wait_for_count(before + 1500))
      << received.size() - before << " received after it resumed";
}

// GIVEN requests that a peer does not acknowledge, because it is stopped WHEN their publishers are destroyed THEN they end,
// whatever heartbeats Fast DDS sends for them meanwhile. Many, since what it guards against is a matter of microseconds.
TEST_F(Peers, PublishersOfUnacknowledgedRequestsEnd) {
  constexpr int kNodes = 8;
  constexpr int kPublishers = 40;  // of each
  for (int round = 0; round < 5; ++round) {
    const PeerProcess peer = start();
    std::vector<std::unique_ptr<Node>> nodes;
    std::vector<std::vector<Publisher<msg::Command>>> publishers(kNodes);
    for (auto& of_node : publishers) {
      nodes.push_back(std::make_unique<Node>(settings()));
      for (int i = 0; i < kPublishers; ++i) of_node.push_back(nodes.back()->publish(topics::kCommand));
    }
    for (const auto& of_node : publishers) {
      for (const auto& publisher : of_node) ASSERT_TRUE(eventually([&] { return publisher.matched() == 1; }));
    }
    peer.stop();
    std::vector<std::future<void>> ended;
    for (auto& of_node : publishers) {
      ended.push_back(std::async(std::launch::async, [&of_node] {
        for (auto& publisher : of_node) {
          for (int i = 0; i < kMaxUnacknowledgedRequests; ++i) publisher.publish(example<msg::Command>());
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

TEST_F(Peers, UdpTransportMapsNoSharedMemory) {
  PeerProcess peer = start("udp");
  ASSERT_TRUE(events_.wait_for_count(1));
  EXPECT_EQ(peer.shared_memory(), std::vector<std::string>{});
}

TEST_F(Peers, SharedMemoryIsRemovedForDeadProcessesOnly) {
  PeerProcess dead = start("shm");
  ASSERT_TRUE(events_.wait_for_count(1));
  PeerProcess alive = start("shm");
  ASSERT_TRUE(events_.wait_for_count(2));
  const auto exist = [](const std::vector<std::string>& files) {
    return std::any_of(files.begin(), files.end(),
                       [](const std::string& file) { return std::filesystem::exists(file); });
  };
  const std::vector<std::string> left_over = dead.own_shared_memory();
  ASSERT_FALSE(left_over.empty());

  dead.crash();
  ASSERT_TRUE(exist(left_over));

  std::vector<std::string> remaining;
  EXPECT_TRUE(eventually([&] {
    remove_stale_shared_memory();
    // It may have opened the port of the dead one again, to send to it.
    const std::vector<std::string> in_use = alive.shared_memory();
    remaining.clear();
    std::copy_if(
        left_over.begin(), left_over.end(), std::back_inserter(remaining), [&](const std::string& file) {
          const bool shared_with_living = std::find(in_use.begin(), in_use.end(), file) != in_use.end();
          return !shared_with_living && std::filesystem::exists(file);
        });
    return remaining.empty();
  })) << testing::PrintToString(remaining);
  const std::vector<std::string> own = alive.own_shared_memory();
  EXPECT_FALSE(own.empty());
  for (const std::string& file : own) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_EQ(alive.finish(), 0);
}

TEST(Isolation, NodesDiscoverEachOtherInANewNetworkNamespace) {
  PeerProcess process({"isolated"});
  const int code = process.finish();
  if (code == 77) GTEST_SKIP() << "a new network namespace is not permitted";
  EXPECT_EQ(code, 0);
}

TEST(Domain, Holds32Participants) {
  const DomainLock lock;
  NodeSettings settings;
  settings.domain = lock.domain();
  settings.localhost_only = true;
  settings.name = "first";
  Node first(settings);
  Inbox<PeerEvent> events;
  first.on_peer([&](const PeerEvent& event) { events.put(event); });
  settings.name = "other";
  std::vector<std::unique_ptr<Node>> others;
  for (int i = 1; i < 32; ++i) others.push_back(std::make_unique<Node>(settings));
  EXPECT_TRUE(events.wait_for_count(31));
}

}  // namespace
}  // namespace swiftlet::comms::tests
