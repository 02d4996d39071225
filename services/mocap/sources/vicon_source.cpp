#include "swiftlet/services/mocap/sources/vicon_source.hpp"

#include <algorithm>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::mocap {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kViconSilence = 1s;
// A frame whose number is lower by at most this much was overtaken; one that is lower by more begins a new count.
constexpr std::int64_t kMostLateFrames = 100;

std::optional<io::Endpoint> chosen_server(const Room& room) {
  if (room.server.empty()) return std::nullopt;
  return io::resolve(room.server, vicon::kPort);
}

}  // namespace

ViconSource::ViconSource(const Room& room)
    : latency_ns_(static_cast<std::int64_t>(1e9 * room.latency_s)),
      chosen_(chosen_server(room)),
      socket_(io::interface_address(room.interface), chosen_ ? chosen_->port : vicon::kPort) {}

std::string ViconSource::description() const {
  const std::string port = " on port " + std::to_string(socket_.port());
  if (server_) return "Vicon at " + server_->address_text() + port;
  return "Vicon" + (chosen_ ? " at " + chosen_->address_text() : std::string()) + port + " does not send";
}

bool ViconSource::receive(SourceFrame& frame, std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  do {
    while (const auto from = socket_.receive(datagram_)) {
      const std::int64_t arrived_ns = runtime::monotonic_ns();
      if (is_from_server(*from, Clock::now()) && take(arrived_ns, frame)) return true;
    }
    io::wait_for_input({socket_.fd()},
                       std::max(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()), 1ms));
  } while (Clock::now() < end);
  return false;
}

bool ViconSource::is_from_server(const io::Endpoint& from, Time now) {
  const bool is_silent = now - heard_ > kViconSilence;
  const bool is_server = chosen_   ? chosen_->address == from.address
                         : server_ ? server_->address == from.address || is_silent
                                   : true;
  if (!is_server) {
    ++statistics_.strangers;
    if (statistics_.strangers == 1)
      runtime::log_warning("frames of another server, {}, are left out; {} is used", from.address_text(),
                           description());
    return false;
  }
  if (server_ && is_silent) {
    ++statistics_.restarts;
    last_number_.reset();
  }
  server_ = from;
  heard_ = now;
  return true;
}

bool ViconSource::follows(std::uint32_t number) {
  if (last_number_) {
    const std::int64_t step = std::int64_t{number} - std::int64_t{*last_number_};
    if (step <= 0 && step > -kMostLateFrames) return false;
    if (step > 1) statistics_.lost += static_cast<std::uint64_t>(step - 1);
  }
  last_number_ = number;
  return true;
}

bool ViconSource::take(std::int64_t arrived_ns, SourceFrame& frame) {
  if (const char* const fault = vicon::parse_frame(datagram_.data(), datagram_.size(), frame_)) {
    refuse(fault);
    return false;
  }
  if (!follows(frame_.number)) {
    ++statistics_.late;
    return false;
  }
  ++statistics_.frames;
  frame.arrived_ns = arrived_ns;
  frame.exposed_ns = arrived_ns - latency_ns_;
  frame.is_complete = true;
  frame.poses.clear();
  for (const vicon::Object& object : frame_.objects) {
    if (const auto body = body_of(object.name, 0))
      frame.poses.push_back({*body, object.tracked, object.position, object.q_room_from_body, 0, 0});
  }
  return true;
}

}  // namespace swiftlet::mocap
