#include "swiftlet/services/mocap/sources/replay_source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <thread>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::mocap {
namespace {

using io::ConfigError;

const std::vector<std::string> kColumns = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};

// Its header begins with t, whatever program wrote it.
bool is_table(const std::string& text) {
  const std::string_view begin = io::trimmed(std::string_view(text).substr(0, 8), "\xef\xbb\xbf\" ");
  return begin.size() > 1 && begin.front() == 't' &&
         std::string_view(",;\t\"").find(begin[1]) != std::string_view::npos;
}

// The servers whose descriptions were captured.
std::set<std::uint32_t> servers_in(const std::vector<CapturedDatagram>& datagrams) {
  std::set<std::uint32_t> servers;
  for (const CapturedDatagram& datagram : datagrams) {
    NatNetSession session;
    if (session.take(datagram.payload.data(), datagram.payload.size(), 0) == NatNetSession::Event::kServer)
      servers.insert(datagram.source);
  }
  return servers;
}

std::uint32_t only_server(const std::set<std::uint32_t>& servers, const std::string& wanted,
                          const std::string& file) {
  if (servers.empty()) throw ConfigError(file, 0, "", "has no description of a NatNet server");
  if (wanted.empty() && servers.size() == 1) return *servers.begin();
  std::string list;
  for (const std::uint32_t server : servers)
    list += (list.empty() ? "" : ", ") + io::Endpoint{server, 0}.address_text();
  if (wanted.empty())
    throw ConfigError(file, 0, "", "has several NatNet servers, choose one with --server: " + list);
  const std::uint32_t address = io::resolve(wanted, natnet::kCommandPort).address;
  if (servers.count(address) == 0)
    throw ConfigError(file, 0, "", "has no description of the server " + wanted + ", only of " + list);
  return address;
}

}  // namespace

ReplaySource::ReplaySource(const Room& room)
    : file_(room.file), latency_ns_(static_cast<std::int64_t>(1e9 * room.latency_s)) {
  const std::string text = io::read_text_file(room.file);
  if (is_table(text)) {
    read_table(text, room.file);
  } else {
    read_capture(text, room.file, room.server);
  }
  if (recorded_.empty()) throw ConfigError(room.file, 0, "", "has no frame");
  const std::int64_t first_ns = recorded_.front().arrived_ns;
  for (Recorded& frame : recorded_) {
    frame.arrived_ns -= first_ns;
    frame.exposed_ns -= first_ns + latency_ns_;
  }
}

std::string ReplaySource::description() const {
  return file_ + ": " + std::to_string(recorded_.size()) + " frames";
}

bool ReplaySource::receive(SourceFrame& frame, std::chrono::milliseconds timeout) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (!start_ns_) start_ns_ = now_ns;
  const std::int64_t end_ns = now_ns + std::chrono::nanoseconds(timeout).count();
  const std::int64_t due_ns = has_ended() ? end_ns : *start_ns_ + recorded_[next_].arrived_ns;
  std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(due_ns, end_ns) - now_ns));
  if (has_ended() || due_ns > end_ns) return false;
  const Recorded& recorded = recorded_[next_++];
  ++statistics_.frames;
  frame.arrived_ns = due_ns;
  frame.exposed_ns = *start_ns_ + recorded.exposed_ns;
  frame.is_complete = true;
  frame.poses = recorded.poses;
  return true;
}

// Frames may have been captured before the definitions of their bodies.
void ReplaySource::read_capture(const std::string& text, const std::string& file, const std::string& server) {
  std::vector<CapturedDatagram> datagrams = parse_capture(text, file);
  const std::uint32_t address = only_server(servers_in(datagrams), server, file);
  datagrams.erase(
      std::remove_if(datagrams.begin(), datagrams.end(),
                     [&](const CapturedDatagram& datagram) { return datagram.source != address; }),
      datagrams.end());
  NatNetSession definitions;
  for (const CapturedDatagram& datagram : datagrams) {
    if (definitions.take(datagram.payload.data(), datagram.payload.size(), 0) !=
        NatNetSession::Event::kModels)
      continue;
    for (const natnet::BodyDefinition& model : definitions.models()) body_of(model.name, model.id);
  }
  NatNetSession session;
  for (const CapturedDatagram& datagram : datagrams) {
    const auto event = session.take(datagram.payload.data(), datagram.payload.size(), 0);
    if (event == NatNetSession::Event::kFrame) add_frame(session, datagram.time_ns);
    if (event == NatNetSession::Event::kLate) ++statistics_.late;
    if (event == NatNetSession::Event::kRefused) refuse(session.refusal());
  }
  statistics_.lost = session.lost();
}

void ReplaySource::add_frame(const NatNetSession& session, std::int64_t arrived_ns) {
  Recorded recorded;
  recorded.arrived_ns = arrived_ns;
  recorded.exposed_ns = arrived_ns - session.server_latency_ns();
  for (const natnet::RigidBody& body : session.frame().bodies) {
    const auto known =
        std::find_if(bodies().begin(), bodies().end(), [&](const Body& one) { return one.id == body.id; });
    if (known == bodies().end()) continue;
    recorded.poses.push_back({static_cast<std::size_t>(known - bodies().begin()), body.tracked, body.position,
                              body.q_room_from_body.normalized(), body.markers, body.lost_markers});
  }
  recorded_.push_back(std::move(recorded));
}

void ReplaySource::read_table(const std::string& text, const std::string& file) {
  const io::Table table = io::parse_csv(text, file, kColumns);
  const std::size_t body = *body_of(std::filesystem::path(file).stem().string(), 0);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    Recorded recorded;
    const double time_s = table.number(row, 0, io::between(0.0, 4e9), "s") - table.number(0, 0);
    if (row > 0 && table.number(row, 0) <= table.number(row - 1, 0)) table.fail(row, "t", "must increase");
    recorded.arrived_ns = std::llround(1e9 * time_s);
    recorded.exposed_ns = recorded.arrived_ns;
    const Eigen::Vector3d position(table.number(row, 1), table.number(row, 2), table.number(row, 3));
    const Eigen::Quaterniond attitude(table.number(row, 7), table.number(row, 4), table.number(row, 5),
                                      table.number(row, 6));
    if (std::abs(attitude.norm() - 1.0) > 1e-3) table.fail(row, "qx..qw", "is not of unit length");
    recorded.poses.push_back({body, true, position, attitude.normalized(), 0, 0});
    recorded_.push_back(std::move(recorded));
  }
}

}  // namespace swiftlet::mocap
