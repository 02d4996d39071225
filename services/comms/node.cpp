#include "services/comms/node.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>
#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/BatteryPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandAckPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandPubSubTypes.h"
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

#include "services/comms/participant_qos.hpp"
#include "services/comms/profiles.hpp"
#include "services/comms/shared_memory.hpp"

// Each message type that is a topic's.
// clang-format off
#define SWIFTLET_FOR_EACH_MESSAGE(X)                                      \
  X(ActuatorCommand) X(Battery) X(Command) X(CommandAck) X(ControllerState) X(ControlStatus) \
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

// Once in a process, before its first participant.
void set_up_library() {
  static const bool done = [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(
        std::make_unique<dds::StdoutErrConsumer>());  // to stderr: stdout is the program's own
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
    // Two nodes in one process talk as two processes do: a callback never runs inside the publisher's call.
    auto settings = eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings();
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
    return true;
  }();
  static_cast<void>(done);
}

void check(const NodeSettings& settings) {
  if (settings.domain < 0 || settings.domain > 232) {
    throw std::runtime_error("DDS domain is " + std::to_string(settings.domain) +
                             ", must be between 0 and 232");
  }
  if (settings.name.empty()) throw std::runtime_error("the node has no name");
  const bool plain = std::all_of(settings.vehicle.begin(), settings.vehicle.end(),
                                 [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if (settings.vehicle.empty() || settings.vehicle.size() > 64 || !plain) {
    throw std::runtime_error("vehicle name is '" + settings.vehicle +
                             "', must be 1 to 64 letters, digits and underscores");
  }
}

}  // namespace

struct Node::Impl final : public dds::DomainParticipantListener {
  explicit Impl(const NodeSettings& node_settings) : settings(node_settings) {
    check(settings);
    set_up_library();
    if (settings.transport == Transport::kSharedMemory) remove_stale_shared_memory();

    participant = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<std::uint32_t>(settings.domain), participant_qos(settings), this,
        dds::StatusMask::none());
    if (participant == nullptr) {
      throw std::runtime_error("cannot join DDS domain " + std::to_string(settings.domain) +
                               ": no port could be opened or the transport could not be set up");
    }
    publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    if (publisher == nullptr || subscriber == nullptr) {
      participant->delete_contained_entities();
      dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
      throw std::runtime_error("cannot set up publishing in DDS domain " + std::to_string(settings.domain));
    }
  }

  ~Impl() override {
    participant->set_listener(nullptr);
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
    if (settings.transport == Transport::kSharedMemory) remove_stale_shared_memory();
  }

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  template <class T>
  dds::Topic* topic(const char* name) {
    const std::lock_guard<std::mutex> lock(topics_mutex);
    dds::Topic*& found = topics[name];
    if (found == nullptr) {
      const dds::TypeSupport type(new typename PubSubTypeOf<T>::type());
      const std::string wire_name = "rt/" + settings.vehicle + "/" + name;
      if (participant->register_type(type) == ReturnCode_t::RETCODE_OK) {
        found = participant->create_topic(wire_name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
      }
      if (found == nullptr) throw std::runtime_error("cannot make DDS topic " + wire_name);
    }
    return found;
  }

  int deadline_ms(int of_topic) const { return settings.deadlines ? of_topic : 0; }

  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) override {
    const std::lock_guard<std::mutex> lock(peers_mutex);
    switch (info.status) {
      case rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT: {
        if (vehicle_of(info.info.m_userData.dataVec()) != settings.vehicle) return;
        const std::string name = info.info.m_participantName.c_str();
        peers[info.info.m_guid] = name;
        if (peer_callback) peer_callback({name, true, false});
        break;
      }
      case rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT:
      case rtps::ParticipantDiscoveryInfo::DROPPED_PARTICIPANT: {
        const auto peer = peers.find(info.info.m_guid);
        if (peer == peers.end()) return;
        const PeerEvent event{peer->second, false,
                              info.status == rtps::ParticipantDiscoveryInfo::REMOVED_PARTICIPANT};
        peers.erase(peer);
        if (peer_callback) peer_callback(event);
        break;
      }
      case rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT:
        break;
    }
  }

  const NodeSettings settings;
  dds::DomainParticipant* participant = nullptr;
  dds::Publisher* publisher = nullptr;
  dds::Subscriber* subscriber = nullptr;

  std::mutex topics_mutex;
  std::map<std::string, dds::Topic*> topics;

  std::mutex peers_mutex;
  std::map<rtps::GUID_t, std::string> peers;
  std::function<void(const PeerEvent&)> peer_callback;
};

namespace {

const eprosima::fastrtps::Duration_t kWriteTimeout{0,
                                                   std::chrono::nanoseconds(kReliableWriteTimeout).count()};

// Endpoints share the participant, so that the order in which a process lets go of them does not matter.
template <class Impl>
class DdsWriter final : public detail::Writer {
 public:
  DdsWriter(std::shared_ptr<Impl> node, dds::Topic* topic, const dds::DataWriterQos& qos)
      : node_(std::move(node)),
        writer_(node_->publisher->create_datawriter(topic, qos)),
        waits_(qos.history().kind == dds::KEEP_ALL_HISTORY_QOS) {
    if (writer_ == nullptr) throw std::runtime_error("cannot publish " + topic->get_name());
  }
  ~DdsWriter() override { node_->publisher->delete_datawriter(writer_); }
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  bool write(const void* sample) override {
    void* const data = const_cast<void*>(sample);  // serialized before write() returns, not altered
    if (writer_->write(data)) return true;
    // A full history of requests makes room when they are acknowledged; write() does not always wait for
    // that.
    return waits_ && writer_->wait_for_acknowledgments(kWriteTimeout) == ReturnCode_t::RETCODE_OK &&
           writer_->write(data);
  }

  void set_strength(std::uint32_t strength) override {
    dds::DataWriterQos qos = writer_->get_qos();
    qos.ownership_strength().value = strength;
    writer_->set_qos(qos);
  }

  int matched() const override {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

 private:
  std::shared_ptr<Impl> node_;
  dds::DataWriter* writer_;
  bool waits_;
};

template <class Impl, class T>
class DdsReader final : public detail::Reader, private dds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<Impl> node, dds::Topic* topic, const dds::DataReaderQos& qos,
            std::function<void(const T&)> callback)
      : node_(std::move(node)), callback_(std::move(callback)) {
    reader_ = node_->subscriber->create_datareader(topic, qos, this, dds::StatusMask::data_available());
    if (reader_ == nullptr) throw std::runtime_error("cannot subscribe to " + topic->get_name());
  }

  ~DdsReader() override {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
    }
    reader_->set_listener(nullptr);
    node_->subscriber->delete_datareader(reader_);
  }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  int matched() const override {
    dds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count;
  }

 private:
  void on_data_available(dds::DataReader* reader) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    dds::SampleInfo info;
    while (!closed_ && reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      callback_(sample_);
    }
  }

  std::shared_ptr<Impl> node_;
  dds::DataReader* reader_ = nullptr;
  std::mutex mutex_;  // of all below; held while a callback runs
  std::function<void(const T&)> callback_;
  T sample_;
  bool closed_ = false;
};

}  // namespace

Node::Node(const NodeSettings& settings) : impl_(std::make_shared<Impl>(settings)) {}

Node::~Node() { on_peer({}); }

void Node::on_peer(std::function<void(const PeerEvent&)> callback) {
  const std::lock_guard<std::mutex> lock(impl_->peers_mutex);
  impl_->peer_callback = std::move(callback);
  if (!impl_->peer_callback) return;
  for (const auto& peer : impl_->peers) impl_->peer_callback({peer.second, true, false});
}

template <class T>
Publisher<T> Node::publish(const Topic<T>& topic, std::uint32_t strength) {
  return Publisher<T>(std::make_unique<DdsWriter<Impl>>(
      impl_, impl_->topic<T>(topic.name),
      writer_qos(topic.qos, impl_->deadline_ms(topic.deadline_ms), strength, impl_->settings.transport)));
}

template <class T>
Subscription Node::subscribe(const Topic<T>& topic, std::function<void(const T&)> callback,
                             Delivery delivery) {
  return Subscription(std::make_unique<DdsReader<Impl, T>>(
      impl_, impl_->topic<T>(topic.name),
      reader_qos(topic.qos, impl_->deadline_ms(topic.deadline_ms), impl_->settings.transport, delivery),
      std::move(callback)));
}

#define SWIFTLET_INSTANTIATE(Name)                                                                      \
  template Publisher<msg::Name> Node::publish(const Topic<msg::Name>&, std::uint32_t);                  \
  template Subscription Node::subscribe(const Topic<msg::Name>&, std::function<void(const msg::Name&)>, \
                                        Delivery);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::comms
