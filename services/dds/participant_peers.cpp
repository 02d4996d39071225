// What a participant knows of the other processes of its domain.
#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/io/text.hpp"
#include "swiftlet/services/dds/participant.hpp"
#include "swiftlet/services/dds/qos/qos_conflicts.hpp"
#include "swiftlet/services/messages/topic_table.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/rtps/key_rules.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::dds {
namespace {

std::string named(const std::string& name, const fastrtps::GuidPrefix_t& participant) {
  std::ostringstream text;
  text << "'" << name << "' (" << participant << ")";
  return text.str();
}

fastrtps::GUID_t participant_guid(const fastrtps::GuidPrefix_t& participant) {
  return {participant, fastrtps::c_EntityId_RTPSParticipant};
}

// By the last part of their names: "imu", "swiftlet_msgs::msg::dds_::Imu_".
std::map<std::string, std::string> types_of_topics() {
  std::map<std::string, std::string> types;
#define SWIFTLET_NOTE_TOPIC(Type, name, ...) types[name] = "swiftlet_msgs::msg::dds_::" #Type "_";
#define SWIFTLET_NOTE_TOPIC_OF(Type, Constant, ...) SWIFTLET_NOTE_TOPIC(Type, __VA_ARGS__)
  SWIFTLET_TOPICS(SWIFTLET_NOTE_TOPIC, SWIFTLET_NOTE_TOPIC_OF)
#undef SWIFTLET_NOTE_TOPIC
#undef SWIFTLET_NOTE_TOPIC_OF
  return types;
}

// What is wrong with an endpoint of a topic of Swiftlet, "has the type X, expected Y"; empty: nothing, or it is another topic.
std::string fault_of(const RemoteEndpoint& endpoint) {
  const std::string& topic = endpoint.topic;
  static const std::map<std::string, std::string> kTypes = types_of_topics();
  const bool is_of_ros = topic.rfind("rt/", 0) == 0;
  const std::string name = is_of_ros ? topic.substr(3) : topic;
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos || !messages::fault_of_vehicle_name(name.substr(0, slash)).empty())
    return {};
  const auto known = kTypes.find(name.substr(slash + 1));
  if (known == kTypes.end()) return {};
  if (!is_of_ros) return "has it without rt/, expected rt/" + topic;
  return endpoint.type == known->second ? "" : "has it as " + endpoint.type + ", expected " + known->second;
}

// Anybody may announce itself under any name: logs and terminals get no control characters of it.
std::string in_one_line(const std::string& name) {
  std::string line = io::printable(name);
  std::replace(line.begin(), line.end(), '\n', '?');
  return line;
}
}  // namespace

std::vector<std::string> Participant::Impl::topics_seen() const {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  std::set<std::string> topics;
  for (const auto& [guid, writer] : writers_) topics.insert(writer.topic);
  return {topics.begin(), topics.end()};
}

std::vector<ProcessIdentity> Participant::Impl::processes_seen() const {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  std::vector<ProcessIdentity> processes;
  for (const auto& [guid, peer] : peers_) processes.push_back(peer.identity());
  return processes;
}

std::vector<std::string> Participant::Impl::mismatches_seen() const {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  const auto process = [this](const Guid& guid) {
    const Peer* const peer = peer_of(guid.guidPrefix);
    return peer == nullptr ? "an unknown program" : peer->identity().to_string();
  };
  std::vector<std::string> sentences;
  for (const auto& [writer_guid, writer] : writers_) {
    for (const auto& [reader_guid, reader] : readers_) {
      if (writer.topic != reader.topic) continue;
      const std::string policies = conflicts(writer.qos, reader.qos);
      if (policies.empty()) continue;
      sentences.push_back(writer.topic + ": " + process(reader_guid) + " does not receive from " +
                          process(writer_guid) + ": " + policies);
    }
  }
  for (const RemoteEndpoints* const endpoints : {&writers_, &readers_}) {
    for (const auto& [guid, endpoint] : *endpoints) {
      const std::string fault = fault_of(endpoint);
      if (!fault.empty()) sentences.push_back(endpoint.topic + ": " + process(guid) + " " + fault);
    }
  }
  return sentences;
}

std::vector<std::string> Participant::Impl::refused_keys() const {
  const runtime::RealtimeScope scope = realtime();
  std::vector<std::string> sentences;
  for (const auto& [sender, rule] : guard_->refusals().last()) {
    const char* const remedy = rtps::remedy_of(rule);
    if (remedy == nullptr) continue;
    const std::string from = sender == 0 ? "several hosts" : io::to_string(sender);
    sentences.push_back("datagrams from " + from + " are refused, " + rule + "; " + remedy);
  }
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  for (const auto& [guid, name] : refused_)
    sentences.push_back(named(name, guid.guidPrefix) +
                        " is refused: it has no keys of this --security; the log of Fast DDS says more");
  return sentences;
}

ProcessIdentity Participant::Impl::identity_of(const fastrtps::GuidPrefix_t& participant) const {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  const Peer* const peer = peer_of(participant);
  return peer == nullptr ? ProcessIdentity() : peer->identity();
}

void Participant::Impl::listen(const Node* node, const std::string& vehicle,
                               std::function<void(const PeerEvent&)> callback) {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  peer_listeners_.erase(node);
  if (!callback) return;
  const PeerListener& listener = peer_listeners_[node] = {vehicle, std::move(callback)};
  for (const auto& [guid, peer] : peers_) {
    if (rtps::lists(peer.announced.vehicles, vehicle)) tell(listener, {peer.name, true, false});
  }
}

void Participant::Impl::on_participant(const Guid& guid, const std::string& name,
                                       const std::vector<std::uint8_t>& user_data) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  if (!introduced_at_ && rtps::is_discovery_server(bytes_of(guid.guidPrefix))) introduced_at_ = Clock::now();
  Peer peer{in_one_line(name), rtps::from_user_data(user_data)};
  peer.announced.host = in_one_line(peer.announced.host);
  if (settings.security.empty() || peers_.count(guid) > 0) return update_peer(guid, peer);
  strangers_[guid] = peer;
}

void Participant::Impl::on_participant_gone(const Guid& guid, bool said_goodbye) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  strangers_.erase(guid);
  refused_.erase(guid);
  drop_peer(guid, said_goodbye);
}

// Before or after its discovery. Fast DDS names who is refused by GUID only, and logs the reason without it.
void Participant::Impl::on_authentication(const Guid& guid, bool authenticated) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  if (!authenticated) {
    const std::string name = in_one_line(guard_->name_of(bytes_of(guid.guidPrefix)));
    refused_[guid] = name;
    log_.warn("refused " + named(name, guid.guidPrefix) + ": see the log of Fast DDS", Clock::now());
  } else if (peers_.count(guid) == 0) {
    update_peer(guid, strangers_[guid]);
    strangers_.erase(guid);
  }
}

// Ends the process if it throws: the transport below would take its exception for one of Fast DDS.
void Participant::Impl::tell(const PeerListener& listener, const PeerEvent& event) noexcept {
  listener.callback(event);
}

void Participant::Impl::update_peer(const Guid& guid, Peer peer) {
  const auto [known, is_new] = peers_.try_emplace(guid);
  if (is_new) {
    const auto lost = lost_.find(guid.guidPrefix);
    peer.endpoints = {Clock::now(), 0, lost == lost_.end() ? 0 : lost->second};
  } else {
    peer.endpoints = known->second.endpoints;
  }
  const Peer before = std::exchange(known->second, peer);
  for (const auto& [node, listener] : peer_listeners_) {
    const bool serves = rtps::lists(peer.announced.vehicles, listener.vehicle);
    if (serves != rtps::lists(before.announced.vehicles, listener.vehicle))
      tell(listener, {peer.name, serves, !serves});
  }
  yield_source_to(peer);
}

void Participant::Impl::drop_peer(const Guid& guid, bool said_goodbye) {
  for (RemoteEndpoints* const remote : {&writers_, &readers_}) {
    for (auto it = remote->begin(); it != remote->end();)
      it = it->first.guidPrefix == guid.guidPrefix ? remote->erase(it) : std::next(it);
  }
  const auto peer = peers_.find(guid);
  if (peer == peers_.end()) return;
  const Peer gone = peer->second;
  peers_.erase(peer);
  lost_.erase(guid.guidPrefix);
  if (!is_own(gone)) return;
  if (!said_goodbye) {
    if (lost_.size() >= rtps::kMostParticipants)
      lost_.clear();  // of those that were started again, as other peers
    lost_[guid.guidPrefix] = gone.endpoints.known | gone.endpoints.before;
  }
  for (const auto& [node, listener] : peer_listeners_) {
    if (rtps::lists(gone.announced.vehicles, listener.vehicle))
      tell(listener, {gone.name, false, said_goodbye});
  }
}

void Participant::Impl::on_writer(const Guid& guid, const RemoteEndpoint& writer) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  add_endpoint(writers_, guid, writer, PeerEndpoints::kWriter);
}

void Participant::Impl::on_writer_gone(const Guid& guid) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  writers_.erase(guid);
}

void Participant::Impl::on_reader(const Guid& guid, const RemoteEndpoint& reader) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  add_endpoint(readers_, guid, reader, PeerEndpoints::kReader);
}

void Participant::Impl::on_reader_gone(const Guid& guid) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  readers_.erase(guid);
}

void Participant::Impl::add_endpoint(RemoteEndpoints& endpoints, const Guid& guid,
                                     const RemoteEndpoint& endpoint, PeerEndpoints::Kind kind) {
  const auto peer = peers_.find(participant_guid(guid.guidPrefix));
  if (peer != peers_.end()) peer->second.endpoints.known |= kind;
  endpoints[guid] = endpoint;
}

const Participant::Impl::Peer* Participant::Impl::peer_of(const GuidPrefix& participant) const {
  const auto peer = peers_.find(participant_guid(participant));
  return peer == peers_.end() ? nullptr : &peer->second;
}

std::string Participant::Impl::shared_vehicle(const Peer& peer) const {
  for (const std::string& vehicle : rtps::split_names(announcement_.vehicles)) {
    if (rtps::lists(peer.announced.vehicles, vehicle)) return vehicle;
  }
  return {};
}

// ---- incompatible QoS

void Participant::Impl::on_requested_incompatible_qos(fastdds::DataReader* reader,
                                                      const fastdds::RequestedIncompatibleQosStatus&) {
  const EndpointQos requested = endpoint_qos(reader->get_qos());
  log_conflicts(reader->get_topicdescription()->get_name(), writers_, "is not received",
                [&](const EndpointQos& offered) { return conflicts(offered, requested); });
}

void Participant::Impl::on_offered_incompatible_qos(fastdds::DataWriter* writer,
                                                    const fastdds::OfferedIncompatibleQosStatus&) {
  const EndpointQos offered = endpoint_qos(writer->get_qos());
  log_conflicts(writer->get_topic()->get_name(), readers_, "does not receive from this process",
                [&](const EndpointQos& requested) { return conflicts(offered, requested); });
}

template <class ConflictsWith>
void Participant::Impl::log_conflicts(const std::string& topic, const RemoteEndpoints& others,
                                      const char* consequence, const ConflictsWith& conflicts_with) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  for (const auto& [guid, other] : others) {
    if (other.topic != topic) continue;
    const std::string policies = conflicts_with(other.qos);
    if (policies.empty()) continue;
    const Peer* const peer = peer_of(guid.guidPrefix);
    log_.warn(topic + ": " + named(peer == nullptr ? "" : peer->name, guid.guidPrefix) + " " + consequence +
                  ", their QoS is incompatible: " + policies,
              Clock::now());
  }
}

}  // namespace swiftlet::dds
