#include "swiftlet/services/dds/node.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
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
#include "swiftlet/services/dds/discovery/rediscovery_monitor.hpp"
#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/dds/profiles.hpp"
#include "swiftlet/services/dds/qos_conflicts.hpp"
#include "swiftlet/services/dds/shared_memory.hpp"

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
  const bool plain = std::all_of(vehicle.begin(), vehicle.end(),
                                 [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if (vehicle.empty() || vehicle.size() > 64 || !plain) {
    throw std::runtime_error("vehicle name is '" + vehicle +
                             "', must be 1 to 64 letters, digits and underscores");
  }
  return vehicle;
}

// True if the list of a participant's user data, "kl1,kl2", contains the vehicle.
bool lists(const std::string& names, const std::string& vehicle) {
  return ("," + names + ",").find("," + vehicle + ",") != std::string::npos;
}

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
    std::string vehicles;
  };
  struct PeerListener {
    std::string vehicle;
    std::function<void(const PeerEvent&)> callback;
  };

  // vehicle: may be empty
  Impl(const NodeSettings& node_settings, const std::string& vehicle)
      : settings(node_settings), served(vehicle) {
    settings.vehicle = vehicle;
    check(settings);
    if (settings.transport == Transport::kSharedMemory) remove_stale_shared_memory();
    session = std::make_unique<ParticipantSession>(settings, this);
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
    if (lists(settings.vehicle, vehicle)) return;
    settings.vehicle += (settings.vehicle.empty() ? "" : ",") + vehicle;
    {
      const std::lock_guard<std::mutex> peers_lock(peers_mutex);
      for (const auto& [guid, peer] : peers) {
        if (!is_own(peer) && lists(peer.vehicles, vehicle))
          rediscovery.came(guid.guidPrefix, std::chrono::steady_clock::now());
      }
      served = settings.vehicle;
    }
    if (session != nullptr) session->announce_vehicles(settings);
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
      session = std::make_unique<ParticipantSession>(settings, this);
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
                    {info.info.m_participantName.c_str(), vehicle_of(info.info.m_userData.dataVec())});
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
          if (lists(gone.vehicles, listener.vehicle)) listener.callback(event);
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
      if (lists(peer.vehicles, listener.vehicle) && !lists(before.vehicles, listener.vehicle))
        listener.callback({peer.name, true, false});
    }
  }
  // True if the peer serves a vehicle that this process serves. Requires peers_mutex.
  bool is_own(const Peer& peer) const {
    std::size_t begin = 0;
    while (begin < served.size()) {
      const std::size_t end = std::min(served.find(',', begin), served.size());
      if (lists(peer.vehicles, served.substr(begin, end - begin))) return true;
      begin = end + 1;
    }
    return false;
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

  std::mutex session_mutex;  // guards these, except constant fields of the settings
  NodeSettings settings;     // vehicle: all served vehicles, "kl1,kl2"
  std::unique_ptr<ParticipantSession> session;
  std::vector<Endpoint*> endpoints;

  std::mutex peers_mutex;
  std::string served;                  // same as settings.vehicle
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
            std::function<void(const T&)> callback, Delivery delivery)
      : node_(std::move(node)),
        vehicle_(std::move(vehicle)),
        topic_(topic),
        delivery_(delivery),
        callback_(std::move(callback)) {
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

 private:
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
      callback_(sample_);
    }
  }

  std::shared_ptr<Impl> node_;
  const std::string vehicle_;
  const Topic<T> topic_;
  const Delivery delivery_;
  GuardedPointer<dds::DataReader> reader_;
  std::mutex mutex_;  // guards all below; held while a callback runs
  std::function<void(const T&)> callback_;
  T sample_;
  bool open_ = false;
};

}  // namespace

Participant::Participant(const NodeSettings& settings) : impl_(std::make_shared<Impl>(settings, "")) {}

Node::Node(const NodeSettings& settings)
    : participant_(std::make_shared<Participant::Impl>(settings, checked(settings.vehicle))),
      vehicle_(settings.vehicle) {}

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

void Node::on_peer(std::function<void(const PeerEvent&)> callback) {
  Participant::Impl& impl = *participant_.impl_;
  const std::lock_guard<std::mutex> lock(impl.peers_mutex);
  impl.peer_listeners.erase(this);
  if (!callback) return;
  for (const auto& [guid, peer] : impl.peers) {
    if (lists(peer.vehicles, vehicle_)) callback({peer.name, true, false});
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
Subscription Node::subscribe(const Topic<T>& topic, std::function<void(const T&)> callback,
                             Delivery delivery) {
  return Subscription(std::make_unique<DdsReader<Participant::Impl, T>>(participant_.impl_, vehicle_, topic,
                                                                        std::move(callback), delivery));
}

#define SWIFTLET_INSTANTIATE(Name)                                                                      \
  template Publisher<msg::Name> Node::publish(const Topic<msg::Name>&, std::uint32_t);                  \
  template Subscription Node::subscribe(const Topic<msg::Name>&, std::function<void(const msg::Name&)>, \
                                        Delivery);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::comms
