#include "swiftlet/ground/cli/network/network_probe.hpp"

#include <algorithm>
#include <climits>
#include <map>
#include <netinet/in.h>
#include <set>
#include <sstream>
#include <sys/socket.h>
#include <unistd.h>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/clocks/clock_filter.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::ground {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr const char* kGroup = "239.255.0.1";
constexpr const char* kProbeMagic = "swiftlet-probe-2";
constexpr auto kPeriod = 50ms;
constexpr auto kLastAnswers = 300ms;
constexpr std::size_t kMaxPartners = 256;

enum class Kind : char { kMulticast = 'm', kUnicast = 'u', kAnswer = 'a', kGoodbye = 'g' };

// One datagram, as text: "swiftlet-probe-2 KIND SENDER HOST NUMBER ...".
struct Message {
  Kind kind = Kind::kUnicast;
  std::uint64_t sender = 0;  // a random number of each run
  std::string host;
  int number = 0;
  // Only in an answer: who asked, the kind of the question, when it was received, and when it was answered.
  std::uint64_t asker = 0;
  Kind of = Kind::kUnicast;
  std::int64_t received_ns = 0;
  std::int64_t answered_ns = 0;
  std::string via;  // of multicast: the address of the sending interface
};

std::string to_text(const Message& message) {
  std::ostringstream text;
  text << kProbeMagic << ' ' << static_cast<char>(message.kind) << ' ' << message.sender << ' '
       << message.host << ' ' << message.number;
  if (message.kind == Kind::kMulticast) text << ' ' << message.via;
  if (message.kind == Kind::kAnswer)
    text << ' ' << message.asker << ' ' << static_cast<char>(message.of) << ' ' << message.received_ns << ' '
         << message.answered_ns;
  return text.str();
}

// A name that is printed has no control characters.
bool is_printable_name(const std::string& name) {
  return name.size() <= HOST_NAME_MAX &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c > 0x20 && c < 0x7f; });
}

bool from_text(const std::string& datagram, Message& message) {
  std::istringstream text(datagram);
  std::string magic;
  char kind = 0;
  if (!(text >> magic >> kind >> message.sender >> message.host >> message.number) || magic != kProbeMagic)
    return false;
  if (!is_printable_name(message.host)) return false;
  message.kind = static_cast<Kind>(kind);
  if (message.kind == Kind::kUnicast || message.kind == Kind::kGoodbye) return true;
  if (message.kind == Kind::kMulticast) return static_cast<bool>(text >> message.via);
  char of = 0;
  if (message.kind != Kind::kAnswer) return false;
  if (!(text >> message.asker >> of >> message.received_ns >> message.answered_ns)) return false;
  message.of = static_cast<Kind>(of);
  return true;
}

std::int64_t ns(Clock::time_point time) { return std::chrono::nanoseconds(time.time_since_epoch()).count(); }

// A datagram of another program is a message without a host.
Message message_of(const std::vector<std::uint8_t>& datagram) {
  Message message;
  if (!from_text({datagram.begin(), datagram.end()}, message)) message.host.clear();
  return message;
}

void send(const io::UdpSocket& socket, const Message& message, const io::Endpoint& to) {
  const std::string text = to_text(message);
  socket.send({text.begin(), text.end()}, to);
}

io::Endpoint endpoint_of(const std::string& ipv4, int port) {
  return {ntohl(io::socket_address(ipv4, 0).sin_addr.s_addr), static_cast<std::uint16_t>(port)};
}

// What is known of another host during the run.
struct Partner {
  ProbedHost host;
  io::Endpoint address{};
  std::map<int, Clock::time_point> asked;
  std::vector<double> round_trips_ms{};
  clocks::ClockFilter clock{};
  bool gone = false;
};

}  // namespace

struct NetworkProbe::Impl {
  Impl(int of_domain, const std::vector<std::string>& own, const std::vector<std::string>& asked)
      : domain(of_domain),
        addresses(own),
        peers(asked.begin(), asked.end()),
        direct("", static_cast<std::uint16_t>(probe_port(of_domain))),
        multicast("", static_cast<std::uint16_t>(probe_multicast_port(of_domain)), true) {
    own_id = runtime::random_id();
    char name[HOST_NAME_MAX + 1] = {};
    ::gethostname(name, HOST_NAME_MAX);
    host = name[0] == '\0' ? "unknown" : name;
    for (const std::string& address : addresses) {
      const ip_mreq group{io::socket_address(kGroup, 0).sin_addr, io::socket_address(address, 0).sin_addr};
      ::setsockopt(multicast.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
    }
  }

  Message own(Kind kind, int of) const {
    Message message;
    message.kind = kind;
    message.sender = own_id;
    message.host = host;
    message.number = of;
    return message;
  }

  void send_probes() {
    ++number;
    for (const std::string& address : addresses) {
      const in_addr out = io::socket_address(address, 0).sin_addr;
      ::setsockopt(direct.fd(), IPPROTO_IP, IP_MULTICAST_IF, &out, sizeof out);
      Message message = own(Kind::kMulticast, number);
      message.via = address;
      send(direct, message, endpoint_of(kGroup, probe_multicast_port(domain)));
    }
    for (const std::string& peer : peers)
      send(direct, own(Kind::kUnicast, 0), endpoint_of(peer, probe_port(domain)));
    for (auto& [id, partner] : partners) {
      if (partner.gone) continue;
      partner.asked[number] = Clock::now();
      ++partner.host.sent;
      send(direct, own(Kind::kUnicast, number), partner.address);
    }
  }

  void receive_for(std::chrono::milliseconds time) {
    const auto end = Clock::now() + time;
    for (auto left = time; left.count() > 0;
         left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now())) {
      io::wait_for_input({direct.fd(), multicast.fd()}, left);
      std::vector<std::uint8_t> datagram;
      for (const io::UdpSocket* const socket : {&direct, &multicast}) {
        while (const auto from = socket->receive(datagram)) take(message_of(datagram), *from);
      }
    }
  }

  void take(const Message& message, const io::Endpoint& from) {
    const Clock::time_point arrived = Clock::now();
    const std::int64_t received_ns = runtime::system_ns();
    if (message.host.empty()) return;
    if (message.sender == own_id) {
      if (message.kind == Kind::kMulticast) own_multicast.insert(message.via);
      return;
    }
    if (partners.size() >= kMaxPartners && partners.count(message.sender) == 0) return;
    Partner& partner = partners[message.sender];
    partner.host.name = message.host;
    partner.host.address = from.address_text();
    partner.address = from;
    if (message.kind == Kind::kAnswer) return take_answer(message, arrived, partner);
    if (message.kind == Kind::kGoodbye) return take_goodbye(partner);
    if (message.kind == Kind::kMulticast) partner.host.multicast_heard = true;
    Message answer = own(Kind::kAnswer, message.number);
    answer.asker = message.sender;
    answer.of = message.kind;
    answer.received_ns = received_ns;
    answer.answered_ns = runtime::system_ns();
    send(direct, answer, from);
  }

  void take_answer(const Message& message, Clock::time_point arrived, Partner& partner) {
    if (message.asker != own_id) return;
    if (message.of == Kind::kMulticast) partner.host.multicast_answered = true;
    const auto asked = partner.asked.find(message.number);
    if (message.of != Kind::kUnicast || asked == partner.asked.end()) return;
    partner.clock.add({ns(asked->second), message.received_ns, message.answered_ns, ns(arrived)});
    partner.round_trips_ms.push_back(1e-6 * static_cast<double>(ns(arrived) - ns(asked->second)));
    partner.asked.erase(asked);
  }

  // Questions that the partner was asked just before it left do not count.
  static void take_goodbye(Partner& partner) {
    if (partner.gone) return;
    partner.gone = true;
    const auto recent = Clock::now() - kLastAnswers;
    for (const auto& [of, time] : partner.asked) partner.host.sent -= time > recent ? 1 : 0;
  }

  // Several times, as one may be lost.
  void say_goodbye() const {
    for (int i = 0; i < 3; ++i) {
      for (const auto& [id, partner] : partners) send(direct, own(Kind::kGoodbye, 0), partner.address);
    }
  }

  ProbeReport report() {
    ProbeReport result;
    result.own_multicast.assign(own_multicast.begin(), own_multicast.end());
    std::set<std::string> silent = peers;
    for (auto& [id, partner] : partners) {
      std::vector<double>& times = partner.round_trips_ms;
      std::sort(times.begin(), times.end());
      partner.host.answered = static_cast<int>(times.size());
      if (!times.empty()) {
        partner.host.round_trip_min_ms = times.front();
        partner.host.round_trip_median_ms = times[times.size() / 2];
        partner.host.round_trip_max_ms = times.back();
      }
      report_clock(partner);
      silent.erase(partner.host.address);
      result.hosts.push_back(partner.host);
    }
    result.silent_peers.assign(silent.begin(), silent.end());
    return result;
  }

  // Measured against the monotonic clock of this host, reported against its system clock, which may have been set
  // meanwhile.
  static void report_clock(Partner& partner) {
    partner.host.clock_steps = partner.clock.steps();
    if (!partner.clock.estimate()) return;
    const clocks::ClockEstimate& clock = *partner.clock.estimate();
    const std::int64_t now_ns = ns(Clock::now());
    const std::int64_t own_offset_ns = runtime::system_ns() - now_ns;
    partner.host.clock_offset_ms = 1e-6 * static_cast<double>(clock.offset_at(now_ns) - own_offset_ns);
    partner.host.clock_uncertainty_ms = 1e-6 * clock.uncertainty_ns(now_ns);
    partner.host.clock_drift_ppm = 1e6 * clock.drift;
    partner.host.clock_drift_uncertainty_ppm = 2e6 * clock.drift_deviation;
  }

  const int domain;
  const std::vector<std::string> addresses;
  const std::set<std::string> peers;
  const io::UdpSocket direct;
  const io::UdpSocket multicast;
  std::uint64_t own_id = 0;
  std::string host;
  int number = 0;
  std::set<std::string> own_multicast;
  std::map<std::uint64_t, Partner> partners;
};

NetworkProbe::NetworkProbe(int domain, const std::vector<std::string>& addresses,
                           const std::vector<std::string>& peers)
    : impl_(std::make_unique<Impl>(domain, addresses, peers)) {}
NetworkProbe::~NetworkProbe() = default;

ProbeReport NetworkProbe::run(std::chrono::milliseconds time) {
  for (const auto end = Clock::now() + time; Clock::now() < end;) {
    impl_->send_probes();
    impl_->receive_for(kPeriod);
  }
  impl_->receive_for(kLastAnswers);
  impl_->say_goodbye();
  return impl_->report();
}

}  // namespace swiftlet::ground
