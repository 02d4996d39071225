#include "swiftlet/services/mocap/sources/vrpn_source.hpp"

#include <algorithm>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::mocap {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kConnectPeriod = 500ms;
constexpr auto kConnectPoll = 5ms;  // whether the server has accepted
constexpr auto kVrpnSilence = 3s;   // without any message, although pings are sent: the connection is dead
constexpr auto kPingPeriod = 50ms;
constexpr auto kFirstPingPeriod = 10ms;  // while the clock is unknown
constexpr auto kLongestPing = 1s;
constexpr int kUnansweredPings = 3;  // then the server answers none
// A pose that is older than the last of its tracker by at most this was overtaken; one that is older by more shows that the
// server's clock was set.
constexpr std::int64_t kMostLateNs = 1'000'000'000;
constexpr std::size_t kMostNames = 4000;
constexpr const char* kControl = "VRPN Control";  // sender of the server itself: answers no pings

// Our numbers of the types.
enum OwnType : std::int32_t { kOwnPose, kOwnPing, kOwnPong };

void describe(vrpn::Bytes& out, std::int32_t kind, std::int32_t number, const char* name) {
  const vrpn::Bytes bytes = vrpn::description(kind, number, name);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

VrpnSource::VrpnSource(const Room& room)
    : latency_ns_(static_cast<std::int64_t>(1e9 * room.latency_s)),
      server_(io::resolve(room.server, vrpn::kPort)),
      udp_(io::interface_address(room.interface), 0) {}

std::string VrpnSource::description() const {
  const std::string name = "VRPN at " + server_.to_string();
  if (stage_ == Stage::kConnected) return name;
  return name + (fault_.empty() ? " does not answer" : ": " + fault_);
}

bool VrpnSource::receive(SourceFrame& frame, std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  do {
    const auto now = Clock::now();
    connect_if_due(now);
    advance(now);
    if (stage_ == Stage::kConnected) {
      ping_if_due(now);
      if (read_tcp(frame) || read_udp(frame)) return true;
    }
    io::wait_for_input(
        {udp_.fd(), tcp_.fd()},
        std::max(std::chrono::ceil<std::chrono::milliseconds>(std::min(end, due()) - Clock::now()), 1ms));
  } while (Clock::now() < end);
  return false;
}

VrpnSource::Time VrpnSource::due() const {
  switch (stage_) {
    case Stage::kClosed:
      return connect_due_;
    case Stage::kConnecting:
      return Clock::now() + kConnectPoll;
    case Stage::kConnected:
      if (tracker_ && !pinged_ns_) return ping_due_;
      break;
    case Stage::kCookie:
      break;
  }
  return Time::max();
}

void VrpnSource::connect_if_due(Time now) {
  if (stage_ != Stage::kClosed || now < connect_due_) return;
  connect_due_ = now + kConnectPeriod;
  tcp_.connect(server_);
  stage_ = Stage::kConnecting;
  heard_ = now;
}

void VrpnSource::advance(Time now) {
  if (stage_ == Stage::kConnecting) {
    const io::TcpSocket::State state = tcp_.state();
    if (state == io::TcpSocket::State::kClosed) return lose("refuses the connection");
    if (state == io::TcpSocket::State::kOpen) {
      stage_ = Stage::kCookie;
      if (!tcp_.send(vrpn::cookie())) return lose("closed the connection");
    }
  }
  if (stage_ == Stage::kCookie) {
    if (!tcp_.receive(stream_)) return lose("closed the connection");
    if (stream_.size() >= vrpn::kCookieBytes && take_cookie()) begin();
  }
  if (stage_ != Stage::kClosed && now - heard_ > kVrpnSilence) lose("has been silent for 3 s");
}

bool VrpnSource::take_cookie() {
  if (const char* const fault = vrpn::fault_of_cookie(stream_.data())) {
    lose(fault);
    return false;
  }
  stream_begin_ = vrpn::kCookieBytes;
  return true;
}

// Tells the server where poses go and how we number what we send.
void VrpnSource::begin() {
  vrpn::Bytes out = vrpn::udp_description(tcp_.local_address(), udp_.port());
  describe(out, vrpn::kTypeDescription, kOwnPose, vrpn::kPoseType);
  describe(out, vrpn::kTypeDescription, kOwnPing, vrpn::kPingType);
  describe(out, vrpn::kTypeDescription, kOwnPong, vrpn::kPongType);
  if (!tcp_.send(out)) return lose("closed the connection");
  stage_ = Stage::kConnected;
  fault_.clear();
  if (was_connected_) ++statistics_.restarts;
  was_connected_ = true;
  runtime::log_info("motion capture: {}", description());
}

void VrpnSource::lose(const std::string& why) {
  if (why != fault_) runtime::log_warning("motion capture: VRPN at {}: {}", server_.to_string(), why);
  fault_ = why;
  tcp_.close();
  stage_ = Stage::kClosed;
  stream_.clear();
  stream_begin_ = 0;
  datagram_.clear();
  datagram_begin_ = 0;
  senders_.clear();
  types_.clear();
  last_stamps_.clear();
  tracker_.reset();
  last_sequence_ = 0;
  pinged_ns_.reset();
  unanswered_pings_ = 0;
  clock_.forget();
}

void VrpnSource::ping_if_due(Time now) {
  if (now < ping_due_ || !tracker_) return;
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (pinged_ns_ && now_ns - *pinged_ns_ < std::chrono::nanoseconds(kLongestPing).count()) return;
  if (pinged_ns_ && ++unanswered_pings_ == kUnansweredPings)
    runtime::log_warning("{} does not answer pings: poses are stamped by their arrival", description());
  ping_due_ = now + (clock_.is_known() ? kPingPeriod : kFirstPingPeriod);
  pinged_ns_ = now_ns;
  if (!tcp_.send(vrpn::message(runtime::system_ns(), *tracker_, kOwnPing, {}))) lose("closed the connection");
}

// Takes what has arrived before it reads more: however fast the server sends, the stream holds at most one read and a part of a
// message.
bool VrpnSource::read_tcp(SourceFrame& frame) {
  if (take_messages(stream_, stream_begin_, true, frame)) return true;
  if (stage_ != Stage::kConnected) return false;
  stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(stream_begin_));
  stream_begin_ = 0;
  if (!tcp_.receive(stream_)) {
    lose("closed the connection");
    return false;
  }
  return take_messages(stream_, stream_begin_, true, frame);
}

bool VrpnSource::read_udp(SourceFrame& frame) {
  do {
    if (take_messages(datagram_, datagram_begin_, false, frame)) return true;
    datagram_begin_ = 0;
    const auto from = udp_.receive(datagram_);
    if (!from) return false;
    if (from->address == server_.address) continue;
    ++statistics_.strangers;
    datagram_.clear();
  } while (true);
}

bool VrpnSource::take_messages(const std::vector<std::uint8_t>& bytes, std::size_t& begin, bool is_stream,
                               SourceFrame& frame) {
  vrpn::Message message;
  while (begin < bytes.size()) {
    const vrpn::Parsed parsed = vrpn::parse_message(bytes.data() + begin, bytes.size() - begin, message);
    if (parsed == vrpn::Parsed::kIncomplete && is_stream) return false;
    if (parsed != vrpn::Parsed::kMessage) {
      refuse("a message has an impossible length");
      begin = bytes.size();
      if (is_stream) lose("sent a message of impossible length");
      return false;
    }
    begin += message.bytes;
    heard_ = Clock::now();
    if (!is_stream) count_lost(message.sequence);
    if (take(message, frame)) return true;
  }
  return false;
}

void VrpnSource::count_lost(std::uint32_t sequence) {
  if (last_sequence_ != 0 && sequence > last_sequence_ + 1) statistics_.lost += sequence - last_sequence_ - 1;
  last_sequence_ = std::max(last_sequence_, sequence);
}

bool VrpnSource::take(const vrpn::Message& message, SourceFrame& frame) {
  if (message.type < 0) {
    take_description(message);
    return false;
  }
  const auto type = types_.find(message.type);
  if (type == types_.end()) return false;
  if (type->second == vrpn::kPongType) take_pong(message);
  return type->second == vrpn::kPoseType && take_pose(message, frame);
}

void VrpnSource::take_description(const vrpn::Message& message) {
  if (message.type != vrpn::kSenderDescription && message.type != vrpn::kTypeDescription) return;
  const auto name = vrpn::parse_description(message.payload);
  if (!name) return refuse("a description has no name");
  auto& names = message.type == vrpn::kSenderDescription ? senders_ : types_;
  if (names.size() >= kMostNames && names.count(message.sender) == 0) return refuse("more than 4000 names");
  names[message.sender] = *name;
  // The server numbers our senders by their names: pings go to the tracker with the same name.
  if (message.type != vrpn::kSenderDescription) return;
  tcp_.send(vrpn::description(message.type, message.sender, *name));
  if (!tracker_ && *name != kControl) tracker_ = message.sender;
}

void VrpnSource::take_pong(const vrpn::Message& message) {
  if (!pinged_ns_) return;
  clock_.add(*pinged_ns_, message.stamp_ns, runtime::monotonic_ns());
  pinged_ns_.reset();
  unanswered_pings_ = 0;
}

bool VrpnSource::take_pose(const vrpn::Message& message, SourceFrame& frame) {
  const std::int64_t arrived_ns = runtime::monotonic_ns();
  const auto sender = senders_.find(message.sender);
  if (sender == senders_.end()) return false;
  vrpn::Pose pose;
  if (const char* const fault = vrpn::parse_pose(message.payload, pose)) {
    refuse(fault);
    return false;
  }
  tracker_ = message.sender;
  const auto body = body_of(sender->second, pose.sensor);
  if (!body) {
    refuse("more than 1000 bodies");
    return false;
  }
  const auto last = last_stamps_.find(*body);
  if (last != last_stamps_.end() && message.stamp_ns <= last->second &&
      message.stamp_ns > last->second - kMostLateNs) {
    ++statistics_.late;
    return false;
  }
  last_stamps_[*body] = message.stamp_ns;
  ++statistics_.frames;
  frame.arrived_ns = arrived_ns;
  frame.exposed_ns =
      unanswered_pings_ >= kUnansweredPings ? arrived_ns : clock_.to_host(message.stamp_ns, arrived_ns);
  if (frame.exposed_ns) *frame.exposed_ns -= latency_ns_;
  frame.is_complete = false;
  frame.poses.assign(1, {*body, true, pose.position, pose.q_room_from_body.normalized(), 0, 0});
  return true;
}

}  // namespace swiftlet::mocap
