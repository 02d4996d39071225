#include "swiftlet/services/dds/participant.hpp"

#include <algorithm>
#include <climits>
#include <iterator>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::dds {
namespace {

namespace fastdds = eprosima::fastdds::dds;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kCheckPeriod{250};

void check(const NodeSettings& settings) {
  if (settings.domain < 0 || settings.domain > 232) {
    throw std::runtime_error("DDS domain is " + std::to_string(settings.domain) +
                             ", must be between 0 and 232");
  }
  if (settings.name.empty()) throw std::runtime_error("the node has no name");
  const NetworkSettings& network = settings.network;
  const char* const wanted = !network.peers.empty() ? "a peer (--peer, ROS_STATIC_PEERS)"
                             : !network.discovery_servers.empty()
                                 ? "a discovery server (--discovery-server, ROS_DISCOVERY_SERVER)"
                             : !network.interfaces.empty() ? "an interface (--interface)"
                                                           : nullptr;
  if (settings.on_loopback() && wanted != nullptr)
    throw io::ConfigError(std::string(wanted) +
                          " is given, but the process stays on the loopback interface without "
                          "--network-key FILE, --security DIR or --open-network");
}

rtps::Announcement announcement_of(const NodeSettings& settings, const std::string& vehicles) {
  rtps::Announcement announcement;
  announcement.vehicles = vehicles;
  char host[HOST_NAME_MAX + 1] = {};
  ::gethostname(host, HOST_NAME_MAX);
  announcement.host = host;
  announcement.pid = ::getpid();
  announcement.source_of = settings.source_of;
  announcement.since_ns = std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  announcement.hears_of_own_vehicles = !settings.hears_of_all && settings.network.discovery_servers.empty();
  return announcement;
}

double random_share() {
  std::random_device random;
  return std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

std::string named(const std::string& name, const fastrtps::GuidPrefix_t& participant) {
  std::ostringstream text;
  text << "'" << name << "' (" << participant << ")";
  return text.str();
}

fastrtps::GUID_t participant_guid(const fastrtps::GuidPrefix_t& participant) {
  return {participant, fastrtps::c_EntityId_RTPSParticipant};
}

// Anybody may announce itself under any name: logs and terminals get no control characters of it.
std::string in_one_line(const std::string& name) {
  std::string line = io::printable(name);
  std::replace(line.begin(), line.end(), '\n', '?');
  return line;
}

}  // namespace

Participant::Impl::Impl(const NodeSettings& node_settings, const std::string& vehicles)
    : settings(node_settings),
      guard_(guard_of(node_settings)),
      announcement_(announcement_of(node_settings, vehicles)),
      patience_(random_share()) {
  check(settings);
  guard_->set_own_interfaces(io::interfaces_up());
  guard_->ignore_apart_from(rtps::to_user_data(announcement_));
  if (settings.network.discovery_servers.empty()) introduced_at_ = Clock::now();
  const runtime::RealtimeScope scope = realtime();
  session_ = std::make_unique<ParticipantSession>(settings, announcement_, guard_, this);
  periodic_task_.emplace(kCheckPeriod, [this] {
    const runtime::RealtimeScope task_scope = realtime();
    rejoin_if_rediscovery_failed();
    guard_->refusals().write_due(Clock::now());
    const std::lock_guard<std::mutex> session_lock(session_mutex_);
    follow_addresses();
    announce_when_due();
  });
}

Participant::Impl::~Impl() {
  periodic_task_.reset();
  const runtime::RealtimeScope scope = realtime();
  end_session();
}

void Participant::Impl::serve(const std::string& vehicle) {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(session_mutex_);
  ++nodes_of_[vehicle];
  if (rtps::lists(announcement_.vehicles, vehicle)) return;
  {
    const std::lock_guard<std::mutex> peers_lock(peers_mutex_);
    announcement_.vehicles += (announcement_.vehicles.empty() ? "" : ",") + vehicle;
  }
  guard_->ignore_apart_from(rtps::to_user_data(announcement_));
  announcement_changed_ = true;
  announce_when_due();
}

void Participant::Impl::stop_serving(const std::string& vehicle) {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (--nodes_of_[vehicle] > 0) return;
  {
    const std::lock_guard<std::mutex> peers_lock(peers_mutex_);
    std::vector<std::string> vehicles = rtps::split_names(announcement_.vehicles);
    vehicles.erase(std::remove(vehicles.begin(), vehicles.end(), vehicle), vehicles.end());
    announcement_.vehicles = io::joined(vehicles, ",");
  }
  guard_->ignore_apart_from(rtps::to_user_data(announcement_));
  announcement_changed_ = true;
}

void Participant::Impl::announce_when_due() {
  if (session_ == nullptr || !announcement_changed_ || session_->next_announcement() > Clock::now()) return;
  session_->announce(announcement_);
  announcement_changed_ = false;
}

void Participant::Impl::follow_addresses() {
  for (const rtps::MovedHosts::Move& move : guard_->take_moves())
    runtime::log_warning("what is for {} is sent to {} now, from where its host is heard",
                         io::to_string(move.announced), io::to_string(move.heard_at));
  const std::vector<io::Interface> own = io::interfaces_up();
  guard_->set_own_interfaces(own);
  if (settings.on_loopback()) return;
  const auto change = addresses_.change(own, settings.network);
  if (!change) return;
  runtime::log_warning("{}", *change);
  announcement_changed_ = true;
}

void Participant::Impl::add(Endpoint* endpoint) {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (session_ != nullptr) endpoint->join(*session_);
  endpoints_.push_back(endpoint);
}

void Participant::Impl::remove(Endpoint* endpoint) {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(session_mutex_);
  if (session_ != nullptr) endpoint->leave(*session_);
  endpoints_.erase(std::remove(endpoints_.begin(), endpoints_.end(), endpoint), endpoints_.end());
}

std::shared_ptr<std::atomic<int>> Participant::Impl::own_readers(const std::string& wire_name) {
  const std::lock_guard<std::mutex> lock(session_mutex_);
  std::shared_ptr<std::atomic<int>>& count = own_readers_[wire_name];
  if (count == nullptr) count = std::make_shared<std::atomic<int>>(0);
  return count;
}

void Participant::Impl::rejoin_if_rediscovery_failed() {
  {
    const std::lock_guard<std::mutex> lock(peers_mutex_);
    const auto now = Clock::now();
    if (!away_) {
      const auto is_incomplete = [&](const auto& known) {
        return is_own(known.second) && known.second.endpoints.are_missing(now, patience_.at(now));
      };
      if (std::none_of(peers_.begin(), peers_.end(), is_incomplete)) return;
      patience_.rejoined(now);
    }
  }
  if (rejoin()) runtime::log_warning("rejoined the network: a peer was rediscovered without its endpoints");
}

bool Participant::Impl::rejoin() {
  const runtime::RealtimeScope scope = realtime();
  const std::lock_guard<std::mutex> lock(session_mutex_);
  leave();
  try {
    session_ = std::make_unique<ParticipantSession>(settings, announcement_, guard_, this);
    announcement_changed_ = false;
    for (Endpoint* const endpoint : endpoints_) endpoint->join(*session_);
    return !away_.exchange(false);
  } catch (const std::runtime_error& error) {
    if (!away_) runtime::log_error("cannot rejoin the network, trying again: {}", error.what());
    away_ = true;
    leave();
    return false;
  }
}

void Participant::Impl::end_session() {
  if (session_ != nullptr) std::this_thread::sleep_until(session_->next_announcement());
  session_.reset();
}

void Participant::Impl::leave() {
  if (session_ == nullptr) return;
  for (Endpoint* const endpoint : endpoints_) endpoint->leave(*session_);
  end_session();
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  peers_.clear();
  strangers_.clear();
  writers_.clear();
  readers_.clear();
  lost_.clear();
}

// ---- other processes

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

std::vector<std::string> Participant::Impl::qos_conflicts_seen() const {
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
  drop_peer(guid, said_goodbye);
}

// Before or after its discovery. Fast DDS names who is refused by GUID only, and logs the reason without it.
void Participant::Impl::on_authentication(const Guid& guid, bool authenticated) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  if (!authenticated) {
    const std::string name = in_one_line(guard_->name_of(bytes_of(guid.guidPrefix)));
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

void Participant::Impl::on_writer(const Guid& guid, const std::string& topic, const EndpointQos& qos) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  add_endpoint(writers_, guid, {topic, qos}, PeerEndpoints::kWriter);
}

void Participant::Impl::on_writer_gone(const Guid& guid) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  writers_.erase(guid);
}

void Participant::Impl::on_reader(const Guid& guid, const std::string& topic, const EndpointQos& qos) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  add_endpoint(readers_, guid, {topic, qos}, PeerEndpoints::kReader);
}

void Participant::Impl::on_reader_gone(const Guid& guid) {
  const std::lock_guard<std::mutex> lock(peers_mutex_);
  readers_.erase(guid);
}

void Participant::Impl::add_endpoint(RemoteEndpoints& endpoints, const Guid& guid, RemoteEndpoint endpoint,
                                     PeerEndpoints::Kind kind) {
  const auto peer = peers_.find(participant_guid(guid.guidPrefix));
  if (peer != peers_.end()) peer->second.endpoints.known |= kind;
  endpoints[guid] = std::move(endpoint);
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

// ---- the only source of a topic

std::optional<std::string> Participant::Impl::become_source(const std::vector<std::string>& excluded,
                                                            std::function<void(const std::string&)> on_lost) {
  const bool finds_fast = settings.security.empty() && settings.network.discovery_servers.empty();
  std::this_thread::sleep_for(finds_fast ? kSourceSearchTime : kLongSourceSearchTime);
  const std::lock_guard<std::mutex> lock(session_mutex_);
  {
    const std::lock_guard<std::mutex> peers_lock(peers_mutex_);
    if (auto other = other_source(excluded)) return other;
    announcement_.is_established = true;
    established_at_ = Clock::now();
    on_lost_source_ = std::move(on_lost);
  }
  announcement_changed_ = true;
  announce_when_due();
  return std::nullopt;
}

bool Participant::Impl::is_on_probation() const {
  return !introduced_at_ || Clock::now() - std::max(established_at_, *introduced_at_) < kSourceProbation;
}

std::optional<std::string> Participant::Impl::other_source(const std::vector<std::string>& excluded) const {
  for (const auto& [guid, peer] : peers_) {
    const bool same = std::count(excluded.begin(), excluded.end(), peer.announced.source_of) > 0;
    if (same && is_own(peer) && yields(announcement_, peer.announced))
      return in_use_by(shared_vehicle(peer), peer.announced.source_of, peer);
  }
  for (const std::string& vehicle : rtps::split_names(announcement_.vehicles)) {
    for (const std::string& topic : excluded) {
      if (auto other = unannounced_source(vehicle, topic)) return other;
    }
  }
  return std::nullopt;
}

// Programs of others do not announce of what they are the source.
std::optional<std::string> Participant::Impl::unannounced_source(const std::string& vehicle,
                                                                 const std::string& topic) const {
  for (const auto& [guid, writer] : writers_) {
    if (writer.topic != "rt/" + vehicle + "/" + topic) continue;
    const Peer* const peer = peer_of(guid.guidPrefix);
    if (peer != nullptr && peer->announced.source_of != topic) return in_use_by(vehicle, topic, *peer);
  }
  return std::nullopt;
}

void Participant::Impl::yield_source_to(const Peer& peer) {
  if (!announcement_.is_established || !on_lost_source_ || !is_on_probation()) return;
  if (peer.announced.source_of != announcement_.source_of || !is_own(peer)) return;
  if (!peer.announced.is_established || !rtps::yields(announcement_, peer.announced)) return;
  on_lost_source_(in_use_by(shared_vehicle(peer), peer.announced.source_of, peer));
  on_lost_source_ = nullptr;
}

std::string Participant::Impl::in_use_by(const std::string& vehicle, const std::string& topic,
                                         const Peer& source) const {
  const std::string what = topic == kFlight ? " has reserved it for a flight" : " publishes its " + topic;
  return "vehicle " + vehicle + " is already in use in domain " + std::to_string(settings.domain) + ": " +
         source.identity().to_string() + what;
}

}  // namespace swiftlet::dds
