#include "tests/support/mocap/vrpn_server.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <netinet/in.h>
#include <sys/socket.h>
#include <utility>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::tests {
namespace {

namespace vrpn = mocap::vrpn;

// The server's numbers of the types, which are not those of the client.
enum Type : std::int32_t { kPose = 11, kPong = 12, kPing = 13 };

template <class Number>
void put(vrpn::Bytes& out, Number number) {
  std::uint8_t bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  out.insert(out.end(), std::make_reverse_iterator(bytes + sizeof number), std::make_reverse_iterator(bytes));
}

}  // namespace

VrpnServer::VrpnServer(Settings settings)
    : settings_(std::move(settings)),
      listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const int yes = 1;
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address = io::socket_address("127.0.0.1", settings_.port);
  ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::listen(listener_.get(), 4);
  socklen_t size = sizeof address;
  ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  udp_.emplace("127.0.0.1", 0);
  thread_ = std::thread([this] { run(); });
}

VrpnServer::~VrpnServer() {
  stop_ = true;
  thread_.join();
}

void VrpnServer::run() {
  while (!stop_) {
    io::wait_for_input({listener_.get(), connection_.get()}, std::chrono::milliseconds(5));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (drop_.exchange(false)) {
      connection_.close();
      is_connected_ = false;
    }
    accept();
    if (connection_.is_open()) read();
  }
}

void VrpnServer::accept() {
  const int fd = ::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (fd < 0) return;
  connection_ = io::Descriptor(fd);
  received_.clear();
  types_.clear();
  udp_client_.reset();
  sequence_ = 0;
  write({settings_.cookie.begin(), settings_.cookie.end()});
  write(vrpn::description(vrpn::kSenderDescription, 0, "VRPN Control"));
  for (std::size_t i = 0; i < settings_.trackers.size(); ++i)
    write(
        vrpn::description(vrpn::kSenderDescription, static_cast<std::int32_t>(i + 1), settings_.trackers[i]));
  write(vrpn::description(vrpn::kTypeDescription, kPose, vrpn::kPoseType));
  write(vrpn::description(vrpn::kTypeDescription, kPing, vrpn::kPingType));
  write(vrpn::description(vrpn::kTypeDescription, kPong, vrpn::kPongType));
}

void VrpnServer::read() {
  std::uint8_t buffer[4096];
  const ssize_t bytes = ::recv(connection_.get(), buffer, sizeof buffer, 0);
  if (bytes == 0) {
    connection_.close();
    is_connected_ = false;
  }
  if (bytes <= 0) return;
  received_.insert(received_.end(), buffer, buffer + bytes);
  std::size_t begin = is_connected_ ? 0 : vrpn::kCookieBytes;
  if (received_.size() < begin) return;
  is_connected_ = true;
  vrpn::Message message;
  while (vrpn::parse_message(received_.data() + begin, received_.size() - begin, message) ==
         vrpn::Parsed::kMessage) {
    answer(message);
    begin += message.bytes;
  }
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(begin));
}

void VrpnServer::answer(const vrpn::Message& message) {
  if (message.type == vrpn::kTypeDescription)
    types_[message.sender] = vrpn::parse_description(message.payload).value_or("");
  if (message.type == vrpn::kUdpDescription)
    udp_client_ = io::Endpoint{INADDR_LOOPBACK, static_cast<std::uint16_t>(message.sender)};
  const auto type = types_.find(message.type);
  if (type == types_.end() || type->second != vrpn::kPingType) return;
  ++pings_;
  if (!settings_.answers_pings) return;
  write(vrpn::message(runtime::system_ns() + settings_.clock_offset_ns, message.sender, kPong, {}));
}

bool VrpnServer::send(std::size_t tracker, const double (&pose)[7], std::int64_t age_ns,
                      std::int32_t sensor) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!is_connected_) return false;
  vrpn::Bytes payload;
  put(payload, sensor);
  put(payload, std::int32_t{0});
  for (const double number : pose) put(payload, number);
  vrpn::Bytes bytes = vrpn::message(runtime::system_ns() + settings_.clock_offset_ns - age_ns,
                                    static_cast<std::int32_t>(tracker + 1), kPose, payload);
  const std::uint32_t sequence = htonl(++sequence_);
  std::memcpy(bytes.data() + 20, &sequence, sizeof sequence);
  if (settings_.by_udp && udp_client_) return udp_->send(bytes, *udp_client_);
  write(bytes);
  return true;
}

void VrpnServer::write(const vrpn::Bytes& bytes) const {
  ::send(connection_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

}  // namespace swiftlet::tests
