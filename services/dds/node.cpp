#include "swiftlet/services/dds/node.hpp"

#include <algorithm>
#include <atomic>
#include <climits>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <spdlog/spdlog.h>

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/BatteryPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandAckPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlSettingsPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/ControllerStatePubSubTypes.h"
#include "swiftlet_msgs/msg/EstimatePubSubTypes.h"
#include "swiftlet_msgs/msg/GroundLinkPubSubTypes.h"
#include "swiftlet_msgs/msg/GroundTruthPubSubTypes.h"
#include "swiftlet_msgs/msg/ImuPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/MocapPosePubSubTypes.h"
#include "swiftlet_msgs/msg/ReferencePubSubTypes.h"
#include "swiftlet_msgs/msg/RotorSpeedsPubSubTypes.h"
#include "swiftlet_msgs/msg/SetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/SimulationClockPubSubTypes.h"
#include "swiftlet_msgs/msg/TrajectoryPubSubTypes.h"
#include "swiftlet_msgs/msg/VehicleInfoPubSubTypes.h"

#include "swiftlet/services/dds/checked_type_support.hpp"
#include "swiftlet/services/dds/discovery/announcement.hpp"
#include "swiftlet/services/dds/discovery/rediscovery_monitor.hpp"
#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/dds/profiles.hpp"
#include "swiftlet/services/dds/qos_conflicts.hpp"
#include "swiftlet/services/dds/shared_memory.hpp"
#include "swiftlet/services/dds/single_source.hpp"
#include "swiftlet/services/dds/vehicle_name.hpp"

// All message types of topics.
// clang-format off
#define SWIFTLET_FOR_EACH_MESSAGE(X)                                      \
  X(ActuatorCommand) X(Battery) X(Command) X(CommandAck) X(ControllerState) X(ControlSettings) X(ControlStatus) \
  X(Estimate) X(GroundLink) X(GroundTruth) X(Imu) X(Mission) X(MissionStatus) \
  X(MocapPose) X(Reference) X(RotorSpeeds) X(Setpoint)                    \
  X(SimulationClock) X(Trajectory) X(VehicleInfo)
// clang-format on

namespace swiftlet::comms {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

template <class T>
struct PubSubTypeOf;
#define SWIFTLET_PUB_SUB_TYPE(Name)     \
  template <>                           \
  struct PubSubTypeOf<msg::Name> {      \
    using type = msg::Name##PubSubType; \
  };
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_PUB_SUB_TYPE)
#undef SWIFTLET_PUB_SUB_TYPE

void check(const NodeSettings& settings) {
  if (settings.domain < 0 || settings.domain > 232) {
    throw std::runtime_error("DDS domain is " + std::to_string(settings.domain) +
                             ", must be between 0 and 232");
  }
  if (settings.name.empty()) throw std::runtime_error("the node has no name");
}

const std::string& checked(const std::string& vehicle) {
  const std::string fault = fault_of_vehicle_name(vehicle);
  if (!fault.empty()) throw std::runtime_error("vehicle name is '" + vehicle + "', " + fault);
  return vehicle;
}

Announcement announcement_of(const NodeSettings& settings, const std::string& vehicle) {
  Announcement announcement;
  announcement.vehicles = vehicle;
  char host[HOST_NAME_MAX + 1] = {};
  ::gethostname(host, HOST_NAME_MAX);
  announcement.host = host;
  announcement.pid = ::getpid();
  announcement.source_of = settings.source_of;
  announcement.since_ns = std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  return announcement;
}

// A process as the sender of samples. Fast DDS begins the identifiers of all participants of a process, also
// of one that rejoined the domain, with the same octets.
struct SenderId {
  static constexpr std::size_t kProcessOctets = 8;

  rtps::GuidPrefix_t participant;

  bool operator==(const SenderId& other) const {
    return std::equal(participant.value, participant.value + kProcessOctets, other.participant.value);
  }
};

constexpr std::chrono::milliseconds kRediscoveryPatience{1000};
constexpr std::chrono::milliseconds kCheckPeriod{250};

std::string named(const std::string& name, const rtps::GuidPrefix_t& participant) {
  std::ostringstream text;
  text << "'" << name << "' (" << participant << ")";
  return text.str();
}

}  // namespace

struct Participant::Impl final : public dds::DomainParticipantListener {
  using PeerMonitor = RediscoveryMonitor<rtps::GuidPrefix_t>;
  struct RemoteEndpoint {
    std::string topic;
    EndpointQos qos;
  };
  using RemoteEndpoints = std::map<rtps::GUID_t, RemoteEndpoint>;
  struct Peer {
    std::string name;
    Announcement announced;
  };
  struct PeerListener {
    std::string vehicle;
    std::function<void(const PeerEvent&)> callback;
  };

  // vehicle: may be empty
  Impl(const NodeSettings& node_settings, const std::string& vehicle)
      : settings(node_settings), announcement(announcement_of(node_settings, vehicle)) {
    check(settings);
    if (settings.transport == Transport::kSharedMemory) remove_stale_shared_memory();
    session = std::make_unique<ParticipantSession>(settings, announcement, this);
    periodic_task.emplace(kCheckPeriod, [this] {
      rejoin_if_rediscovery_failed();
      log_conflicts_due();
    });
  }

  ~Impl() override {
    periodic_task.reset();
    session.reset();
    if (settings.transport == Transport::kSharedMemory) remove_stale_shared_memory();
  }

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // Adds a vehicle that this process serves.
  void serve(const std::string& vehicle) {
    const std::lock_guard<std::mutex> lock(session_mutex);
    if (lists(announcement.vehicles, vehicle)) return;
    {
      const std::lock_guard<std::mutex> peers_lock(peers_mutex);
      for (const auto& [guid, peer] : peers) {
        if (!is_own(peer) && lists(peer.announced.vehicles, vehicle))
          rediscovery.came(guid.guidPrefix, std::chrono::steady_clock::now());
      }
      announcement.vehicles += (announcement.vehicles.empty() ? "" : ",") + vehicle;
    }
    if (session != nullptr) session->announce(announcement);
  }

  std::optional<std::string> become_source(const std::vector<std::string>& excluded,
                                           std::function<void(const std::string&)> on_lost) {
    std::this_thread::sleep_for(kSourceSearchTime);
    const std::lock_guard<std::mutex> lock(session_mutex);
    {
      const std::lock_guard<std::mutex> peers_lock(peers_mutex);
      if (auto other = other_source(excluded)) return other;
      announcement.is_established = true;
      established_at = std::chrono::steady_clock::now();
      on_lost_source = std::move(on_lost);
    }
    if (session != nullptr) session->announce(announcement);
    return std::nullopt;
  }

  void add(Endpoint* endpoint) {
    const std::lock_guard<std::mutex> lock(session_mutex);
    if (session != nullptr) endpoint->join(*session);
    endpoints.push_back(endpoint);
  }
  void remove(Endpoint* endpoint) {
    const std::lock_guard<std::mutex> lock(session_mutex);
    if (session != nullptr) endpoint->leave(*session);
    endpoints.erase(std::remove(endpoints.begin(), endpoints.end(), endpoint), endpoints.end());
  }

  // If a peer was rediscovered without its endpoints, leaves the domain and rejoins it with all publishers
  // and subscriptions. The peers then discover it as a new process.
  void rejoin_if_rediscovery_failed() {
    {
      const std::lock_guard<std::mutex> lock(peers_mutex);
      if (!rediscovery.failed(std::chrono::steady_clock::now(), kRediscoveryPatience) && !away) return;
    }
    if (rejoin()) spdlog::warn("rejoined the network: a peer was rediscovered without its endpoints");
  }
  // Returns false if joining failed this time or the previous time.
  bool rejoin() {
    const std::lock_guard<std::mutex> lock(session_mutex);
    leave();
    try {
      session = std::make_unique<ParticipantSession>(settings, announcement, this);
      for (Endpoint* const endpoint : endpoints) endpoint->join(*session);
      return !away.exchange(false);
    } catch (const std::runtime_error& error) {
      if (!away) spdlog::error("cannot rejoin the network, trying again: {}", error.what());
      away = true;
      leave();
      return false;
    }
  }
  void leave() {
    if (session == nullptr) return;
    for (Endpoint* const endpoint : endpoints) endpoint->leave(*session);
    session.reset();
    const std::lock_guard<std::mutex> lock(peers_mutex);
    peers.clear();
    writers.clear();
    readers.clear();
    logged_conflicts.clear();
    rediscovery.clear();
  }

  template <class T>
  dds::Topic* topic_in(ParticipantSession& in, const std::string& vehicle, const char* name) const {
    return in.topic("rt/" + vehicle + "/" + name,
                    dds::TypeSupport(new CheckedTypeSupport<typename PubSubTypeOf<T>::type>()));
  }
  int deadline_ms(int of_topic) const { return settings.deadlines ? of_topic : 0; }

  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) override {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    switch (info.status) {
      case rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT:
      case rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT:
        update_peer(info.info.m_guid,
                    {info.info.m_participantName.c_str(), from_user_data(info.info.m_userData.dataVec())});
        break;
      case rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT:
      case rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT: {
        forget(info.info.m_guid.guidPrefix);
        const auto peer = peers.find(info.info.m_guid);
        if (peer == peers.end()) return;
        const PeerEvent event{peer->second.name, false,
                              info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT};
        const Peer gone = peer->second;
        peers.erase(peer);
        if (!is_own(gone)) return;
        event.said_goodbye ? rediscovery.gone(info.info.m_guid.guidPrefix)
                           : rediscovery.lost(info.info.m_guid.guidPrefix);
        for (const auto& [node, listener] : peer_listeners) {
          if (lists(gone.announced.vehicles, listener.vehicle)) listener.callback(event);
        }
        break;
      }
    }
  }
  // Adds or updates a peer: a known peer may serve more vehicles now. Requires peers_mutex.
  void update_peer(const rtps::GUID_t& guid, const Peer& peer) {
    Peer& known = peers[guid];
    const Peer before = std::exchange(known, peer);
    if (is_own(peer) && !is_own(before)) rediscovery.came(guid.guidPrefix, std::chrono::steady_clock::now());
    for (const auto& [node, listener] : peer_listeners) {
      if (lists(peer.announced.vehicles, listener.vehicle) &&
          !lists(before.announced.vehicles, listener.vehicle))
        listener.callback({peer.name, true, false});
    }
    yield_source_to(peer);
  }
  // True if the peer serves a vehicle that this process serves. Requires peers_mutex.
  bool is_own(const Peer& peer) const { return !shared_vehicle(peer).empty(); }

  // The first vehicle that both serve; empty if none. Requires peers_mutex.
  std::string shared_vehicle(const Peer& peer) const {
    for (const std::string& vehicle : split_names(announcement.vehicles)) {
      if (lists(peer.announced.vehicles, vehicle)) return vehicle;
    }
    return {};
  }

  // A sentence about another process to which this one must yield (become_source()); nullopt if there is none.
  // Requires peers_mutex.
  std::optional<std::string> other_source(const std::vector<std::string>& excluded) const {
    for (const auto& [guid, peer] : peers) {
      const bool same = std::count(excluded.begin(), excluded.end(), peer.announced.source_of) > 0;
      if (same && is_own(peer) && yields(announcement, peer.announced))
        return already_lives(shared_vehicle(peer), peer.announced.source_of, identity_of(peer));
    }
    // Programs of others do not announce of what they are the source.
    for (const std::string& vehicle : split_names(announcement.vehicles)) {
      for (const std::string& topic : excluded) {
        for (const auto& [guid, writer] : writers) {
          if (writer.topic != "rt/" + vehicle + "/" + topic) continue;
          const auto peer = peers.find(rtps::GUID_t(guid.guidPrefix, rtps::c_EntityId_RTPSParticipant));
          if (peer == peers.end() || peer->second.announced.source_of == topic) continue;
          return already_lives(vehicle, topic, identity_of(peer->second));
        }
      }
    }
    return std::nullopt;
  }
  // Two sources that joined at the same time, and discovered each other late. Requires peers_mutex.
  void yield_source_to(const Peer& peer) {
    const bool on_probation = announcement.is_established && on_lost_source &&
                              std::chrono::steady_clock::now() - established_at < kSourceProbation;
    if (!on_probation || peer.announced.source_of != announcement.source_of || !is_own(peer)) return;
    if (!peer.announced.is_established || !yields(announcement, peer.announced)) return;
    on_lost_source(already_lives(shared_vehicle(peer), peer.announced.source_of, identity_of(peer)));
    on_lost_source = nullptr;
  }
  std::string already_lives(const std::string& vehicle, const std::string& topic,
                            const ProcessIdentity& process) const {
    return "vehicle " + vehicle + " already lives in domain " + std::to_string(settings.domain) + ": " +
           process.to_string() + " is the source of its " + topic;
  }
  static ProcessIdentity identity_of(const Peer& peer) {
    return {peer.name, peer.announced.host, peer.announced.pid};
  }
  ProcessIdentity identity_of(const rtps::GuidPrefix_t& participant) {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    const auto peer = peers.find(rtps::GUID_t(participant, rtps::c_EntityId_RTPSParticipant));
    return peer == peers.end() ? ProcessIdentity() : identity_of(peer->second);
  }

  void on_publisher_discovery(dds::DomainParticipant* own, rtps::WriterDiscoveryInfo&& info) override {
    if (info.info.guid().guidPrefix == own->guid().guidPrefix) return;
    if (info.status == rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) {
      note_endpoint(info.info.guid(), PeerMonitor::kWriter);
      const std::lock_guard<std::mutex> lock(peers_mutex);
      writers[info.info.guid()] = {info.info.topicName().c_str(), endpoint_qos(info.info.m_qos)};
    } else if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) {
      const std::lock_guard<std::mutex> lock(peers_mutex);
      writers.erase(info.info.guid());
    }
  }
  void on_subscriber_discovery(dds::DomainParticipant* own, rtps::ReaderDiscoveryInfo&& info) override {
    if (info.info.guid().guidPrefix == own->guid().guidPrefix) return;
    if (info.status == rtps::ReaderDiscoveryInfo::DISCOVERED_READER) {
      note_endpoint(info.info.guid(), PeerMonitor::kReader);
      const std::lock_guard<std::mutex> lock(peers_mutex);
      readers[info.info.guid()] = {info.info.topicName().c_str(), endpoint_qos(info.info.m_qos)};
    } else if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) {
      const std::lock_guard<std::mutex> lock(peers_mutex);
      readers.erase(info.info.guid());
    }
  }
  // Requires peers_mutex.
  void forget(const rtps::GuidPrefix_t& participant) {
    for (RemoteEndpoints* const remote : {&writers, &readers}) {
      for (auto it = remote->begin(); it != remote->end();)
        it = it->first.guidPrefix == participant ? remote->erase(it) : std::next(it);
    }
    for (auto it = logged_conflicts.begin(); it != logged_conflicts.end();)
      it = it->second.guidPrefix == participant ? logged_conflicts.erase(it) : std::next(it);
  }

  // Fast DDS reports which own reader or writer has a conflict, but not the peer. Logs every known peer
  // endpoint of the topic that does not match.
  void on_requested_incompatible_qos(dds::DataReader* reader,
                                     const dds::RequestedIncompatibleQosStatus&) override {
    const EndpointQos requested = endpoint_qos(reader->get_qos().get_readerqos(dds::SUBSCRIBER_QOS_DEFAULT));
    log_conflicts(reader->guid(), reader->get_topicdescription()->get_name(), writers, "is not received",
                  [&](const EndpointQos& offered) { return conflicts(offered, requested); });
  }
  void on_offered_incompatible_qos(dds::DataWriter* writer,
                                   const dds::OfferedIncompatibleQosStatus&) override {
    const EndpointQos offered =
        endpoint_qos(writer->get_qos().get_writerqos(dds::PUBLISHER_QOS_DEFAULT, dds::TOPIC_QOS_DEFAULT));
    log_conflicts(writer->guid(), writer->get_topic()->get_name(), readers,
                  "does not receive from this process",
                  [&](const EndpointQos& requested) { return conflicts(offered, requested); });
  }
  template <class ConflictsWith>
  void log_conflicts(const rtps::GUID_t& own, const std::string& topic, const RemoteEndpoints& others,
                     const char* consequence, const ConflictsWith& conflicts_with) {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    for (const auto& [guid, other] : others) {
      if (other.topic != topic) continue;
      const std::string policies = conflicts_with(other.qos);
      if (policies.empty() || !logged_conflicts.emplace(own, guid).second) continue;
      const auto line =
          conflict_lines.offer(topic + ": " + named(name_of(guid.guidPrefix), guid.guidPrefix) + " " +
                                   consequence + ", their QoS is incompatible: " + policies,
                               std::chrono::steady_clock::now());
      if (line) spdlog::warn(*line);
    }
  }
  void log_conflicts_due() {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    if (const auto line = conflict_lines.due(std::chrono::steady_clock::now())) spdlog::warn(*line);
  }

  // Requires peers_mutex.
  std::string name_of(const rtps::GuidPrefix_t& participant) const {
    const auto peer = peers.find(rtps::GUID_t(participant, rtps::c_EntityId_RTPSParticipant));
    return peer == peers.end() ? "" : peer->second.name;
  }

  void note_endpoint(const rtps::GUID_t& guid, PeerMonitor::Kind kind) {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    const rtps::GUID_t peer(guid.guidPrefix, rtps::c_EntityId_RTPSParticipant);
    const auto known = peers.find(peer);
    if (known != peers.end() && is_own(known->second)) rediscovery.has(guid.guidPrefix, kind);
  }

  const NodeSettings settings;
  std::mutex session_mutex;  // guards session and endpoints
  std::unique_ptr<ParticipantSession> session;
  std::vector<Endpoint*> endpoints;

  std::mutex peers_mutex;     // guards all below; locked after session_mutex
  Announcement announcement;  // of this process; changed with both mutexes locked
  std::chrono::steady_clock::time_point established_at;
  std::function<void(const std::string&)> on_lost_source;
  std::map<rtps::GUID_t, Peer> peers;  // of any vehicle
  RemoteEndpoints writers;             // of other processes, any vehicle
  RemoteEndpoints readers;
  std::set<std::pair<rtps::GUID_t, rtps::GUID_t>> logged_conflicts;  // of own endpoints with others
  LineLimit conflict_lines;
  std::map<const Node*, PeerListener> peer_listeners;

  PeerMonitor rediscovery;

  std::atomic<bool> away{false};  // the last rejoin failed
  std::optional<PeriodicTask> periodic_task;
};

namespace {

const eprosima::fastrtps::Duration_t kWriteTimeout{0,
                                                   std::chrono::nanoseconds(kReliableWriteTimeout).count()};

// Endpoints share the participant, so that they may be destroyed in any order.
template <class Impl, class T>
class DdsWriter final : public detail::Writer, private Endpoint {
 public:
  DdsWriter(std::shared_ptr<Impl> node, std::string vehicle, const Topic<T>& topic, std::uint32_t strength)
      : node_(std::move(node)), vehicle_(std::move(vehicle)), topic_(topic), strength_(strength) {
    node_->add(this);
  }
  ~DdsWriter() override { node_->remove(this); }
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  bool write(const void* sample) override {
    if (is_latched(topic_.qos)) {
      const std::lock_guard<std::mutex> lock(last_mutex_);
      last_ = *static_cast<const T*>(sample);
    }
    const typename GuardedPointer<dds::DataWriter>::Use writer(writer_);
    if (!writer) return false;
    void* const data = const_cast<void*>(sample);  // serialized before write() returns, never modified
    if (writer->write(data)) return true;
    // A full history of requests has room again once they are acknowledged. write() does not always wait for
    // that.
    return topic_.qos == Qos::kRequest &&
           writer->wait_for_acknowledgments(kWriteTimeout) == ReturnCode_t::RETCODE_OK && writer->write(data);
  }

  void set_strength(std::uint32_t strength) override {
    strength_ = strength;
    const typename GuardedPointer<dds::DataWriter>::Use writer(writer_);
    if (!writer) return;
    dds::DataWriterQos qos = writer->get_qos();
    qos.ownership_strength().value = strength;
    writer->set_qos(qos);
  }

  int matched() const override { return readers().current_count; }
  std::uint64_t changes() const override {
    const dds::PublicationMatchedStatus now = readers();
    return changes_before_ + static_cast<std::uint64_t>(2 * now.total_count - now.current_count);
  }

 private:
  void join(ParticipantSession& session) override {
    dds::DataWriter* const writer = session.publisher->create_datawriter(
        node_->template topic_in<T>(session, vehicle_, topic_.name),
        writer_qos(topic_.qos, node_->deadline_ms(topic_.deadline_ms), strength_, node_->settings.transport));
    if (writer == nullptr) throw std::runtime_error(std::string("cannot publish ") + topic_.name);
    const std::lock_guard<std::mutex> lock(last_mutex_);
    if (last_) writer->write(&*last_);
    writer_.give(writer);
  }
  void leave(ParticipantSession& session) override {
    dds::DataWriter* const writer = writer_.take();
    if (writer == nullptr) return;
    dds::PublicationMatchedStatus last;
    writer->get_publication_matched_status(last);
    changes_before_ += static_cast<std::uint64_t>(2 * last.total_count);  // all readers unmatched
    session.publisher->delete_datawriter(writer);
  }
  dds::PublicationMatchedStatus readers() const {
    const typename GuardedPointer<dds::DataWriter>::Use writer(writer_);
    dds::PublicationMatchedStatus status;
    if (writer) writer->get_publication_matched_status(status);
    return status;
  }

  std::shared_ptr<Impl> node_;
  const std::string vehicle_;
  const Topic<T> topic_;
  std::atomic<std::uint32_t> strength_;
  GuardedPointer<dds::DataWriter> writer_;
  std::atomic<std::uint64_t> changes_before_{0};  // in ended sessions
  std::mutex last_mutex_;
  std::optional<T> last_;  // of a latched topic, sent again after rejoining
};

template <class Impl, class T>
class DdsReader final : public detail::Reader, private Endpoint, private dds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<Impl> node, std::string vehicle, const Topic<T>& topic,
            std::function<void(const T&)> callback, Delivery delivery,
            std::optional<std::chrono::milliseconds> source_silence)
      : node_(std::move(node)),
        vehicle_(std::move(vehicle)),
        topic_(topic),
        delivery_(delivery),
        callback_(std::move(callback)) {
    if (source_silence) source_.emplace(*source_silence);
    node_->add(this);
  }
  ~DdsReader() override { node_->remove(this); }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  int matched() const override {
    const typename GuardedPointer<dds::DataReader>::Use reader(reader_);
    dds::SubscriptionMatchedStatus status;
    if (reader) reader->get_subscription_matched_status(status);
    return status.current_count;
  }

  std::optional<SourceConflict> source_conflict() const override {
    std::optional<Conflict> last;
    {
      const std::lock_guard<std::mutex> lock(conflict_mutex_);
      last = conflict_;
    }
    if (!last || std::chrono::steady_clock::now() - last->at > kConflictReportTime) return std::nullopt;
    return SourceConflict{node_->identity_of(last->used.participant),
                          node_->identity_of(last->ignored.participant)};
  }

 private:
  struct Conflict {
    SenderId used;
    SenderId ignored;
    std::chrono::steady_clock::time_point at;
  };

  void join(ParticipantSession& session) override {
    open(true);
    dds::DataReader* const reader = session.subscriber->create_datareader(
        node_->template topic_in<T>(session, vehicle_, topic_.name),
        reader_qos(topic_.qos, node_->deadline_ms(topic_.deadline_ms), node_->settings.transport, delivery_),
        this, dds::StatusMask::data_available());
    if (reader == nullptr) throw std::runtime_error(std::string("cannot subscribe to ") + topic_.name);
    reader_.give(reader);
  }
  void leave(ParticipantSession& session) override {
    dds::DataReader* const reader = reader_.take();
    if (reader == nullptr) return;
    open(false);
    reader->set_listener(nullptr);
    session.subscriber->delete_datareader(reader);
  }
  void open(bool open) {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = open;
  }

  void on_data_available(dds::DataReader* reader) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    dds::SampleInfo info;
    while (open_ && reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (source_ && !is_from_source(info)) continue;
      callback_(sample_);
    }
  }

  // Never waits: what a reader of the conflict misses, the next ignored sample reports.
  bool is_from_source(const dds::SampleInfo& info) {
    const SenderId sender{info.sample_identity.writer_guid().guidPrefix};
    const auto now = std::chrono::steady_clock::now();
    if (source_->accepts(sender, now)) return true;
    const std::unique_lock<std::mutex> lock(conflict_mutex_, std::try_to_lock);
    if (lock) conflict_ = Conflict{*source_->id(), sender, now};
    return false;
  }

  std::shared_ptr<Impl> node_;
  const std::string vehicle_;
  const Topic<T> topic_;
  const Delivery delivery_;
  GuardedPointer<dds::DataReader> reader_;
  mutable std::mutex conflict_mutex_;
  std::optional<Conflict> conflict_;
  std::mutex mutex_;  // guards all below; held while a callback runs
  std::function<void(const T&)> callback_;
  std::optional<SingleSource<SenderId>> source_;
  T sample_;
  bool open_ = false;
};

}  // namespace

std::string ProcessIdentity::to_string() const {
  const std::string program = name.empty() ? "an unnamed program" : name;
  return host.empty() ? program : program + " (process " + std::to_string(pid) + " on host " + host + ")";
}

Participant::Participant(const NodeSettings& settings) : impl_(std::make_shared<Impl>(settings, "")) {}

Node::Node(const NodeSettings& settings)
    : participant_(std::make_shared<Participant::Impl>(settings, checked(settings.vehicle))),
      vehicle_(settings.vehicle),
      source_of_(settings.source_of) {}

Node::Node(const Participant& participant, const std::string& vehicle)
    : participant_(participant), vehicle_(checked(vehicle)) {
  participant_.impl_->serve(vehicle_);
}

Node::~Node() { on_peer({}); }

std::vector<std::string> Participant::topics_seen() const {
  const std::lock_guard<std::mutex> lock(impl_->peers_mutex);
  std::set<std::string> topics;
  for (const auto& writer : impl_->writers) topics.insert(writer.second.topic);
  return {topics.begin(), topics.end()};
}

std::optional<std::string> Participant::become_source(const std::vector<std::string>& excluded,
                                                      std::function<void(const std::string&)> on_lost) {
  return impl_->become_source(excluded, std::move(on_lost));
}

std::optional<std::string> Node::become_source(std::function<void(const std::string&)> on_lost) {
  return participant_.become_source({source_of_}, std::move(on_lost));
}

void Node::on_peer(std::function<void(const PeerEvent&)> callback) {
  Participant::Impl& impl = *participant_.impl_;
  const std::lock_guard<std::mutex> lock(impl.peers_mutex);
  impl.peer_listeners.erase(this);
  if (!callback) return;
  for (const auto& [guid, peer] : impl.peers) {
    if (lists(peer.announced.vehicles, vehicle_)) callback({peer.name, true, false});
  }
  impl.peer_listeners[this] = {vehicle_, std::move(callback)};
}

void Node::rejoin() { participant_.impl_->rejoin(); }

template <class T>
Publisher<T> Node::publish(const Topic<T>& topic, std::uint32_t strength) {
  return Publisher<T>(
      std::make_unique<DdsWriter<Participant::Impl, T>>(participant_.impl_, vehicle_, topic, strength));
}

template <class T>
Subscription Node::subscribe(const Topic<T>& topic, std::function<void(const T&)> callback, Delivery delivery,
                             std::optional<std::chrono::milliseconds> source_silence) {
  return Subscription(std::make_unique<DdsReader<Participant::Impl, T>>(
      participant_.impl_, vehicle_, topic, std::move(callback), delivery, source_silence));
}

#define SWIFTLET_INSTANTIATE(Name)                                                                      \
  template Publisher<msg::Name> Node::publish(const Topic<msg::Name>&, std::uint32_t);                  \
  template Subscription Node::subscribe(const Topic<msg::Name>&, std::function<void(const msg::Name&)>, \
                                        Delivery, std::optional<std::chrono::milliseconds>);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::comms
