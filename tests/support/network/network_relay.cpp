#include "tests/support/network/network_relay.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <queue>
#include <random>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::tests {
namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kLongestFrame = 65'600;  // a datagram that the interface would divide
constexpr int kBufferBytes = 8 << 20;
constexpr std::chrono::milliseconds kPoll{20};
constexpr int kPriority = 90;  // above the programs whose frames it moves: a cable does not wait for a core

// A socket at an end of a cable. Each frame has the header of virtio in front, so that checksums that the kernel leaves to
// the hardware are made when the frame is sent on.
int open_end(const std::string& interface) {
  const int descriptor = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_ALL));
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "packet socket");
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  packet_mreq all{};
  all.mr_ifindex = address.sll_ifindex;
  all.mr_type = PACKET_MR_PROMISC;
  const int on = 1;
  if (::setsockopt(descriptor, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof on) != 0 ||
      ::setsockopt(descriptor, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0 ||
      ::setsockopt(descriptor, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &all, sizeof all) != 0 ||
      ::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, &kBufferBytes, sizeof kBufferBytes) != 0 ||
      ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const int error = errno;
    ::close(descriptor);
    throw std::system_error(error, std::generic_category(), interface);
  }
  return descriptor;
}

// From or to that address.
bool concerns(const Bytes& frame, std::uint32_t address) {
  constexpr std::size_t kEthernet = 10;  // behind the header of virtio
  constexpr std::size_t kIp = kEthernet + ETH_HLEN;
  if (frame.size() < kIp + 20 || frame[kIp - 2] != 0x08 || frame[kIp - 1] != 0x00) return false;
  for (const std::size_t at : {kIp + 12, kIp + 16}) {  // source, destination
    if (std::memcmp(frame.data() + at, &address, sizeof address) == 0) return true;
  }
  return false;
}

struct Frame {
  Clock::time_point due;
  std::uint64_t number = 0;  // in the order of arrival at the relay
  std::size_t direction = 0;
  Bytes bytes;
};
struct DueLater {
  bool operator()(const Frame& a, const Frame& b) const {
    return a.due != b.due ? a.due > b.due : a.number > b.number;
  }
};

}  // namespace

// Frames under way.
class NetworkRelay::Cable {
 public:
  explicit Cable(const CableConditions& conditions) : conditions_(conditions), random_(conditions.seed) {}

  // Returns true if the frame is duplicated.
  bool enter(std::size_t direction, Bytes bytes, Clock::time_point now) {
    const bool twice = std::bernoulli_distribution(conditions_.duplicated)(random_);
    const double delay_s = conditions_.delay_s + conditions_.jitter_s * (2.0 * unit() - 1.0);
    if (twice) push(direction, bytes, now, delay_s + conditions_.jitter_s * unit());
    push(direction, std::move(bytes), now, delay_s);
    return twice;
  }
  bool empty() const { return frames_.empty(); }
  const Frame& next() const { return frames_.top(); }
  void pop() { frames_.pop(); }

 private:
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  void push(std::size_t direction, Bytes bytes, Clock::time_point now, double delay_s) {
    const auto delay = std::chrono::duration<double>(std::max(0.0, delay_s));
    frames_.push(
        {now + std::chrono::duration_cast<Clock::duration>(delay), ++count_, direction, std::move(bytes)});
  }

  const CableConditions conditions_;
  std::mt19937_64 random_;
  std::uint64_t count_ = 0;
  std::priority_queue<Frame, std::vector<Frame>, DueLater> frames_;
};

NetworkRelay::NetworkRelay(const HostNetwork& network, int host, const CableConditions& conditions)
    : conditions_(conditions) {
  const std::string port = "port" + std::to_string(host);
  const std::string inner = "inner" + std::to_string(host);
  const std::string outer = "outer" + std::to_string(host);
  network.run(HostNetwork::kCentre, "ip link add " + inner + " type veth peer name " + outer +
                                        " && ip link set " + port + " nomaster && ip link set " + outer +
                                        " master switch && ip link set " + inner + " up && ip link set " +
                                        outer + " up");
  {
    const HostNetwork::Inside inside(network, HostNetwork::kCentre);
    host_end_ = open_end(port);
    try {
      switch_end_ = open_end(inner);
    } catch (...) {
      ::close(host_end_);
      throw;
    }
  }
  thread_ = std::thread([this] {
    runtime::make_this_thread_realtime({true, kPriority, -1});
    run(host_end_, switch_end_);
  });
}

NetworkRelay::~NetworkRelay() {
  stop_ = true;
  thread_.join();
  ::close(host_end_);
  ::close(switch_end_);
}

void NetworkRelay::block(const std::string& address, std::chrono::milliseconds duration) {
  blocked_for_ = duration;
  blocked_ = ::inet_addr(address.c_str());
}

void NetworkRelay::run(int host_end, int switch_end) {
  Cable cable(conditions_);
  const std::array<int, 2> ends{host_end, switch_end};
  std::array<std::uint64_t, 2> newest{};  // number of the newest frame sent on, for each direction
  Bytes buffer(kLongestFrame);
  bool is_blocked = false;
  Clock::time_point unblocked;  // when the block ends
  while (!stop_) {
    auto wait = std::chrono::duration_cast<std::chrono::nanoseconds>(kPoll);
    if (!cable.empty())
      wait = std::clamp<std::chrono::nanoseconds>(cable.next().due - Clock::now(), wait * 0, wait);
    const timespec timeout{0, wait.count()};
    std::array<pollfd, 2> polled{pollfd{host_end, POLLIN, 0}, pollfd{switch_end, POLLIN, 0}};
    ::ppoll(polled.data(), polled.size(), &timeout, nullptr);
    for (std::size_t from = 0; from < ends.size(); ++from) {
      for (ssize_t size; (size = ::recv(ends[from], buffer.data(), buffer.size(), 0)) > 0;) {
        Bytes frame(buffer.begin(), buffer.begin() + size);
        const auto now = Clock::now();
        if (!is_blocked && blocked_ != 0) unblocked = now + blocked_for_.load();
        is_blocked = blocked_ != 0;
        if (is_blocked && now >= unblocked) {
          blocked_ = 0;
          is_blocked = false;
        }
        if (is_blocked && concerns(frame, blocked_)) continue;
        if (cable.enter(1 - from, std::move(frame), now)) ++duplicated_;
      }
    }
    for (const auto now = Clock::now(); !cable.empty() && cable.next().due <= now; cable.pop()) {
      const Frame& frame = cable.next();
      if (frame.number < newest[frame.direction]) ++overtaken_;
      newest[frame.direction] = std::max(newest[frame.direction], frame.number);
      // A full queue loses the frame, as a switch does.
      (void)::send(ends[frame.direction], frame.bytes.data(), frame.bytes.size(), 0);
    }
  }
}

}  // namespace swiftlet::tests
