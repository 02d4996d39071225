#include "swiftlet/services/dds/participant.hpp"

#include <algorithm>
#include <climits>
#include <random>
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
  refused_.clear();
  writers_.clear();
  readers_.clear();
  lost_.clear();
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
