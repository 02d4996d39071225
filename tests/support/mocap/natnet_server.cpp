#include "tests/support/mocap/natnet_server.hpp"

#include <arpa/inet.h>
#include <chrono>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>
#include <utility>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::tests {
namespace {

using mocap::natnet::MessageId;

constexpr std::uint32_t kGroup = 0xefff2a63;  // 239.255.42.99

}  // namespace

NatNetServer::NatNetServer(Settings settings)
    : settings_(std::move(settings)),
      clock_offset_ns_(settings_.clock_offset_ns),
      commands_(settings_.address, settings_.port, true),
      thread_([this] { run(); }) {
  in_addr interface {};
  ::inet_pton(AF_INET, settings_.address.c_str(), &interface);
  ::setsockopt(commands_.fd(), IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
}

NatNetServer::~NatNetServer() {
  stop_ = true;
  thread_.join();
}

void NatNetServer::set_models(std::vector<natnet::Body> models) {
  const std::lock_guard<std::mutex> lock(mutex_);
  models_ = std::move(models);
}

bool NatNetServer::is_connected() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return client_.has_value();
}

std::uint64_t NatNetServer::ticks(std::int64_t monotonic_ns) const {
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns + clock_offset_ns_);
  return static_cast<std::uint64_t>(seconds * static_cast<double>(settings_.server.clock_hz));
}

bool NatNetServer::send(natnet::Frame frame, std::int64_t latency_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!client_) return false;
  const std::int64_t now_ns = runtime::monotonic_ns();
  frame.exposed_ticks = ticks(now_ns - latency_ns);
  frame.received_ticks = frame.sent_ticks = ticks(now_ns);
  const io::Endpoint group{kGroup, settings_.server.data_port};
  return commands_.send(natnet::frame(settings_.server.version, frame),
                        settings_.server.multicast ? group : *client_);
}

void NatNetServer::run() {
  std::vector<std::uint8_t> datagram;
  while (!stop_) {
    io::wait_for_input({commands_.fd()}, std::chrono::milliseconds(10));
    while (const auto from = commands_.receive(datagram)) answer(datagram, *from);
  }
}

void NatNetServer::answer(const std::vector<std::uint8_t>& datagram, const io::Endpoint& from) {
  const auto message = mocap::natnet::parse_message(datagram.data(), datagram.size());
  if (!message) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  io::ByteReader payload = message->payload;
  switch (message->id) {
    case MessageId::kConnect:
      client_ = from;
      commands_.send(natnet::server_info(settings_.server), from);
      return;
    case MessageId::kDiscovery:
      commands_.send(natnet::server_info(settings_.server), from);
      return;
    case MessageId::kRequestModels:
      commands_.send(natnet::models(settings_.server.version, models_), from);
      return;
    case MessageId::kEchoRequest:
      ++echoes_;
      if (settings_.answers_echo)
        commands_.send(natnet::echo_response(payload.u64(), ticks(runtime::monotonic_ns())), from);
      return;
    case MessageId::kKeepAlive:
      ++keep_alives_;
      return;
    default:
      return;
  }
}

}  // namespace swiftlet::tests
