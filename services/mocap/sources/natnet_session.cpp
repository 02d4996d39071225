#include "swiftlet/services/mocap/sources/natnet_session.hpp"

#include <algorithm>

#include "swiftlet/io/text_file.hpp"

namespace swiftlet::mocap {
namespace {

using natnet::MessageId;

// A frame whose number is lower by at most this much was overtaken; one that is lower by more begins a new count: the server was
// restarted, or plays a recording in a loop.
constexpr std::int32_t kMostLate = 100;
// Longest time of a server's clock, s: sums of two in ns fit into 64 bits.
constexpr std::uint64_t kLatestSecond = 4'000'000'000;
constexpr std::int64_t kLongestLatencyNs = 1'000'000'000;

bool are_same(const natnet::BodyDefinition& a, const natnet::BodyDefinition& b) {
  return a.id == b.id && a.name == b.name;
}

bool are_same(const natnet::ServerInfo& a, const natnet::ServerInfo& b) {
  return a.application == b.application && a.version == b.version && a.clock_hz == b.clock_hz &&
         a.data_port == b.data_port && a.multicast == b.multicast && a.group == b.group;
}

}  // namespace

std::string to_string(const natnet::ServerInfo& server) {
  return io::printable(server.application) + " " + server.application_version.to_string() + " (NatNet " +
         server.version.to_string() + ")";
}

NatNetSession::Event NatNetSession::take(const std::uint8_t* data, std::size_t size,
                                         std::int64_t arrived_ns) {
  const auto message = natnet::parse_message(data, size);
  if (!message) return refuse("a datagram is none of NatNet, or cut");
  switch (message->id) {
    case MessageId::kServerInfo:
      return take_server(message->payload);
    case MessageId::kModels:
      return take_models(message->payload);
    case MessageId::kFrame:
      return take_frame(message->payload);
    case MessageId::kEchoResponse:
      return take_echo(message->payload, arrived_ns);
    default:
      return Event::kNothing;
  }
}

bool NatNetSession::can_read() const { return server_ && server_->version.is_supported(); }

NatNetSession::Event NatNetSession::take_server(const io::ByteReader& payload) {
  natnet::ServerInfo info;
  if (const char* const fault = natnet::parse_server_info(payload, info)) return refuse(fault);
  const bool has_changed = !server_ || !are_same(*server_, info);
  server_ = std::move(info);
  if (!has_changed) return Event::kNothing;
  needs_models_ = true;
  clock_.forget();
  return Event::kServer;
}

NatNetSession::Event NatNetSession::take_models(const io::ByteReader& payload) {
  if (!can_read()) return Event::kNothing;
  std::vector<natnet::BodyDefinition> models;
  if (const char* const fault = natnet::parse_models(payload, server_->version, models)) return refuse(fault);
  needs_models_ = false;
  const bool has_changed = !std::equal(models.begin(), models.end(), models_.begin(), models_.end(),
                                       [](const auto& a, const auto& b) { return are_same(a, b); });
  models_ = std::move(models);
  return has_changed ? Event::kModels : Event::kNothing;
}

NatNetSession::Event NatNetSession::take_frame(const io::ByteReader& payload) {
  if (!can_read()) return Event::kNothing;
  if (const char* const fault = natnet::parse_frame(payload, server_->version, incoming_))
    return refuse(fault);
  if (!follows(incoming_.number)) return Event::kLate;
  std::swap(frame_, incoming_);
  if (frame_.models_changed || !knows_all_bodies()) needs_models_ = true;
  return Event::kFrame;
}

NatNetSession::Event NatNetSession::take_echo(const io::ByteReader& payload, std::int64_t arrived_ns) {
  natnet::EchoResponse response;
  if (const char* const fault = natnet::parse_echo_response(payload, response)) return refuse(fault);
  if (!can_read() || response.received_ticks / server_->clock_hz > kLatestSecond) return Event::kNothing;
  const auto asked_ns = static_cast<std::int64_t>(response.request);
  if (asked_ns < 0 || asked_ns > arrived_ns) return Event::kNothing;  // no question of ours
  clock_.add(asked_ns, ns(response.received_ticks), arrived_ns);
  return Event::kEcho;
}

NatNetSession::Event NatNetSession::refuse(const char* why) {
  refusal_ = why;
  return Event::kRefused;
}

bool NatNetSession::follows(std::int32_t number) {
  if (last_number_) {
    const std::int64_t step = std::int64_t{number} - *last_number_;
    if (step <= 0 && step > -kMostLate) return false;
    if (step > 1) lost_ += static_cast<std::uint64_t>(step - 1);
  }
  last_number_ = number;
  return true;
}

bool NatNetSession::knows_all_bodies() const {
  return std::all_of(frame_.bodies.begin(), frame_.bodies.end(), [this](const natnet::RigidBody& body) {
    return std::any_of(models_.begin(), models_.end(),
                       [&](const natnet::BodyDefinition& model) { return model.id == body.id; });
  });
}

std::int64_t NatNetSession::ns(std::uint64_t ticks) const {
  const std::uint64_t hz = server_->clock_hz;
  const double rest_s = static_cast<double>(ticks % hz) / static_cast<double>(hz);
  return static_cast<std::int64_t>(ticks / hz * 1'000'000'000) + static_cast<std::int64_t>(1e9 * rest_s);
}

std::int64_t NatNetSession::server_latency_ns() const {
  if (!can_read() || frame_.exposed_ticks == 0 || frame_.exposed_ticks > frame_.sent_ticks) return 0;
  const double latency_s =
      static_cast<double>(frame_.sent_ticks - frame_.exposed_ticks) / static_cast<double>(server_->clock_hz);
  return latency_s > 1e-9 * kLongestLatencyNs ? 0 : static_cast<std::int64_t>(1e9 * latency_s);
}

std::optional<std::int64_t> NatNetSession::exposed_ns(std::int64_t arrived_ns, bool by_arrival) const {
  const std::int64_t latency_ns = server_latency_ns();
  if (latency_ns == 0) return std::nullopt;
  if (clock_.is_known()) {
    if (frame_.exposed_ticks / server_->clock_hz > kLatestSecond) return std::nullopt;
    return clock_.to_host(ns(frame_.exposed_ticks), arrived_ns);
  }
  if (!by_arrival) return std::nullopt;
  return arrived_ns - latency_ns;
}

void NatNetSession::forget_order() {
  last_number_.reset();
  needs_models_ = true;
}

}  // namespace swiftlet::mocap
