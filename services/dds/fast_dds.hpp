// What Fast DDS 2.9 (Debian 12) and 3 (Debian 13) name or declare differently, under one name. No other file of the
// project knows which of them it is built with.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#if __has_include(<fastdds/config.hpp>)
#define SWIFTLET_FAST_DDS_3 1
#include <fastdds/LibrarySettings.hpp>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/Locator.hpp>
#include <fastdds/rtps/common/PortParameters.hpp>
#include <fastdds/rtps/common/SerializedPayload.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/TransportReceiverInterface.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#else
#define SWIFTLET_FAST_DDS_3 0
#include <fastdds/rtps/attributes/ServerAttributes.h>
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/common/PortParameters.h>
#include <fastdds/rtps/common/SerializedPayload.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#endif

#include "swiftlet/services/dds/qos/qos_conflicts.hpp"

namespace swiftlet::dds {

#if SWIFTLET_FAST_DDS_3
namespace fastrtps = eprosima::fastdds::rtps;
#else
namespace fastrtps = eprosima::fastrtps::rtps;
#endif

// ---- results and types

#if SWIFTLET_FAST_DDS_3
using ReturnCode = eprosima::fastdds::dds::ReturnCode_t;
using PayloadArgument = fastrtps::SerializedPayload_t&;  // of TopicDataType::deserialize()
inline const fastrtps::SerializedPayload_t& content_of(PayloadArgument payload) { return payload; }
inline bool succeeded(ReturnCode code) { return code == eprosima::fastdds::dds::RETCODE_OK; }
inline const char* type_name(const eprosima::fastdds::dds::TopicDataType& type) {
  return type.get_name().c_str();
}
#else
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;
using PayloadArgument = fastrtps::SerializedPayload_t*;
inline const fastrtps::SerializedPayload_t& content_of(PayloadArgument payload) { return *payload; }
inline bool succeeded(ReturnCode code) { return code == ReturnCode::RETCODE_OK; }
inline const char* type_name(const eprosima::fastdds::dds::TopicDataType& type) { return type.getName(); }
#endif

// Sends a sample: true if it went out or is stored until it can.
inline bool write(eprosima::fastdds::dds::DataWriter& writer, const void* sample) {
#if SWIFTLET_FAST_DDS_3
  return succeeded(writer.write(sample));
#else
  return writer.write(const_cast<void*>(sample));  // serialized before write() returns, never modified
#endif
}

// Message to bytes and back. `type` knows the message's type.
inline std::uint32_t serialized_size(eprosima::fastdds::dds::TopicDataType& type, void* message) {
#if SWIFTLET_FAST_DDS_3
  return type.calculate_serialized_size(message, eprosima::fastdds::dds::XCDR_DATA_REPRESENTATION);
#else
  return type.getSerializedSizeProvider(message)();
#endif
}
inline bool serialize(eprosima::fastdds::dds::TopicDataType& type, void* message,
                      fastrtps::SerializedPayload_t& payload) {
#if SWIFTLET_FAST_DDS_3
  return type.serialize(message, payload, eprosima::fastdds::dds::XCDR_DATA_REPRESENTATION);
#else
  return type.serialize(message, &payload);
#endif
}
inline bool deserialize(eprosima::fastdds::dds::TopicDataType& type, fastrtps::SerializedPayload_t& payload,
                        void* message) {
#if SWIFTLET_FAST_DDS_3
  return type.deserialize(payload, message);
#else
  return type.deserialize(&payload, message);
#endif
}

// The type support of a message that is handled as its payload. For a topic without keys.
class PayloadType : public eprosima::fastdds::dds::TopicDataType {
 public:
  bool deserialize(PayloadArgument payload, void* message) override {
    return take(content_of(payload), message);
  }

 protected:
  // largest: size of the largest payload, bytes.
  PayloadType(const std::string& name, std::uint32_t largest) {
#if SWIFTLET_FAST_DDS_3
    set_name(name);
    max_serialized_type_size = largest;
#else
    setName(name.c_str());
    m_typeSize = largest;
#endif
  }

  virtual void* create() = 0;  // a message, which destroy() deletes
  virtual void destroy(void* message) = 0;
  virtual std::uint32_t size(const void* message) const = 0;  // of its payload, bytes
  // Writes or reads the payload; false if it does not fit, or is not taken.
  virtual bool fill(const void* message, fastrtps::SerializedPayload_t& payload) = 0;
  virtual bool take(const fastrtps::SerializedPayload_t& payload, void* message) = 0;

 private:
#if SWIFTLET_FAST_DDS_3
  using Representation = eprosima::fastdds::dds::DataRepresentationId_t;
  bool serialize(const void* message, fastrtps::SerializedPayload_t& payload, Representation) final {
    return fill(message, payload);
  }
  std::uint32_t calculate_serialized_size(const void* message, Representation) final { return size(message); }
  void* create_data() final { return create(); }
  void delete_data(void* message) final { destroy(message); }
  bool compute_key(fastrtps::SerializedPayload_t&, fastrtps::InstanceHandle_t&, bool) final { return false; }
  bool compute_key(const void*, fastrtps::InstanceHandle_t&, bool) final { return false; }
#else
  bool serialize(void* message, fastrtps::SerializedPayload_t* payload) final {
    return fill(message, *payload);
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* message) final {
    return [this, message] { return size(message); };
  }
  void* createData() final { return create(); }
  void deleteData(void* message) final { destroy(message); }
  bool getKey(void*, fastrtps::InstanceHandle_t*, bool) final { return false; }
#endif
};

// ---- settings of the library and of participants

// If a participant has flow controllers, 3 sends its announcements from a queue, and the build of Debian asserts there
// as soon as one follows another before it is sent.
constexpr bool kHasFlowControllers = SWIFTLET_FAST_DDS_3 == 0;

// Two nodes in one process communicate as two processes do.
inline void switch_off_intraprocess_delivery() {
#if SWIFTLET_FAST_DDS_3
  auto* const factory = eprosima::fastdds::dds::DomainParticipantFactory::get_instance();
  eprosima::fastdds::LibrarySettings settings;
  factory->get_library_settings(settings);
  settings.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
  factory->set_library_settings(settings);
#else
  using eprosima::fastrtps::xmlparser::XMLProfileManager;
  auto settings = XMLProfileManager::library_settings();
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  XMLProfileManager::library_settings(settings);
#endif
}

// number: of the server in the list of ROS 2, by which 2.9 knows it; 3 knows it by its addresses.
inline void add_discovery_server(fastrtps::DiscoverySettings& discovery, int number,
                                 const std::vector<fastrtps::Locator_t>& addresses) {
#if SWIFTLET_FAST_DDS_3
  static_cast<void>(number);
  for (const fastrtps::Locator_t& address : addresses) discovery.m_DiscoveryServers.push_back(address);
#else
  eprosima::fastdds::rtps::RemoteServerAttributes server;
  eprosima::fastdds::rtps::get_server_client_default_guidPrefix(number, server.guidPrefix);
  for (const fastrtps::Locator_t& address : addresses)
    server.metatrafficUnicastLocatorList.push_back(address);
  discovery.m_DiscoveryServers.push_back(server);
#endif
}

// Sets the period of a reliable writer's heartbeats, and the delay of its answer to a request for lost samples.
inline void set_repair_times(eprosima::fastdds::dds::DataWriterQos& qos, const Duration& heartbeat_period,
                             const Duration& answer_delay) {
  auto& times = qos.reliable_writer_qos().times;
#if SWIFTLET_FAST_DDS_3
  times.heartbeat_period = heartbeat_period;
  times.nack_response_delay = answer_delay;
#else
  times.heartbeatPeriod = heartbeat_period;
  times.nackResponseDelay = answer_delay;
#endif
}

// Sets the delay of a reliable reader's answer to a heartbeat, and of its first request.
inline void set_repair_times(eprosima::fastdds::dds::DataReaderQos& qos, const Duration& answer_delay,
                             const Duration& first_request_delay) {
  auto& times = qos.reliable_reader_qos().times;
#if SWIFTLET_FAST_DDS_3
  times.heartbeat_response_delay = answer_delay;
  times.initial_acknack_delay = first_request_delay;
#else
  times.heartbeatResponseDelay = answer_delay;
  times.initialAcknackDelay = first_request_delay;
#endif
}

// ---- discovery

template <class Qos>
EndpointQos endpoint_qos(const Qos& qos, bool without_positive_acks) {
  return {qos.reliability().kind, qos.durability().kind, qos.ownership().kind,
          qos.deadline().period,  qos.liveliness().kind, qos.liveliness().lease_duration,
          without_positive_acks};
}
inline EndpointQos endpoint_qos(const eprosima::fastdds::dds::DataWriterQos& qos) {
  return endpoint_qos(qos, qos.reliable_writer_qos().disable_positive_acks.enabled);
}
inline EndpointQos endpoint_qos(const eprosima::fastdds::dds::DataReaderQos& qos) {
#if SWIFTLET_FAST_DDS_3
  return endpoint_qos(qos, qos.reliable_reader_qos().disable_positive_acks.enabled);
#else
  return endpoint_qos(qos, qos.reliable_reader_qos().disable_positive_ACKs.enabled);
#endif
}

// A writer or reader of another participant.
struct RemoteEndpoint {
  std::string topic;
  std::string type;  // its name
  EndpointQos qos;
};

// Called for the other participants of the domain, and for their writers and readers.
class DiscoveryListener : public eprosima::fastdds::dds::DomainParticipantListener {
 protected:
  // A participant was discovered, or has changed its user data.
  virtual void on_participant(const fastrtps::GUID_t& guid, const std::string& name,
                              const std::vector<std::uint8_t>& user_data) = 0;
  virtual void on_participant_gone(const fastrtps::GUID_t& guid, bool said_goodbye) = 0;
  // With security, before or after on_participant(): whether it is who it says.
  virtual void on_authentication(const fastrtps::GUID_t&, bool /*authenticated*/) {}
  virtual void on_writer(const fastrtps::GUID_t&, const RemoteEndpoint&) {}
  virtual void on_writer_gone(const fastrtps::GUID_t&) {}
  virtual void on_reader(const fastrtps::GUID_t&, const RemoteEndpoint&) {}
  virtual void on_reader_gone(const fastrtps::GUID_t&) {}

 private:
  using Participant = eprosima::fastdds::dds::DomainParticipant;
  static bool is_own(const Participant* own, const fastrtps::GUID_t& guid) {
    return guid.guidPrefix == own->guid().guidPrefix;
  }

  void onParticipantAuthentication(Participant*, fastrtps::ParticipantAuthenticationInfo&& info) final {
    on_authentication(info.guid,
                      info.status == fastrtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT);
  }

#if SWIFTLET_FAST_DDS_3
  template <class Info>
  static EndpointQos qos_of(const Info& info) {
    return {info.reliability.kind,
            info.durability.kind,
            info.ownership.kind,
            info.deadline.period,
            info.liveliness.kind,
            info.liveliness.lease_duration,
            info.disable_positive_acks.enabled};
  }

  void on_participant_discovery(Participant*, fastrtps::ParticipantDiscoveryStatus status,
                                const fastrtps::ParticipantBuiltinTopicData& info, bool&) final {
    using Status = fastrtps::ParticipantDiscoveryStatus;
    if (status == Status::DISCOVERED_PARTICIPANT || status == Status::CHANGED_QOS_PARTICIPANT)
      on_participant(info.guid, info.participant_name.c_str(), info.user_data.data_vec());
    if (status == Status::REMOVED_PARTICIPANT || status == Status::DROPPED_PARTICIPANT)
      on_participant_gone(info.guid, status == Status::REMOVED_PARTICIPANT);
  }
  void on_data_writer_discovery(Participant* own, fastrtps::WriterDiscoveryStatus status,
                                const fastrtps::PublicationBuiltinTopicData& info, bool&) final {
    if (is_own(own, info.guid)) return;
    using Status = fastrtps::WriterDiscoveryStatus;
    if (status == Status::DISCOVERED_WRITER)
      on_writer(info.guid, {info.topic_name.c_str(), info.type_name.c_str(), qos_of(info)});
    if (status == Status::REMOVED_WRITER) on_writer_gone(info.guid);
  }
  void on_data_reader_discovery(Participant* own, fastrtps::ReaderDiscoveryStatus status,
                                const fastrtps::SubscriptionBuiltinTopicData& info, bool&) final {
    if (is_own(own, info.guid)) return;
    using Status = fastrtps::ReaderDiscoveryStatus;
    if (status == Status::DISCOVERED_READER)
      on_reader(info.guid, {info.topic_name.c_str(), info.type_name.c_str(), qos_of(info)});
    if (status == Status::REMOVED_READER) on_reader_gone(info.guid);
  }
#else
  using DomainParticipantListener::on_participant_discovery;
  using DomainParticipantListener::on_publisher_discovery;
  using DomainParticipantListener::on_subscriber_discovery;

  template <class Qos>
  static EndpointQos qos_of(const Qos& qos) {
    return {qos.m_reliability.kind,
            qos.m_durability.kind,
            qos.m_ownership.kind,
            qos.m_deadline.period,
            qos.m_liveliness.kind,
            qos.m_liveliness.lease_duration,
            qos.m_disablePositiveACKs.enabled};
  }

  void on_participant_discovery(Participant*, fastrtps::ParticipantDiscoveryInfo&& found) final {
    using Info = fastrtps::ParticipantDiscoveryInfo;
    const auto& info = found.info;
    if (found.status == Info::DISCOVERED_PARTICIPANT || found.status == Info::CHANGED_QOS_PARTICIPANT)
      on_participant(info.m_guid, info.m_participantName.c_str(), info.m_userData.dataVec());
    if (found.status == Info::REMOVED_PARTICIPANT || found.status == Info::DROPPED_PARTICIPANT)
      on_participant_gone(info.m_guid, found.status == Info::REMOVED_PARTICIPANT);
  }
  void on_publisher_discovery(Participant* own, fastrtps::WriterDiscoveryInfo&& found) final {
    const auto& info = found.info;
    if (is_own(own, info.guid())) return;
    using Info = fastrtps::WriterDiscoveryInfo;
    if (found.status == Info::DISCOVERED_WRITER)
      on_writer(info.guid(), {info.topicName().c_str(), info.typeName().c_str(), qos_of(info.m_qos)});
    if (found.status == Info::REMOVED_WRITER) on_writer_gone(info.guid());
  }
  void on_subscriber_discovery(Participant* own, fastrtps::ReaderDiscoveryInfo&& found) final {
    const auto& info = found.info;
    if (is_own(own, info.guid())) return;
    using Info = fastrtps::ReaderDiscoveryInfo;
    if (found.status == Info::DISCOVERED_READER)
      on_reader(info.guid(), {info.topicName().c_str(), info.typeName().c_str(), qos_of(info.m_qos)});
    if (found.status == Info::REMOVED_READER) on_reader_gone(info.guid());
  }
#endif
};

// ---- transports

// A datagram that is to be sent, in one piece (2.9) or several (3).
struct OutgoingDatagram {
#if SWIFTLET_FAST_DDS_3
  const std::vector<fastrtps::NetworkBuffer>& pieces;
#else
  const fastrtps::octet* bytes;
#endif
  std::uint32_t size;

  struct Piece {
    const fastrtps::octet* bytes;
    std::uint32_t size;
  };
  Piece first_piece() const {
#if SWIFTLET_FAST_DDS_3
    if (pieces.empty()) return {nullptr, 0};
    return {static_cast<const fastrtps::octet*>(pieces.front().buffer), pieces.front().size};
#else
    return {bytes, size};
#endif
  }
  void copy_to(std::vector<fastrtps::octet>& copy) const {
#if SWIFTLET_FAST_DDS_3
    copy.clear();
    for (const fastrtps::NetworkBuffer& piece : pieces) {
      const auto* const begin = static_cast<const fastrtps::octet*>(piece.buffer);
      copy.insert(copy.end(), begin, begin + piece.size);
    }
#else
    copy.assign(bytes, bytes + size);
#endif
  }
};

// Where a datagram is sent, and until when.
struct Destination {
  fastrtps::LocatorsIterator* begin;
  fastrtps::LocatorsIterator* end;
  const std::chrono::steady_clock::time_point& deadline;
};

inline bool send(fastrtps::SenderResource& channel, const OutgoingDatagram& datagram, const Destination& to) {
#if SWIFTLET_FAST_DDS_3
  return channel.send(datagram.pieces, datagram.size, to.begin, to.end, to.deadline);
#else
  return channel.send(datagram.bytes, datagram.size, to.begin, to.end, to.deadline);
#endif
}

inline bool send(fastrtps::SenderResource& channel, const std::vector<fastrtps::octet>& bytes,
                 const Destination& to) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
#if SWIFTLET_FAST_DDS_3
  thread_local std::vector<fastrtps::NetworkBuffer> pieces(1);
  pieces.front() = {bytes.data(), size};
  return send(channel, OutgoingDatagram{pieces, size}, to);
#else
  return send(channel, OutgoingDatagram{bytes.data(), size}, to);
#endif
}

// A channel that a transport puts before a channel of the transport below it.
class OutputChannel : public fastrtps::SenderResource {
 public:
  void add_locators_to_list(fastrtps::LocatorList_t& locators) const override {
    below_->add_locators_to_list(locators);
  }
  std::unique_ptr<fastrtps::SenderResource> take() { return std::move(below_); }

 protected:
  explicit OutputChannel(std::unique_ptr<fastrtps::SenderResource> below)
      : SenderResource(below->kind()), below_(std::move(below)) {
#if SWIFTLET_FAST_DDS_3
    send_buffers_lambda_ = [this](const std::vector<fastrtps::NetworkBuffer>& pieces, std::uint32_t size,
                                  fastrtps::LocatorsIterator* begin, fastrtps::LocatorsIterator* end,
                                  const std::chrono::steady_clock::time_point& deadline) {
      return send_datagram({pieces, size}, {begin, end, deadline});
    };
#else
    send_lambda_ = [this](const fastrtps::octet* bytes, std::uint32_t size, fastrtps::LocatorsIterator* begin,
                          fastrtps::LocatorsIterator* end,
                          const std::chrono::steady_clock::time_point& deadline) {
      return send_datagram({bytes, size}, {begin, end, deadline});
    };
#endif
  }
  virtual bool send_datagram(const OutgoingDatagram& datagram, const Destination& to) = 0;
  fastrtps::SenderResource& below() { return *below_; }

 private:
  std::unique_ptr<fastrtps::SenderResource> below_;
};

// A transport before another one, which sends through an OutputChannel.
class ChainedTransport : public eprosima::fastdds::rtps::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

  eprosima::fastdds::rtps::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }
  void shutdown() override { low_level_transport_->shutdown(); }

  using ChainingTransport::transform_remote_locator;
#if SWIFTLET_FAST_DDS_3
  bool transform_remote_locator(const fastrtps::Locator_t& announced, fastrtps::Locator_t& used,
                                bool allows_localhost_there, bool allows_localhost_here) const final {
    return leads_here(announced, used) || low_level_transport_->transform_remote_locator(
                                              announced, used, allows_localhost_there, allows_localhost_here);
  }
#else
  bool transform_remote_locator(const fastrtps::Locator_t& announced, fastrtps::Locator_t& used) const final {
    return leads_here(announced, used) || low_level_transport_->transform_remote_locator(announced, used);
  }
#endif
  // Whether a process with this address is reached by another one, which is set then.
  virtual bool leads_here(const fastrtps::Locator_t& announced, fastrtps::Locator_t& used) const = 0;

  // For the channels of ChainingTransport; OutputChannel does without.
#if SWIFTLET_FAST_DDS_3
  bool send(fastrtps::SenderResource* below, const std::vector<fastrtps::NetworkBuffer>& pieces,
            std::uint32_t size, fastrtps::LocatorsIterator* begin, fastrtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& deadline) final {
    return below->send(pieces, size, begin, end, deadline);
  }
#else
  bool send(fastrtps::SenderResource* below, const fastrtps::octet* bytes, std::uint32_t size,
            fastrtps::LocatorsIterator* begin, fastrtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& deadline) final {
    return below->send(bytes, size, begin, end, deadline);
  }
#endif
};

}  // namespace swiftlet::dds
