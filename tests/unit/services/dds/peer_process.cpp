// A separate process for the tests: joins a domain as "peer", receives requests, answers clock_request with zeros, publishes its
// status and actuator commands until its standard input is closed, then leaves.
//   dds_peer DOMAIN
// With "isolated" as DOMAIN, it enters a new network namespace, checks that two nodes discover each other
// there, and exits with 0, or with 77 if it lacks the permission.
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <net/if.h>
#include <sched.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/dds/steady_sender.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures {
namespace {

constexpr int kNotPermitted = 77;
constexpr int kCommandNumber = 9;

bool enter_new_network_namespace() {
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0) return false;
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  const bool up = ::ioctl(socket, SIOCGIFFLAGS, &request) == 0 &&
                  (request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP),
                   ::ioctl(socket, SIOCSIFFLAGS, &request) == 0);
  ::close(socket);
  return up;
}

int check_isolated_nodes() {
  if (!enter_new_network_namespace()) return kNotPermitted;
  NodeSettings settings;
  settings.name = "here";
  Node here(settings);
  settings.name = "there";
  Node there(settings);
  std::atomic<bool> received{false};
  const auto subscription = there.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu&) { received = true; });
  auto publisher = here.publish(messages::topics::kImu);
  const bool done = swiftlet::tests::eventually([&] {
    publisher.publish(messages::fixtures::example<messages::msg::Imu>());
    return received.load();
  });
  return done ? EXIT_SUCCESS : EXIT_FAILURE;
}

int run_peer(int domain) {
  NodeSettings settings;
  settings.name = "peer";
  settings.domain = domain;
  Node node(settings);
  const Subscription requests = node.subscribe<messages::msg::Command>(messages::topics::kCommand,
                                                                       [](const messages::msg::Command&) {});
  auto replies = node.publish(messages::topics::kClockReply);
  const Subscription clock_requests = node.subscribe<messages::msg::ClockRequest>(
      messages::topics::kClockRequest, [&](const messages::msg::ClockRequest& request) {
        messages::msg::ClockReply reply;
        reply.client(request.client());
        reply.sequence_number(request.sequence_number());
        reply.sent_ns(request.sent_ns());
        replies.publish(reply);
      });
  auto state = node.publish(messages::topics::kControlStatus);
  state.publish(messages::fixtures::example<messages::msg::ControlStatus>());
  auto commands = node.publish(messages::topics::kActuatorCommand);
  const SteadySender sender(commands, kCommandNumber);
  char byte = 0;
  while (::read(STDIN_FILENO, &byte, 1) > 0) {
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace swiftlet::dds::fixtures

int main(int argc, char** argv) {
  using namespace swiftlet::dds;
  if (argc < 2) return EXIT_FAILURE;
  const std::string domain = argv[1];
  if (domain == "isolated") return fixtures::check_isolated_nodes();
  return fixtures::run_peer(std::stoi(domain));
}
