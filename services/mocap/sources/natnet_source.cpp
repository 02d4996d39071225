#include "swiftlet/services/mocap/sources/natnet_source.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::mocap {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kAskPeriod = 500ms;       // while nothing comes
constexpr auto kModelsPeriod = 500ms;    // until the definitions are those of the frames
constexpr auto kEchoPeriod = 50ms;       // as the requests of the vehicle's clock
constexpr auto kFirstEchoPeriod = 10ms;  // while the clock is unknown
constexpr auto kKeepAlivePeriod = 1s;    // of unicast; servers give up after 5 s
constexpr auto kNatNetSilence = 1s;      // then the server is asked to connect again
constexpr auto kSearchTime = 500ms;
// So many questions without an answer: the server does not answer them at all.
constexpr int kUnansweredEchoes = 100;
// Layouts that a server of 4.x is asked for.
constexpr natnet::Version kWanted{4, 1};

std::string text_of(const std::array<std::uint8_t, 4>& group) {
  std::string text;
  for (const std::uint8_t byte : group) text += (text.empty() ? "" : ".") + std::to_string(byte);
  return text;
}

bool is_due(Clock::time_point now, Clock::time_point& due, Clock::duration period) {
  if (now < due) return false;
  due = now + period;
  return true;
}

io::Endpoint server_of(const Room& room) {
  if (!room.server.empty()) return io::resolve(room.server, natnet::kCommandPort);
  const io::Endpoint everyone{0xffffffff, natnet::kCommandPort};
  return only_server(find_natnet_servers({everyone}, io::interface_address(room.interface), kSearchTime)).at;
}

std::string name_of(const FoundServer& server) {
  return to_string(server.info) + " at " + server.at.address_text();
}

}  // namespace

std::vector<FoundServer> find_natnet_servers(const std::vector<io::Endpoint>& addresses,
                                             const std::string& interface, std::chrono::milliseconds time) {
  const io::UdpSocket socket(interface, 0);
  std::vector<FoundServer> found;
  std::vector<std::uint8_t> datagram;
  const auto end = Clock::now() + time;
  Clock::time_point due;
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    if (is_due(now, due, kSearchTime / 2)) {
      for (const io::Endpoint& address : addresses) socket.send(natnet::discovery_request(kWanted), address);
    }
    io::wait_for_input({socket.fd()}, std::chrono::ceil<std::chrono::milliseconds>(std::min(due, end) - now));
    while (const auto from = socket.receive(datagram)) {
      NatNetSession session;
      if (session.take(datagram.data(), datagram.size(), 0) != NatNetSession::Event::kServer) continue;
      const bool is_known = std::any_of(found.begin(), found.end(), [&](const FoundServer& server) {
        return server.at.address == from->address && server.at.port == from->port;
      });
      if (!is_known) found.push_back({*from, *session.server()});
    }
  }
  return found;
}

FoundServer only_server(const std::vector<FoundServer>& servers) {
  if (servers.empty())
    throw std::runtime_error(
        "no NatNet server answers a broadcast; name it with --server or in the room file");
  if (servers.size() == 1) return servers.front();
  std::string list;
  for (const FoundServer& server : servers) list += (list.empty() ? "" : ", ") + name_of(server);
  throw std::runtime_error(std::to_string(servers.size()) + " NatNet servers answer: " + list +
                           "; choose one with --server or in the room file");
}

NatNetSource::NatNetSource(const Room& room)
    : interface_(io::interface_address(room.interface)),
      latency_ns_(static_cast<std::int64_t>(1e9 * room.latency_s)),
      server_(server_of(room)),
      commands_(interface_, 0),
      silent_since_(Clock::now()) {}

std::string NatNetSource::description() const {
  if (!session_.server()) return "NatNet at " + server_.to_string() + " does not answer";
  return to_string(*session_.server()) + " at " + server_.to_string() +
         (session_.server()->multicast ? ", multicast" : ", unicast");
}

bool NatNetSource::receive(SourceFrame& frame, std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  do {
    if (has_new_server_) meet_server();
    ask(Clock::now());
    if (data_ && read(*data_, frame)) return true;
    if (read(commands_, frame)) return true;
    const auto next = std::min({end, connect_due_, echo_due_});
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now());
    io::wait_for_input({commands_.fd(), data_ ? data_->fd() : -1}, std::max(wait, 1ms));
  } while (Clock::now() < end);
  return false;
}

void NatNetSource::ask(Time now) {
  if (!is_met_ || now - silent_since_ > kNatNetSilence) {
    if (is_due(now, connect_due_, kAskPeriod)) {
      commands_.send(natnet::connect_request(kWanted), server_);
      session_.forget_order();
    }
  } else {
    connect_due_ = now + kAskPeriod;
  }
  if (!is_met_) {
    echo_due_ = connect_due_;
    return;
  }
  if (session_.needs_models() && is_due(now, models_due_, kModelsPeriod))
    commands_.send(natnet::models_request(), server_);
  if (!session_.server()->multicast && is_due(now, keep_alive_due_, kKeepAlivePeriod))
    commands_.send(natnet::keep_alive(), server_);
  if (is_due(now, echo_due_, session_.clock().is_known() ? kEchoPeriod : kFirstEchoPeriod)) {
    commands_.send(natnet::echo_request(static_cast<std::uint64_t>(runtime::monotonic_ns())), server_);
    if (++unanswered_echoes_ == kUnansweredEchoes)
      runtime::log_warning("{} does not answer echo requests: frames are stamped by their arrival",
                           description());
  }
}

bool NatNetSource::read(const io::UdpSocket& socket, SourceFrame& frame) {
  while (const auto from = socket.receive(datagram_)) {
    const std::int64_t arrived_ns = runtime::monotonic_ns();
    if (from->address != server_.address) {
      ++statistics_.strangers;
      if (statistics_.strangers == 1)
        runtime::log_warning("frames of another server, {}, are left out; {} is used", from->address_text(),
                             server_.to_string());
      continue;
    }
    if (take(arrived_ns, frame)) return true;
  }
  return false;
}

bool NatNetSource::take(std::int64_t arrived_ns, SourceFrame& frame) {
  switch (session_.take(datagram_.data(), datagram_.size(), arrived_ns)) {
    case NatNetSession::Event::kServer:
      has_new_server_ = true;  // which may replace the socket that is being read
      return false;
    case NatNetSession::Event::kModels: {
      std::vector<Body> bodies;
      for (const natnet::BodyDefinition& model : session_.models()) bodies.push_back({model.name, model.id});
      set_bodies(std::move(bodies));
      return false;
    }
    case NatNetSession::Event::kEcho:
      unanswered_echoes_ = 0;
      return false;
    case NatNetSession::Event::kRefused:
      refuse(session_.refusal());
      return false;
    case NatNetSession::Event::kLate:
      ++statistics_.late;
      return false;
    case NatNetSession::Event::kNothing:
      return false;
    case NatNetSession::Event::kFrame:
      break;
  }
  fill(frame, arrived_ns);
  return true;
}

void NatNetSource::meet_server() {
  has_new_server_ = false;
  const natnet::ServerInfo& info = *session_.server();
  if (!info.version.is_supported())
    throw std::runtime_error(description() + ": NatNet " + info.version.to_string() +
                             " is not supported, 3.0 to 4.x are");
  runtime::log_info("motion capture: {}", description());
  data_.reset();
  if (info.multicast) {
    data_.emplace("", info.data_port, true);
    data_->join(text_of(info.group), interface_);
  }
  is_met_ = true;
  unanswered_echoes_ = 0;
  models_due_ = echo_due_ = keep_alive_due_ = {};
  silent_since_ = Clock::now();
}

void NatNetSource::fill(SourceFrame& frame, std::int64_t arrived_ns) {
  const Time now = Clock::now();
  if (statistics_.frames > 0 && now - silent_since_ > kNatNetSilence) ++statistics_.restarts;
  silent_since_ = now;
  ++statistics_.frames;
  statistics_.lost = session_.lost();
  frame.arrived_ns = arrived_ns;
  frame.exposed_ns = session_.exposed_ns(arrived_ns, unanswered_echoes_ >= kUnansweredEchoes);
  // Without stamps of the exposure, such as of a recording that Motive plays.
  if (!frame.exposed_ns && session_.server_latency_ns() == 0) frame.exposed_ns = arrived_ns;
  if (frame.exposed_ns) *frame.exposed_ns -= latency_ns_;
  frame.is_complete = true;
  frame.poses.clear();
  for (const natnet::RigidBody& body : session_.frame().bodies) {
    const auto model = std::find_if(bodies().begin(), bodies().end(),
                                    [&](const Body& known) { return known.id == body.id; });
    if (model == bodies().end()) continue;
    frame.poses.push_back({static_cast<std::size_t>(model - bodies().begin()), body.tracked, body.position,
                           body.q_room_from_body.normalized(), body.markers, body.lost_markers});
  }
}

}  // namespace swiftlet::mocap
